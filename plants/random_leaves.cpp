#include "plants/random_leaves.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/directions.hpp"
#include "core/random.hpp"

namespace sunfleck {
namespace {

glm::vec3 uniformDirection(Random& random) {
  const float z = 2.f * random.uniform() - 1.f;
  const float azimuth = 2.f * std::numbers::pi_v<float> * random.uniform();
  const float r = std::sqrt(std::max(0.f, 1.f - z * z));
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

void addLeaf(TreeMesh& mesh, glm::vec3 centre, float side, Random& random) {
  const Axes axes = axesAlong(uniformDirection(random));
  const float turn = 2.f * std::numbers::pi_v<float> * random.uniform();
  const glm::vec3 a = 0.5f * side * (std::cos(turn) * axes.right + std::sin(turn) * axes.up);
  const glm::vec3 b = 0.5f * side * (std::cos(turn) * axes.up - std::sin(turn) * axes.right);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const glm::vec3& corner : {centre - a - b, centre + a - b, centre + a + b, centre - a + b})
    mesh.vertices.push_back(corner);
  mesh.leaf_triangles.push_back({first, first + 1, first + 2});
  mesh.leaf_triangles.push_back({first, first + 2, first + 3});
  mesh.patch_of_triangle.insert(mesh.patch_of_triangle.end(), {0, 1});
}

// Of all leaves' two triangles.
std::vector<LeafPatch> patchesOfSquare() {
  const glm::vec2 low_left(0.f), low_right(1.f, 0.f), high_right(1.f), high_left(0.f, 1.f);
  return {{.corners = {low_left, low_right, high_right}}, {.corners = {low_left, high_right, high_left}}};
}

}  // namespace

TreeMesh randomLayer(const RandomLayer& layer, std::uint64_t seed) {
  TreeMesh mesh;
  mesh.patches = patchesOfSquare();
  Random random(seed, 0);
  const float leaf_area = layer.leaf_side * layer.leaf_side;
  const int leaves = static_cast<int>(std::ceil(layer.leaf_area_index * layer.size.x * layer.size.y / leaf_area));
  for (int i = 0; i < leaves; ++i) {
    const glm::vec3 share(random.uniform(), random.uniform(), random.uniform());
    addLeaf(mesh, share * glm::vec3(layer.size, layer.height), layer.leaf_side, random);
  }
  finish(mesh, "random layer");
  return mesh;
}

TreeMesh randomCrown(const RandomCrown& crown, std::uint64_t seed) {
  TreeMesh mesh;
  mesh.patches = patchesOfSquare();
  Random random(seed, 0);
  for (int i = 0; i < crown.leaves; ++i) {
    const float radius = std::cbrt(random.uniform());
    addLeaf(mesh, 0.5f * crown.size * radius * uniformDirection(random), crown.leaf_side, random);
  }
  finish(mesh, "random crown");
  return mesh;
}

}  // namespace sunfleck
