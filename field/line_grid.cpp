#include "field/detail/line_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "core/bounds.hpp"

namespace sunfleck::detail {
namespace {

// Numbers of columns and rows whose product is nearest to what is wanted, with pixels about square.
glm::ivec2 wholePixels(const glm::dvec2& period, double wanted) {
  const double columns = std::sqrt(wanted * period.x / period.y);
  glm::ivec2 best(1);
  double nearest = std::numeric_limits<double>::infinity();
  const int first = std::max(1, static_cast<int>(0.8 * columns)), last = static_cast<int>(1.25 * columns) + 1;
  const int step = std::max(1, (last - first) / 256);
  for (int x = first; x <= last; x += step) {
    const int y = std::max(1, static_cast<int>(std::lround(wanted / x)));
    const double off = std::abs(static_cast<double>(x) * y - wanted);
    if (off < nearest) {
      nearest = off;
      best = {x, y};
    }
  }
  return best;
}

}  // namespace

Crossing64 crossing64(float depth, std::uint32_t side) {
  constexpr std::uint32_t kSign = 1u << 31;
  const auto bits = std::bit_cast<std::uint32_t>(depth);
  return Crossing64{bits & kSign ? ~bits : bits | kSign} << 32 | side;
}

float depthOf(Crossing64 crossing) {
  constexpr std::uint32_t kSign = 1u << 31;
  const auto bits = static_cast<std::uint32_t>(crossing >> 32);
  return std::bit_cast<float>(bits & kSign ? bits ^ kSign : ~bits);
}

// (F2)
LineGrid::LineGrid(const StandSurfaces& surfaces, Direction along, double area, glm::dvec2 offset)
    : surfaces_(surfaces) {
  const std::vector<glm::vec3>& vertices = surfaces.mesh->vertices;
  projected_.resize(vertices.size());
  const glm::dvec3 s(along);
  if (surfaces.period) {
    const glm::dvec2 period(*surfaces.period);
    frame_.repeats = true;
    frame_.size = wholePixels(period, period.x * period.y * std::abs(s.z) / area);
    line_area_ = period.x * period.y * std::abs(s.z) / (static_cast<double>(frame_.size.x) * frame_.size.y);
    const glm::dvec2 scale = glm::dvec2(frame_.size) / period;
    frame_.right = scale.x * glm::dvec3(1., 0., -s.x / s.z);
    frame_.up = scale.y * glm::dvec3(0., 1., -s.y / s.z);
    frame_.depth = {0., 0., 1. / s.z};
    frame_.along_right = {1. / scale.x, 0., 0.};
    frame_.along_up = {0., 1. / scale.y, 0.};
    frame_.along = s;
    mirrored_ = s.z < 0.;
  } else {
    const Axes axes = axesAlong(along);
    const double pixel = std::sqrt(area);
    frame_.right = glm::dvec3(axes.right) / pixel;
    frame_.up = glm::dvec3(axes.up) / pixel;
    frame_.depth = s;
    frame_.along_right = pixel * glm::dvec3(axes.right);
    frame_.along_up = pixel * glm::dvec3(axes.up);
    frame_.along = s;
    line_area_ = area;
  }
  const glm::vec3 right(frame_.right), up(frame_.up), depth(frame_.depth);
  Bounds box;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    projected_[i] = {glm::dot(vertices[i], right), glm::dot(vertices[i], up), glm::dot(vertices[i], depth)};
    box.include(projected_[i]);
  }
  if (surfaces.period) {
    // The corner is a whole number of periods away, so that pixels are counted from the same place everywhere.
    const glm::dvec2 size(frame_.size);
    pixels_.corner = size * glm::floor((glm::dvec2(box.low) - offset) / size) + offset;
  } else {
    pixels_.corner = glm::floor(glm::dvec2(box.low) - offset) + offset;
    frame_.size = glm::ivec2(glm::ceil(glm::dvec2(box.high) - pixels_.corner)) + 1;
  }
  frame_.corner = pixels_.corner;
  pixels_.pixels_per_metre = 1.;
  const glm::ivec2 whole = glm::ivec2(glm::ceil(glm::dvec2(box.high) - pixels_.corner)) + 1;
  pixels_.columns = whole.x;
  pixels_.rows = whole.y;
}

std::size_t LineGrid::triangles() const {
  return surfaces_.mesh->leaf_triangles.size() + surfaces_.mesh->wood_triangles.size();
}

}  // namespace sunfleck::detail
