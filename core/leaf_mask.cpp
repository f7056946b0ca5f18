#include "core/leaf_mask.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunfleck {
namespace {

using Polygon = std::vector<glm::dvec2>;

// The part of a convex polygon where sign * p[axis] <= sign * limit (Sutherland & Hodgman 1974).
Polygon cut(const Polygon& polygon, int axis, double limit, double sign) {
  Polygon rest;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = sign * (a[axis] - limit), over_b = sign * (b[axis] - limit);
    if (over_a <= 0.) rest.push_back(a);
    if ((over_a < 0. && over_b > 0.) || (over_a > 0. && over_b < 0.))
      rest.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  return rest;
}

double areaOf(const Polygon& polygon) {
  if (polygon.size() < 3) return 0.;
  double twice = 0.;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

std::pair<double, double> extentOf(const Polygon& polygon, int axis) {
  const auto [low, high] = std::minmax_element(polygon.begin(), polygon.end(),
                                               [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  return {std::floor((*low)[axis]), std::ceil((*high)[axis])};
}

// Of an image that repeats.
std::size_t wrapped(double at, int count) {
  const double within = at - std::floor(at / count) * count;
  return std::min(static_cast<std::size_t>(within), static_cast<std::size_t>(count - 1));
}

glm::dvec2 inPixels(const LeafMask& mask, const glm::dvec2& corner) {
  return {corner.x * mask.width, (1. - corner.y) * mask.height};
}

}  // namespace

bool LeafMask::at(const ImageCorners& corners, float second, float third) const {
  const glm::vec2 point = (1.f - second - third) * corners[0] + second * corners[1] + third * corners[2];
  const glm::dvec2 pixel = inPixels(*this, point);
  return opaque[wrapped(pixel.y, height) * static_cast<std::size_t>(width) + wrapped(pixel.x, width)] != 0;
}

// Row by row of pixels, in runs of pixels that are leaf.
double opaqueShare(const LeafMask& mask, const ImageCorners& corners) {
  Polygon triangle;
  for (const glm::vec2& corner : corners) triangle.push_back(inPixels(mask, corner));
  double area = 0.;
  const auto [top, bottom] = extentOf(triangle, 1);
  for (double y = top; y < bottom; ++y) {
    const Polygon row = cut(cut(triangle, 1, y, -1.), 1, y + 1., 1.);
    if (row.size() < 3) continue;
    const std::uint8_t* const pixels =
        mask.opaque.data() + wrapped(y, mask.height) * static_cast<std::size_t>(mask.width);
    const auto [left, right] = extentOf(row, 0);
    for (double x = left; x < right;) {
      if (!pixels[wrapped(x, mask.width)]) {
        ++x;
        continue;
      }
      double end = x + 1.;
      while (end < right && pixels[wrapped(end, mask.width)]) ++end;
      area += areaOf(cut(cut(row, 0, x, -1.), 0, end, 1.));
      x = end;
    }
  }
  return std::min(area / areaOf(triangle), 1.);
}

}  // namespace sunfleck
