#include "render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sunfleck {
namespace {

constexpr float kMargin = 1.08f;  // room around the stand, as a share of its size in the picture

template <typename Visit>
void forVertices(const TreeMesh& tree, const Visit& visit) {
  for (const auto* triangles : {&tree.leaf_triangles, &tree.wood_triangles})
    for (const glm::uvec3& t : *triangles)
      for (int corner = 0; corner < 3; ++corner) visit(tree.vertices[t[corner]]);
}

glm::vec3 placed(const glm::vec3& vertex, const Placement& placement, float cosine, float sine) {
  return placement.position +
         glm::vec3(cosine * vertex.x - sine * vertex.y, sine * vertex.x + cosine * vertex.y, vertex.z);
}

Bounds standing(const TreeMesh& tree, const Bounds& prototype, const Placement& placement) {
  Bounds box;
  if (prototype.empty()) return box;
  if (placement.rotation == 0.f) {
    box.include(prototype.low + placement.position);
    box.include(prototype.high + placement.position);
    return box;
  }
  const float cosine = std::cos(placement.rotation), sine = std::sin(placement.rotation);
  forVertices(tree, [&](const glm::vec3& v) { box.include(placed(v, placement, cosine, sine)); });
  return box;
}

std::vector<Bounds> prototypeBounds(const Scene& scene) {
  std::vector<Bounds> all;
  for (const TreeKind& kind : scene.kinds) all.push_back(bounds(*kind.mesh));
  return all;
}

}  // namespace

void intoOnePeriod(Stand& stand) {
  if (!stand.period) return;
  glm::vec2 low(stand.trees.front().position);
  for (const Placement& tree : stand.trees) low = glm::min(low, glm::vec2(tree.position));
  for (Placement& tree : stand.trees) {
    const glm::vec2 periods = glm::floor((glm::vec2(tree.position) - low) / *stand.period);
    tree.position -= glm::vec3(periods * *stand.period, 0.f);
  }
}

std::vector<const TreeMesh*> meshes(const Scene& scene) {
  std::vector<const TreeMesh*> all;
  for (const TreeKind& kind : scene.kinds) all.push_back(kind.mesh.get());
  return all;
}

std::string sourceOf(const Scene& scene) {
  std::string all;
  for (const TreeKind& kind : scene.kinds) all += (all.empty() ? "" : "; ") + kind.source;
  return all;
}

Bounds bounds(const Scene& scene) {
  const std::vector<Bounds> prototypes = prototypeBounds(scene);
  Bounds box;
  for (const Placement& tree : scene.stand.trees)
    box.include(standing(*scene.kindOf(tree).mesh, prototypes[tree.kind], tree));
  const glm::vec2 about = box.empty() ? glm::vec2(0.f) : glm::vec2(box.centre());
  for (const SceneMedium& medium : scene.media) box.include(bounds(medium, scene.stand.period, about));
  return box;
}

std::vector<std::size_t> treesInPicture(const Scene& scene, const Camera& camera) {
  const Axes axes = viewAxes(camera);
  const std::vector<Bounds> prototypes = prototypeBounds(scene);
  const float half_height = camera.half_width * static_cast<float>(camera.height) / static_cast<float>(camera.width);
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < scene.stand.trees.size(); ++i) {
    const Placement& tree = scene.stand.trees[i];
    const Bounds box = standing(*scene.kindOf(tree).mesh, prototypes[tree.kind], tree);
    const glm::vec3 half = 0.5f * box.size(), away = box.centre() - camera.target;
    const bool beside = std::abs(glm::dot(away, axes.right)) > camera.half_width + glm::dot(half, glm::abs(axes.right));
    const bool above = std::abs(glm::dot(away, axes.up)) > half_height + glm::dot(half, glm::abs(axes.up));
    if (scene.stand.period || !(beside || above)) seen.push_back(i);
  }
  return seen;
}

// The picture is as large as what it shows: the trees' vertices, not the corners of their boxes.
Camera showingAll(const Scene& scene, Camera camera) {
  const Axes axes = viewAxes(camera);
  Bounds seen;  // along right, up and the direction of sight
  for (const Placement& placement : scene.stand.trees) {
    const float cosine = std::cos(placement.rotation), sine = std::sin(placement.rotation);
    forVertices(*scene.kindOf(placement).mesh, [&](const glm::vec3& v) {
      const glm::vec3 p = placed(v, placement, cosine, sine);
      seen.include({glm::dot(p, axes.right), glm::dot(p, axes.up), glm::dot(p, axes.along)});
    });
  }
  if (!scene.media.empty()) {
    const Bounds all = bounds(scene);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p(corner & 1 ? all.low.x : all.high.x, corner & 2 ? all.low.y : all.high.y,
                        corner & 4 ? all.low.z : all.high.z);
      seen.include({glm::dot(p, axes.right), glm::dot(p, axes.up), glm::dot(p, axes.along)});
    }
  }
  const glm::vec3 centre = seen.centre(), half_size = 0.5f * seen.size();
  camera.target = centre.x * axes.right + centre.y * axes.up + centre.z * axes.along;
  const float aspect = static_cast<float>(camera.width) / static_cast<float>(camera.height);
  camera.half_width = kMargin * std::max({half_size.x, half_size.y * aspect, 1e-6f});
  return camera;
}

Camera cameraOf(const Scene& scene) {
  return scene.camera ? *scene.camera : showingAll(scene, kOverview);
}

Axes viewAxes(const Camera& camera) {
  const float ce = std::cos(camera.elevation), se = std::sin(camera.elevation);
  const float ca = std::cos(camera.azimuth), sa = std::sin(camera.azimuth);
  return {.right = {-sa, ca, 0.f}, .up = {-se * ca, -se * sa, ce}, .along = {-ce * ca, -ce * sa, -se}};
}

}  // namespace sunfleck
