#include "render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr float kMargin = 1.08f;  // room around the stand, as a share of its size in the picture
constexpr float kNearest = 0.2f;  // that an eye comes to the stand, as a share of half its size in the picture
constexpr float kInfinity = std::numeric_limits<float>::infinity();

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

void setLeaves(TreeKind& kind, const LightBands& bands, const BandOptics& told) {
  const BandOptics even = bandOptics(kind.description, bands, told);
  std::shared_ptr<const LeafMaps> maps = leafMaps(kind.description, even, kind.textures);
  kind.even = kind.leaf = even;
  kind.maps = std::move(maps);
  if (!kind.maps) return;
  const int width = kind.maps->width, height = kind.maps->height;
  if (!kind.shares || kind.shares->mesh != kind.mesh || kind.shares->width != width || kind.shares->height != height)
    kind.shares = std::make_shared<const LeafShares>(
        LeafShares{kind.mesh, width, height, leafAreaShares(*kind.mesh, width, height)});
  kind.leaf = meanOptics(*kind.maps, kind.shares->at);
}

void intoOnePeriod(Stand& stand) {
  if (!stand.period || stand.trees.empty()) return;
  glm::vec2 low(stand.trees.front().position);
  for (const Placement& tree : stand.trees) low = glm::min(low, glm::vec2(tree.position));
  for (Placement& tree : stand.trees) {
    const glm::vec2 periods = glm::floor((glm::vec2(tree.position) - low) / *stand.period);
    tree.position -= glm::vec3(periods * *stand.period, 0.f);
  }
}

const Camera& savedCamera(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.saved_cameras, name, &SavedCamera::name);
  if (found == scene.saved_cameras.end()) {
    std::string names;
    for (const SavedCamera& saved : scene.saved_cameras) names += (names.empty() ? "" : ", ") + saved.name;
    throw InvalidInput("camera \"" + name + "\": must be a saved one" +
                       (names.empty() ? "; there is none" : ": " + names));
  }
  return found->camera;
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

namespace {

using Sides = std::array<glm::vec4, 4>;

bool inside(const Sides& sides, const Bounds& box) {
  return std::none_of(sides.begin(), sides.end(), [&](const glm::vec4& side) {
    const glm::vec3 inward(side);
    return glm::dot(inward, box.centre()) + side.w + 0.5f * glm::dot(glm::abs(inward), box.size()) < 0.f;
  });
}

// Whether the shadow of a box on level ground may be: for no side all of its corners lie beyond. What is shaded reads
// maps of the light, whose pixels reach beyond the leaves: by kRim at most in a map of four pixels and more.
bool shadowInside(const Sides& sides, const Bounds& box, float ground, Direction light) {
  constexpr float kRim = 0.25f;  // of the box's size
  return std::none_of(sides.begin(), sides.end(), [&](const glm::vec4& side) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 way(corner & 1 ? 0.5f : -0.5f, corner & 2 ? 0.5f : -0.5f, corner & 4 ? 0.5f : -0.5f);
      const glm::vec3 from = box.centre() + (1.f + kRim) * way * box.size();
      const glm::vec3 at = from + (from.z - ground) / -light.z * light;
      if (glm::dot(glm::vec3(side), at) + side.w >= 0.f) return false;
    }
    return true;
  });
}

}  // namespace

std::vector<std::size_t> treesInPicture(const Scene& scene, const Camera& camera) {
  const Sides sides = sidesOfSight(camera);
  const std::vector<Bounds> prototypes = prototypeBounds(scene);
  std::vector<Bounds> trees;
  float ground = kInfinity;
  for (const Placement& tree : scene.stand.trees) {
    trees.push_back(standing(*scene.kindOf(tree).mesh, prototypes[tree.kind], tree));
    ground = std::min(ground, trees.back().low.z);
  }
  const bool reflects = scene.ground_albedo != glm::vec3(0.f);
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const auto shades = [&](const Sun& sun) { return sun.up() && shadowInside(sides, trees[i], ground, sun.light()); };
    if (scene.stand.period || inside(sides, trees[i]) || (reflects && std::ranges::any_of(scene.suns, shades)))
      seen.push_back(i);
  }
  return seen;
}

namespace {

// Visits points that a picture of the whole stand must hold: the trees' vertices, not the corners of their boxes, and
// the corners of media.
template <typename Visit>
void forPoints(const Scene& scene, const Visit& visit) {
  for (const Placement& placement : scene.stand.trees) {
    const float cosine = std::cos(placement.rotation), sine = std::sin(placement.rotation);
    forVertices(*scene.kindOf(placement).mesh, [&](const glm::vec3& v) { visit(placed(v, placement, cosine, sine)); });
  }
  if (scene.media.empty()) return;
  const Bounds all = bounds(scene);
  for (int corner = 0; corner < 8; ++corner)
    visit(glm::vec3(corner & 1 ? all.low.x : all.high.x, corner & 2 ? all.low.y : all.high.y,
                    corner & 4 ? all.low.z : all.high.z));
}

}  // namespace

// In perspective, with s the slope of a side, all x lie between the sides through an eye at (x0, z0) if
// x - x0 <= s (z - z0) and x0 - x <= s (z - z0): the largest of x - s z and of -x - s z say where the eye is.
Camera showingAll(const Scene& scene, Camera camera) {
  const Axes axes = viewAxes(camera);
  const float aspect = static_cast<float>(camera.width) / static_cast<float>(camera.height);
  const float slope = std::tan(0.5f * camera.field_of_view) / kMargin;
  const glm::vec2 slopes(slope, slope / aspect);
  Bounds seen;                           // along right, up and the direction of sight
  glm::vec2 low(kInfinity), high(-low);  // least place + slope * depth, largest place - slope * depth
  forPoints(scene, [&](const glm::vec3& p) {
    const glm::vec3 at(glm::dot(p, axes.right), glm::dot(p, axes.up), glm::dot(p, axes.along));
    seen.include(at);
    low = glm::min(low, glm::vec2(at) + slopes * at.z);
    high = glm::max(high, glm::vec2(at) - slopes * at.z);
  });
  if (seen.empty()) return camera;
  glm::vec3 centre = seen.centre();
  const glm::vec3 half_size = 0.5f * seen.size();
  if (!camera.perspective()) {
    camera.half_width = kMargin * std::max({half_size.x, half_size.y * aspect, 1e-6f});
  } else {
    const glm::vec2 eye_depth = 0.5f * (low - high) / slopes;
    const float before = seen.low.z - kNearest * std::max(half_size.x, half_size.y);
    const float away = centre.z - std::min({eye_depth.x, eye_depth.y, before});
    centre = {0.5f * (high + low), centre.z};
    camera.half_width = std::max(away * kMargin * slope, 1e-6f);
  }
  camera.target = centre.x * axes.right + centre.y * axes.up + centre.z * axes.along;
  return camera;
}

Camera cameraOf(const Scene& scene) {
  return scene.camera ? *scene.camera : showingAll(scene, kOverview);
}

}  // namespace sunfleck
