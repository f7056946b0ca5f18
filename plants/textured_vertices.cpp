#include "plants/detail/textured_vertices.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace sunfleck::detail {

bool anyPatch(const TreeMesh& mesh) {
  return std::ranges::any_of(mesh.patch_of_triangle, [](std::uint32_t patch) { return patch != TreeMesh::kNoPatch; });
}

TexturedVertices texturedVertices(const TreeMesh& mesh) {
  TexturedVertices made{.vertices = mesh.vertices, .texture = {}, .leaf_triangles = mesh.leaf_triangles};
  if (!anyPatch(mesh)) return made;
  made.texture.resize(mesh.vertices.size(), glm::vec2(0.f));
  std::vector<bool> known(mesh.vertices.size(), false);
  std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> again;
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const LeafPatch* const patch = patchOf(mesh, i);
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.leaf_triangles[i][c];
      const glm::vec2 at = patch ? patch->corners[static_cast<std::size_t>(c)] : glm::vec2(0.f);
      if (!known[vertex]) {
        known[vertex] = true;
        made.texture[vertex] = at;
      }
      if (made.texture[vertex] == at) continue;
      const auto [found, is_new] =
          again.try_emplace({vertex, at.x, at.y}, static_cast<std::uint32_t>(made.vertices.size()));
      if (is_new) {
        made.vertices.push_back(mesh.vertices[vertex]);
        made.texture.push_back(at);
      }
      made.leaf_triangles[i][c] = found->second;
    }
  }
  return made;
}

}  // namespace sunfleck::detail
