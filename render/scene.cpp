#include "render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace sunfleck {
namespace {

constexpr float kDefaultElevation = 25.f * std::numbers::pi_v<float> / 180.f;  // [rad]
constexpr float kDefaultAzimuth = 20.f * std::numbers::pi_v<float> / 180.f;    // [rad]
constexpr float kMargin = 1.08f;  // room around the stand, as a share of its size in the picture

Bounds standing(const TreeMesh& tree, const Bounds& prototype, const Placement& placement) {
  Bounds box;
  if (placement.rotation == 0.f) {
    box.include(prototype.low + placement.position);
    box.include(prototype.high + placement.position);
    return box;
  }
  const float cosine = std::cos(placement.rotation), sine = std::sin(placement.rotation);
  const auto include = [&](const std::vector<glm::uvec3>& triangles) {
    for (const glm::uvec3& t : triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3& v = tree.vertices[t[corner]];
        box.include(placement.position + glm::vec3(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z));
      }
  };
  include(tree.leaf_triangles);
  include(tree.wood_triangles);
  return box;
}

}  // namespace

Bounds bounds(const Scene& scene) {
  const Bounds prototype = bounds(*scene.tree);
  Bounds box;
  for (const Placement& placement : scene.stand.trees) box.include(standing(*scene.tree, prototype, placement));
  return box;
}

Camera cameraOf(const Scene& scene) {
  if (scene.camera) return *scene.camera;
  const Bounds box = bounds(scene);
  Camera camera{.target = box.centre(), .elevation = kDefaultElevation, .azimuth = kDefaultAzimuth};
  const Axes axes = viewAxes(camera);
  const glm::vec3 half_size = 0.5f * box.size();
  // The farthest corner of a box along an axis: its half size weighed by the axis's components.
  const float half_width = glm::dot(half_size, glm::abs(axes.right));
  const float half_height = glm::dot(half_size, glm::abs(axes.up));
  const float aspect = static_cast<float>(camera.width) / static_cast<float>(camera.height);
  camera.half_width = kMargin * std::max(half_width, half_height * aspect);
  return camera;
}

Axes viewAxes(const Camera& camera) {
  const float ce = std::cos(camera.elevation), se = std::sin(camera.elevation);
  const float ca = std::cos(camera.azimuth), sa = std::sin(camera.azimuth);
  return {.right = {-sa, ca, 0.f}, .up = {-se * ca, -se * sa, ce}, .along = {-ce * ca, -ce * sa, -se}};
}

}  // namespace sunfleck
