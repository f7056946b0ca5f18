#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// How a tree file is to be read.
struct ImportRules {
  enum class Up { of_format, x, y, z };  // of the format: y of glTF, z of the others
  // What becomes of leaves that an image's opacity cuts out of their faces, called cards:
  enum class Cards {
    cut,   // triangles of the solid parts, simplified
    mask,  // the faces with a mask, exact to the pixel, for trace alone
    whole  // the faces as if nothing were cut away
  };

  // Names of leaf and of wood in the file. A material's name is asked first, then those of its groups (of glTF: the
  // mesh), then the object's (the node); the first that a pattern matches decides. Upper and lower case are the same; a
  // pattern with *, ? or [ is matched as a whole, any other may stand anywhere in the name. Of patterns for leaf and
  // wood that match one name, that which is the name decides. When only one list is given, all that it does not match
  // is of the other kind; "*" stands for all that no pattern matches.
  std::vector<std::string> leaf, wood;
  float scale = 1.f;      // metres per unit of the file [m], > 0
  Up up = Up::of_format;  // the file's upward axis
  Cards cards = Cards::cut;
  std::string mesh;  // of a glTF file that is a stand: the kind of tree to take, by its name; empty: all of the file
};

// By their names, as options and scene files have them. Throw InvalidInput("<what> = <text>: must be ...").
ImportRules::Up upwardAxis(const std::string& text, const std::string& what);     // x, y, z
ImportRules::Cards cardsNamed(const std::string& text, const std::string& what);  // cut, mask, whole
float metresPer(const std::string& unit, const std::string& what);                // m, dm, cm, mm, km, in, ft [m]
std::string nameOf(ImportRules::Up up);                                           // "" of the format's
std::string nameOf(ImportRules::Cards cards);

// Reads an image with its values as they stand, 0 .. 1: the file of that name or, where they are not empty, these bytes
// of one that bears it; throws InvalidInput when it cannot.
using ImageReader = std::function<Image(const std::filesystem::path&, std::string_view bytes)>;

// What a file's materials say of its leaves: shares of light, per band red, green and blue [1].
struct FileLeafColours {
  glm::vec3 reflectance, transmittance;
};

struct ImportedTree {
  TreeMesh mesh;
  Dropped dropped;                         // triangles of no area that were left out
  std::string how;                         // one line: how leaf and wood were told apart
  double card_area = 0.;                   // one-sided area of the cards before they were cut, 0 without any [m^2]
  double cut_area = 0.;                    // what is left of them [m^2]
  std::optional<FileLeafColours> colours;  // of glTF with KHR_materials_diffuse_transmission, the mean over leaf area
};

// Reads a tree from an OBJ, a PLY, a glTF file (.gltf, .glb) or a list of leaves (.txt, .leaves: a line
// `radius x y z nx ny nz` for each, read as a polygon of 12 corners of that disc's area), by its extension. Leaf and
// wood in an OBJ or glTF are told apart by the rules; else by the words in its material, group and object names; else
// by the materials' colours when these are brown and not brown. A PLY has no names: a face is leaf, or wood where it
// has a property `wood` other than 0. Leaf triangles that share a vertex or an edge are one leaf; those that a file
// holds twice count once. Leaves whose material has an image of its opacity (map_d, the alpha of map_Kd, alphaMode MASK
// or BLEND) are cut out of their faces by it: leaf is where `d` times the image, its alpha channel or else its
// brightness, is at least a half, of glTF alphaCutoff; without `read_image` such a file is refused. All that is left of
// a card is one leaf. Faces of leaf materials with d below a half are left out. Instances in glTF are all put into the
// one mesh, or those of `rules.mesh` left where it stands.
// Throws InvalidInput, with the file and where possible the line, on a file that cannot be read, is empty, has no
// faces, is broken or truncated, has coordinates that are not finite or beyond 1e4 m, indices out of range, no leaf, or
// leaf and wood that cannot be told apart.
ImportedTree importTree(const std::filesystem::path& path, const ImportRules& rules = {},
                        const ImageReader& read_image = {});

// Kinds of trees and where they stand.
struct ImportedStand {
  struct Kind {
    std::string name;  // of its mesh, or the file; they differ
    ImportedTree tree;
  };
  std::vector<Kind> kinds;
  Stand stand;
};

// The same, with instances of glTF kept: a mesh that stands in several places (EXT_mesh_gpu_instancing, or nodes that
// share a mesh), which differ by a move and a turn about the vertical alone, is a kind of tree with its placements, and
// so are meshes that always stand together; what stands once is one more kind, named "rest". Where there are no such
// meshes, more than 1000 kinds, or one without a leaf, there is the one kind that importTree() reads.
ImportedStand importStand(const std::filesystem::path& path, const ImportRules& rules = {},
                          const ImageReader& read_image = {});

}  // namespace sunfleck
