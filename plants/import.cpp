#include "plants/import.hpp"

#include <algorithm>
#include <cctype>

#include "core/bounds.hpp"
#include "core/require.hpp"
#include "plants/detail/gltf.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/leaf_or_wood.hpp"
#include "plants/detail/obj.hpp"
#include "plants/detail/ply.hpp"

namespace sunfleck {
namespace {

// Smaller ones drown in the lengths that keep rays and maps from dividing by nothing, up to 1e-6 m.
constexpr float kSmallestTree = 1e-4f;  // [m]

std::string extensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

ImportedTree readNameless(const std::string& text, const std::string& source, const ImportRules& rules) {
  const bool all_leaf = rules.leaf.empty() || rules.leaf == std::vector<std::string>{"*"};
  if (!all_leaf || !rules.wood.empty())
    throw InvalidInput(source + ": a PLY has no names that --leaf or --wood could match");
  TreeMesh mesh = detail::readPly(text, source);
  const std::string how =
      mesh.wood_triangles.empty() ? "a PLY has no names: every face is leaf" : "by the faces' property wood";
  return {.mesh = std::move(mesh), .dropped = {}, .how = how};
}

void toMetresZUp(std::vector<glm::vec3>& vertices, const ImportRules& rules, bool format_y_up) {
  const bool y_up = rules.up == ImportRules::Up::of_format ? format_y_up : rules.up == ImportRules::Up::y;
  for (glm::vec3& v : vertices) {
    if (y_up) v = {v.x, -v.z, v.y};
    v *= rules.scale;
  }
}

}  // namespace

ImportedTree importTree(const std::filesystem::path& path, const ImportRules& rules, const ImageReader& read_image) {
  detail::validate(rules);
  const std::string source = detail::shown(path.string());
  const std::string extension = extensionOf(path);
  if (extension == ".vdb" || extension == ".nvdb")
    throw InvalidInput(
        source + ": holds grids and no leaves: a tree is an .obj, .ply, .gltf or .glb file (of grids, voxelize reads " +
        "a .vdb file)");
  const bool is_gltf = extension == ".gltf" || extension == ".glb";
  std::string text = detail::readWhole(path);
  ImportedTree tree;
  if (extension == ".obj")
    tree = detail::readObj(path, std::move(text), rules, read_image);
  else if (extension == ".ply")
    tree = readNameless(text, source, rules);
  else if (is_gltf)
    tree = detail::readGltf(path, text, rules);
  else
    throw InvalidInput(source + ": cannot be read: a tree is an .obj, .ply, .gltf or .glb file");
  toMetresZUp(tree.mesh.vertices, rules, is_gltf);
  tree.dropped = finish(tree.mesh, source);
  const glm::vec3 size = bounds(tree.mesh).size();
  require(std::max({size.x, size.y, size.z}) >= kSmallestTree, source + ": size of the tree [m]",
          std::max({size.x, size.y, size.z}), "at least 1e-4; is the scale right?");
  return tree;
}

}  // namespace sunfleck
