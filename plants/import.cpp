#include "plants/import.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/require.hpp"
#include "plants/detail/assemble.hpp"
#include "plants/detail/gltf.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/leaf_list.hpp"
#include "plants/detail/leaf_or_wood.hpp"
#include "plants/detail/obj.hpp"
#include "plants/detail/ply.hpp"

namespace sunfleck {
namespace {

constexpr const char* kFormats = "an .obj, .ply, .gltf, .glb, .txt or .leaves";

std::string extensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool isGltf(const std::string& extension) {
  return extension == ".gltf" || extension == ".glb";
}

void refuseNames(const ImportRules& rules, const std::string& source, const char* what) {
  const bool all_leaf = rules.leaf.empty() || rules.leaf == std::vector<std::string>{"*"};
  if (!all_leaf || !rules.wood.empty())
    throw InvalidInput(source + ": " + what + " has no names that --leaf or --wood could match");
}

ImportedTree readPlyTree(std::string_view text, const std::string& source, const ImportRules& rules) {
  refuseNames(rules, source, "a PLY");
  ImportedTree tree;
  tree.mesh = detail::readPly(text, source);
  tree.how =
      tree.mesh.wood_triangles.empty() ? "a PLY has no names: every face is leaf" : "by the faces' property wood";
  return tree;
}

ImportedTree readList(std::string_view text, const std::string& source, const ImportRules& rules) {
  refuseNames(rules, source, "a list of leaves");
  ImportedTree tree;
  tree.mesh = detail::readLeafList(text, source);
  tree.how = "a list of leaves: all is leaf, discs as polygons of 12 corners";
  return tree;
}

// Reads the whole file, of one of the formats that there are.
std::string contentOf(const std::filesystem::path& path, const std::string& extension, const ImportRules& rules) {
  detail::validate(rules);
  const std::string source = detail::shown(path.string());
  if (extension == ".vdb" || extension == ".nvdb")
    throw InvalidInput(source + ": holds grids and no leaves: a tree is " + kFormats +
                       " file (of grids, voxelize reads a .vdb file)");
  std::string text = detail::readWhole(path);
  constexpr std::array known{".obj", ".ply", ".gltf", ".glb", ".txt", ".leaves"};
  if (std::ranges::find(known, extension) == known.end())
    throw InvalidInput(source + ": cannot be read: a tree is " + kFormats + " file");
  if (!rules.mesh.empty() && !isGltf(extension))
    throw InvalidInput(source + ": mesh \"" + detail::shown(rules.mesh) + "\": must be of a glTF file");
  return text;
}

}  // namespace

ImportedTree importTree(const std::filesystem::path& path, const ImportRules& rules, const ImageReader& read_image) {
  const std::string source = detail::shown(path.string()), extension = extensionOf(path);
  const std::string text = contentOf(path, extension, rules);
  if (isGltf(extension)) return detail::readGltf(path, text, rules, read_image);
  ImportedTree tree = extension == ".obj"   ? detail::readObj(path, text, rules, read_image)
                      : extension == ".ply" ? readPlyTree(text, source, rules)
                                            : readList(text, source, rules);
  detail::complete(tree, rules, false, source);
  return tree;
}

ImportedStand importStand(const std::filesystem::path& path, const ImportRules& rules, const ImageReader& read_image) {
  const std::string extension = extensionOf(path);
  if (isGltf(extension) && rules.mesh.empty())
    return detail::readGltfStand(path, contentOf(path, extension, rules), rules, read_image);
  ImportedStand stand;
  stand.kinds.push_back({path.stem().string(), importTree(path, rules, read_image)});
  return stand;
}

}  // namespace sunfleck
