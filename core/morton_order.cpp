#include "core/morton_order.hpp"

#include <algorithm>
#include <glm/common.hpp>

#include "core/bounds.hpp"

namespace sunfleck {
namespace {

// The bits of ten, with two zeros between each.
std::uint32_t apart(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

}  // namespace

std::vector<std::uint32_t> mortonOrder(std::span<const glm::vec3> points) {
  Bounds box;
  for (const glm::vec3& point : points) box.include(point);
  const glm::vec3 scale = 1023.f / glm::max(box.size(), glm::vec3(1e-6f));
  // A point's place on the curve, then its number.
  std::vector<std::uint64_t> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::uvec3 cell(glm::clamp(scale * (points[i] - box.low), 0.f, 1023.f));
    keys[i] = std::uint64_t{apart(cell.x) | apart(cell.y) << 1 | apart(cell.z) << 2} << 32 | i;
  }
  std::ranges::sort(keys);
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(keys[i]);
  return order;
}

}  // namespace sunfleck
