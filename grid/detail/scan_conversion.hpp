#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace sunfleck::detail {

// An edge of a triangle, between corners given as (column, row, depth). Whatever it tells, it computes from its ends
// alone, in the same order of them, so that the two triangles on either side of it see the same, and neither both
// claim, nor both miss, a pixel.
struct Edge {
  glm::dvec3 high, slope;  // upper end, and change per row

  Edge(const glm::dvec3& low_end, const glm::dvec3& high_end)
      : high(high_end), slope((1. / (high.y - low_end.y)) * (high - low_end)) {}
  double column(double row) const { return high.x + (row - high.y) * slope.x; }
  double depth(double row) const { return high.z + (row - high.y) * slope.z; }
};

// Calls visit(y, x_first, x_end, depth) for each row of pixels of which some centres lie in the triangle: those of
// x_first
// <= x < x_end, at depth(x). The corners are (column, row, depth), where the centre of pixel (x, y) is at (x + 1, y +
// 1) and nothing is below 0, so that int(column) is the first pixel whose centre lies to the right of a column. A
// centre exactly on an edge is that of the triangle to its left or below. Pixels beyond `size` are left out.
template <typename Visit>
void scanTriangle(const std::array<glm::dvec3, 3>& corners, glm::ivec2 size, const Visit& visit) {
  const auto& [a, b, c] = corners;
  // The corners from low to high, by whether b is below a, c below b and c below a: without branches, as no processor
  // foresees them.
  static constexpr std::uint8_t kOrder[8][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {},
                                                {},        {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const auto& order = kOrder[(b.y < a.y) + 2 * (c.y < b.y) + 4 * (c.y < a.y)];
  const glm::dvec3 &low = corners[order[0]], &middle = corners[order[1]], &high = corners[order[2]];
  const int first = std::max(0, static_cast<int>(low.y)), bend = static_cast<int>(middle.y);
  const int end = std::min(size.y, static_cast<int>(high.y));
  if (first >= end || static_cast<int>(std::min({a.x, b.x, c.x})) == static_cast<int>(std::max({a.x, b.x, c.x})))
    return;  // between the centres of pixels

  const Edge whole(low, high), parts[2] = {Edge(low, middle), Edge(middle, high)};
  for (int y = first; y < end; ++y) {
    const Edge& part = parts[y >= bend];
    const double centre = y + 1.;
    const double column = whole.column(centre), other = part.column(centre);
    const int x_first = std::max(0, static_cast<int>(std::min(column, other)));
    const int x_end = std::min(size.x, static_cast<int>(std::max(column, other)));
    if (x_first >= x_end) continue;
    const double depth = whole.depth(centre), slope = (part.depth(centre) - depth) / (other - column);
    visit(y, x_first, x_end, depth + (x_first + 1. - column) * slope, slope);
  }
}

}  // namespace sunfleck::detail
