#include "apps/thumbnail.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "render/camera.hpp"
#include "render/image_file.hpp"
#include "render/reference/ray_scene.hpp"
#include "render/reference/visible_surfaces.hpp"

namespace sunfleck::apps {
namespace {

constexpr int kPixels = kThumbnailPixels;
constexpr int kAcross = 3;  // samples along each side of a pixel
constexpr glm::vec3 kLeaf(110.f, 165.f, 60.f), kWood(125.f, 95.f, 65.f),
    kBehind(238.f, 242.f, 246.f);  // sRGB, 0 .. 255

Camera cameraOn(const Bounds& box) {
  Camera camera{.target = 0.5f * (box.low + box.high), .elevation = 0.1f, .azimuth = -1.2f};
  const glm::vec3 size = box.size();
  camera.half_width = 0.53f * std::max({std::hypot(size.x, size.y) * 0.9f, size.z, 1e-4f});
  camera.width = camera.height = kPixels;
  return camera;
}

}  // namespace

std::vector<std::uint8_t> thumbnail(const TreeMesh& mesh) {
  const RayScene scene(mesh, Stand{}, true);
  const Camera camera = cameraOn(bounds(mesh));
  const PixelSteps steps = pixelSteps(camera);
  const Axes axes = viewAxes(camera);
  // From the lower left corner's row to the top: rows of a picture go down.
  const PixelRays rays{.corner = camera.target + steps.lower_left + float{kPixels} * steps.up,
                       .right_step = steps.right,
                       .down_step = -steps.up,
                       .sight = axes.along,
                       .width = kPixels,
                       .height = kPixels,
                       .eye = std::nullopt};
  const glm::vec3 to_light = glm::normalize(-0.5f * axes.along - 0.4f * axes.right + 0.9f * axes.up);
  const auto colourOf = [&](const glm::uvec2& seen) {
    if (seen.x == kNothingSeen) return kBehind;
    const bool leaf = seen.y < mesh.leaf_triangles.size();
    const glm::uvec3& t = leaf ? mesh.leaf_triangles[seen.y] : mesh.wood_triangles[seen.y - mesh.leaf_triangles.size()];
    const glm::vec3 a = mesh.vertices[t.x];
    const glm::vec3 normal = glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a);
    const float facing = std::abs(glm::dot(normal, to_light)) / std::max(glm::length(normal), 1e-30f);
    return (0.4f + 0.6f * facing) * (leaf ? kLeaf : kWood);
  };
  std::vector<glm::vec3> sums(std::size_t{kPixels} * kPixels, glm::vec3(0.f));
  for (int sample = 0; sample < kAcross * kAcross; ++sample) {
    const glm::vec2 within((static_cast<float>(sample % kAcross) + 0.5f) / kAcross,
                           (static_cast<float>(sample / kAcross) + 0.5f) / kAcross);
    const std::vector<glm::uvec2> seen = visibleSurfaces(scene, rays, within);
    for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) sums[pixel] += colourOf(seen[pixel]);
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * sums.size());
  for (const glm::vec3& sum : sums)
    for (int band = 0; band < 3; ++band)
      bytes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(sum[band] / (kAcross * kAcross), 0.f, 255.f))));
  return bytes;
}

void writeThumbnail(const std::filesystem::path& file, const TreeMesh& mesh) {
  writePng(file, kPixels, kPixels, thumbnail(mesh));
}

}  // namespace sunfleck::apps
