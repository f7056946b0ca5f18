#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// How a tree file is to be read.
struct ImportRules {
  enum class Up { of_format, z, y };  // of the format: y of glTF, z of the others

  // Names of leaf and of wood in the file: its materials, groups and objects. Upper and lower case are the same; a
  // pattern with *, ? or [ is matched as a whole, any other may stand anywhere in the name. When only one list is
  // given, all that it does not match is of the other kind; "*" stands for all that the other list does not match.
  std::vector<std::string> leaf, wood;
  float scale = 1.f;      // metres per unit of the file [m], > 0
  Up up = Up::of_format;  // the file's upward axis
};

// Reads an image file with its values as they stand, 0 .. 1; throws InvalidInput when it cannot.
using ImageReader = std::function<Image(const std::filesystem::path&)>;

struct ImportedTree {
  TreeMesh mesh;
  Dropped dropped;  // triangles of no area that were left out
  std::string how;  // one line: how leaf and wood were told apart
};

// Reads a tree from an OBJ, a PLY or a glTF file (.gltf, .glb), by its extension. Leaf and wood in an OBJ or glTF are
// told apart by the rules; else by the words in its material, group and object names; else by the materials' colours
// when these are brown and not brown. A PLY has no names: a face is leaf, or wood where it has a property `wood` other
// than 0. Leaf triangles that share a vertex are one leaf. Leaves whose material has an image of its opacity (map_d)
// are cut out of their faces by it: leaf is where `d` times the image, its alpha channel or else its brightness, is at
// least a half; without `read_image` such a file is refused. Faces of leaf materials with d below a half are left out.
// Throws InvalidInput, with the file and where possible the line, on a file that cannot be read, is empty, has no
// faces, is broken or truncated, has coordinates that are not finite or beyond 1e4 m, indices out of range, no leaf, or
// leaf and wood that cannot be told apart.
ImportedTree importTree(const std::filesystem::path& path, const ImportRules& rules = {},
                        const ImageReader& read_image = {});

}  // namespace sunfleck
