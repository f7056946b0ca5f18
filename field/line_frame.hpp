#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace sunfleck {

// Where parallel lines run: one through the middle of each pixel of a grid across them.
struct LineFrame {
  glm::dvec3 right{0.}, up{0.}, depth{0.};  // rows of the map from a point to pixels [pixel/m] and along the lines [1]
  glm::dvec3 along_right{0.}, along_up{0.}, along{0.};  // and columns of the map back [m/pixel], [1]
  glm::dvec2 corner{0.};                                // of pixel (0, 0) [pixel]
  glm::ivec2 size{1};                                   // [pixel]
  bool repeats = false;                                 // with the period of a stand, whose pixels these are

  static constexpr std::uint32_t kNone = ~0u;
  // The line of the pixel that a point lies in; kNone beside the grid.
  std::uint32_t lineAt(const glm::dvec3& point) const {
    double x = std::floor(glm::dot(point, right) - corner.x), y = std::floor(glm::dot(point, up) - corner.y);
    if (repeats) {
      x -= size.x * std::floor(x / size.x);
      y -= size.y * std::floor(y / size.y);
    } else if (!(x >= 0. && y >= 0. && x < size.x && y < size.y)) {
      return kNone;
    }
    return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(size.x) + static_cast<std::uint32_t>(x);
  }
  // The point of a line at a depth [m].
  glm::dvec3 point(std::size_t line, double at_depth) const {
    const auto columns = static_cast<std::size_t>(size.x);
    return (corner.x + static_cast<double>(line % columns) + 0.5) * along_right +
           (corner.y + static_cast<double>(line / columns) + 0.5) * along_up + at_depth * along;
  }
};

}  // namespace sunfleck
