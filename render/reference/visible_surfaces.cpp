#include "render/reference/visible_surfaces.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/require.hpp"
#include "render/reference/detail/primitives.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {
using namespace detail;
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kSide = 4, kPacket = kSide * kSide;  // pixels looked at together
constexpr int kTile = 32;                          // pixels along a task's side

class Looking {
 public:
  Looking(const RayScene& scene, const PixelRays& rays, const glm::vec2& within)
      : scene_(scene.geometry()), rays_(rays) {
    (rays_.eye ? *rays_.eye : rays_.corner) -= scene_.origin;
    rays_.corner += within.x * rays_.right_step + within.y * rays_.down_step;
    reach_ = 0.5f * glm::length(scene_.box.size()) + 8.f * scene_.lift;
  }

  // At the pixels from (left, top) on that are left of `right` and above `bottom`, at most kSide each way.
  void look(int left, int top, int right, int bottom, std::vector<glm::uvec2>& seen) const {
    alignas(64) std::array<int, kPacket> valid{};
    RTCRayHit16 packet{};
    for (int i = 0; i < kPacket; ++i) {
      const int x = left + i % kSide, y = top + i / kSide;
      const auto ray = static_cast<std::size_t>(i);
      valid[ray] = x < right && y < bottom ? -1 : 0;
      const glm::vec3 place =
          rays_.corner + static_cast<float>(x) * rays_.right_step + static_cast<float>(y) * rays_.down_step;
      const Direction sight = rays_.eye ? glm::normalize(place) : rays_.sight;
      const glm::vec3 from = startOf(rays_.eye.value_or(place), sight);
      set(packet.ray, ray, from, sight, kInfinity);
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    closestHits(valid.data(), scene_.scenes.root(), packet);
    for (int i = 0; i < kPacket; ++i)
      if (valid[static_cast<std::size_t>(i)])
        seen[static_cast<std::size_t>(top + i / kSide) * static_cast<std::size_t>(rays_.width) +
             static_cast<std::size_t>(left + i % kSide)] = met(packet, i);
  }

 private:
  // Right before the box, where positions are exact, but not before the eye.
  glm::vec3 startOf(const glm::vec3& on_line, const Direction& sight) const {
    const float distance = glm::dot(scene_.box.centre() - on_line, sight) - reach_;
    return on_line + (rays_.eye ? std::max(0.f, distance) : distance) * sight;
  }
  glm::uvec2 met(const RTCRayHit16& packet, int i) const {
    if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) return {kNothingSeen, 0u};
    const unsigned instance = packet.hit.instID[0][i] == RTC_INVALID_GEOMETRY_ID ? 0 : packet.hit.instID[0][i];
    const Prototype& prototype = scene_.prototypes[scene_.copies[instance].kind];
    const bool leaf = packet.hit.geomID[i] == kLeaves;
    const bool second = (leaf ? prototype.leaf_quads : prototype.wood_quads) && packet.hit.u[i] + packet.hit.v[i] > 1.f;
    const std::size_t primitive = packet.hit.primID[i] + (leaf ? 0 : prototype.leaf_of_primitive.size());
    return {instance, prototype.first_triangle[primitive] + (second ? 1u : 0u)};
  }

  const RayScene::Geometry& scene_;
  PixelRays rays_;  // through the places looked at, about the scene's origin
  float reach_;     // from the middle of the box to all there is [m]
};

}  // namespace

std::vector<glm::uvec2> visibleSurfaces(const RayScene& scene, const PixelRays& rays, const glm::vec2& within) {
  validate(rays);
  if (scene.geometry().period) throw InvalidInput("visible surfaces: the stand must not be periodic");
  std::vector<glm::uvec2> seen(static_cast<std::size_t>(rays.width) * static_cast<std::size_t>(rays.height));
  const Looking looking(scene, rays, within);
  const int across = (rays.width + kTile - 1) / kTile, down = (rays.height + kTile - 1) / kTile;
  tbb::parallel_for(0, across * down, [&](int tile) {
    const int left = tile % across * kTile, top = tile / across * kTile;
    const int right = std::min(left + kTile, rays.width), bottom = std::min(top + kTile, rays.height);
    for (int y = top; y < bottom; y += kSide)
      for (int x = left; x < right; x += kSide) looking.look(x, y, right, bottom, seen);
  });
  return seen;
}

}  // namespace sunfleck
