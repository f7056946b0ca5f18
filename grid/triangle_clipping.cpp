#include "grid/triangle_clipping.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace sunfleck {
namespace {

// Rounding may leave an edge that a plane crosses more than once; the corners past the room for them are then so close
// to others that they hold no area worth the name.
void append(ConvexPolygon& polygon, const glm::dvec3& corner) {
  if (const auto i = static_cast<std::size_t>(polygon.count); i < polygon.corners.size()) {
    polygon.corners[i] = corner;
    ++polygon.count;
  }
}

// From the lower end, so that both neighbours of an edge compute the same corner.
glm::dvec3 crossing(const glm::dvec3& from, const glm::dvec3& to, int axis, double at) {
  const glm::dvec3& low = from[axis] < to[axis] ? from : to;
  const glm::dvec3& high = from[axis] < to[axis] ? to : from;
  glm::dvec3 corner = low + (high - low) * ((at - low[axis]) / (high[axis] - low[axis]));
  corner[axis] = at;
  return corner;
}

// Without a call, which std::floor would be.
int wholePart(double x) {
  const int truncated = static_cast<int>(x);
  return truncated - (static_cast<double>(truncated) > x);
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  // Cells from first() to last() are crossed; a polygon in the plane between two cells is in the upper one.
  int first() const { return wholePart(low); }
  int last() const { return std::max(first(), -wholePart(-high) - 1); }
};

Extent extent(const ConvexPolygon& polygon, int axis) {
  Extent along;
  for (int i = 0; i < polygon.count; ++i) {
    const double x = polygon.corners[static_cast<std::size_t>(i)][axis];
    along.low = std::min(along.low, x);
    along.high = std::max(along.high, x);
  }
  return along;
}

// Areas of polygons of one plane, by their projection along the axis that the plane faces most.
struct PlaneArea {
  int u, v;       // the two other axes
  double factor;  // area over twice the projected area [1]; 0 for a plane without a normal

  explicit PlaneArea(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int facing = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    u = (facing + 1) % 3;
    v = (facing + 2) % 3;
    factor = size[facing] > 0. ? 0.5 * glm::length(normal / size[facing]) : 0.;
  }

  double operator()(const ConvexPolygon& polygon) const {
    const auto& p = polygon.corners;
    double twice = 0.;
    for (std::size_t i = 2; i < static_cast<std::size_t>(polygon.count); ++i)
      twice += (p[i - 1][u] - p[0][u]) * (p[i][v] - p[0][v]) - (p[i][u] - p[0][u]) * (p[i - 1][v] - p[0][v]);
    return factor * std::abs(twice);
  }
};

// Cuts off one slab after the other along `axis`, and hands each to the next axis.
void shareAlong(int axis, const ConvexPolygon& polygon, glm::ivec3 cell, const PlaneArea& area,
                std::vector<CellShare>& shares) {
  if (axis == 3) {
    const double share = area(polygon);
    if (share > 0.) shares.push_back({cell, share});
    return;
  }
  const Extent along = extent(polygon, axis);
  cell[axis] = along.first();
  if (along.first() == along.last()) return shareAlong(axis + 1, polygon, cell, area, shares);

  ConvexPolygon slab, beyond[2];
  const ConvexPolygon* rest = &polygon;
  for (int turn = 0; cell[axis] < along.last(); ++cell[axis], turn = 1 - turn) {
    cut(*rest, axis, cell[axis] + 1., slab, beyond[turn]);
    rest = &beyond[turn];
    if (slab.count > 0) shareAlong(axis + 1, slab, cell, area, shares);
  }
  if (rest->count > 0) shareAlong(axis + 1, *rest, cell, area, shares);
}

}  // namespace

ConvexPolygon triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  ConvexPolygon polygon;
  for (const glm::dvec3& corner : {a, b, c}) append(polygon, corner);
  return polygon;
}

void cut(const ConvexPolygon& polygon, int axis, double at, ConvexPolygon& below, ConvexPolygon& above) {
  below.count = above.count = 0;
  bool any_below = false, any_above = false;
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec3& corner = polygon.corners[static_cast<std::size_t>(i)];
    const glm::dvec3& next = polygon.corners[static_cast<std::size_t>(i + 1 == polygon.count ? 0 : i + 1)];
    if (corner[axis] <= at) append(below, corner);
    if (corner[axis] >= at) append(above, corner);
    any_below |= corner[axis] < at;
    any_above |= corner[axis] > at;
    if ((corner[axis] < at && next[axis] > at) || (corner[axis] > at && next[axis] < at)) {
      const glm::dvec3 between = crossing(corner, next, axis, at);
      append(below, between);
      append(above, between);
    }
  }
  if (!any_below || below.count < 3) below.count = 0;
  if ((any_below && !any_above) || above.count < 3) above.count = 0;
}

ConvexPolygon clip(const ConvexPolygon& polygon, const glm::dvec3& low, const glm::dvec3& high) {
  ConvexPolygon inside = polygon, part, beyond;
  for (int axis = 0; axis < 3; ++axis) {
    const Extent along = extent(inside, axis);
    if (along.low < low[axis]) {
      cut(inside, axis, low[axis], beyond, part);
      inside = part;
    }
    if (along.high >= high[axis]) {
      cut(inside, axis, high[axis], part, beyond);
      inside = part;
    }
  }
  return inside;
}

void shareAmongCells(const ConvexPolygon& polygon, const glm::dvec3& normal, std::vector<CellShare>& shares) {
  const PlaneArea area(normal);
  if (polygon.count >= 3 && area.factor > 0.) shareAlong(0, polygon, glm::ivec3(0), area, shares);
}

}  // namespace sunfleck
