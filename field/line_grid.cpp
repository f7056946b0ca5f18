#include "field/detail/line_grid.hpp"

#include <algorithm>
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

// (F2)
LineGrid::LineGrid(const StandSurfaces& surfaces, Direction along, double area, glm::dvec2 offset, int finer)
    : surfaces_(surfaces) {
  const std::vector<glm::vec3>& vertices = surfaces.mesh->vertices;
  projected_.resize(vertices.size());
  glm::vec3 right, up, depth;  // rows of the map from space to pixels
  if (surfaces.period) {
    const glm::dvec2 period(*surfaces.period);
    const double rise = std::abs(double{along.z});
    size_ = wholePixels(period, period.x * period.y * rise / area);
    size_.x *= finer;
    line_area_ = period.x * period.y * rise / (static_cast<double>(size_.x) * size_.y);
    const glm::vec2 scale = glm::vec2(glm::dvec2(size_) / period);
    right = scale.x * glm::vec3(1.f, 0.f, -along.x / along.z);
    up = scale.y * glm::vec3(0.f, 1.f, -along.y / along.z);
    depth = {0.f, 0.f, 1.f / along.z};
    mirrored_ = along.z < 0.f;
    column_step_ = {1.f / scale.x, 0.f, 0.f};
    row_step_ = {0.f, 1.f / scale.y, 0.f};
    along_ = along;
  } else {
    const Axes axes = axesAlong(along);
    const auto scale = static_cast<float>(1. / std::sqrt(area));
    right = static_cast<float>(finer) * scale * axes.right;
    up = scale * axes.up;
    depth = axes.along;
    line_area_ = area / finer;
    column_step_ = axes.right / (static_cast<float>(finer) * scale);
    row_step_ = axes.up / scale;
    along_ = along;
  }
  right_ = right;
  up_ = up;
  depth_ = depth;
  Bounds box;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    projected_[i] = {glm::dot(vertices[i], right), glm::dot(vertices[i], up), glm::dot(vertices[i], depth)};
    box.include(projected_[i]);
  }
  if (surfaces.period) {
    // The corner is a whole number of periods away, so that pixels of all directions are counted from the same place.
    const glm::dvec2 size(size_);
    pixels_.corner = size * glm::floor((glm::dvec2(box.low) - offset) / size) + offset;
  } else {
    pixels_.corner = glm::floor(glm::dvec2(box.low) - offset) + offset;
    size_ = glm::ivec2(glm::ceil(glm::dvec2(box.high) - pixels_.corner)) + 1;
  }
  per_size_ = 1.f / glm::vec2(size_);
  shift_ = pixels_.corner;
  corner_ = (shift_.x + 0.5f) * column_step_ + (shift_.y + 0.5f) * row_step_;
  pixels_.pixels_per_metre = 1.;
  const glm::ivec2 whole = glm::ivec2(glm::ceil(glm::dvec2(box.high) - pixels_.corner)) + 1;
  pixels_.columns = whole.x;
  pixels_.rows = whole.y;
}

std::size_t LineGrid::triangles() const {
  return surfaces_.mesh->leaf_triangles.size() + surfaces_.mesh->wood_triangles.size();
}

}  // namespace sunfleck::detail
