#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

namespace sunfleck {

// A flat convex polygon in space: what is left of a triangle after cuts by planes across the axes. Each cut adds at
// most one corner; six cuts leave a box, and a cell within it takes six more.
struct ConvexPolygon {
  std::array<glm::dvec3, 16> corners;
  int count = 0;  // corners in use, 0 or at least 3
};

ConvexPolygon triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

// (D2) Cuts a polygon by the plane where the coordinate along `axis` (0, 1, 2) is `at`. Corners on the plane belong to
// both parts; a polygon that lies in the plane belongs to `above`. New corners lie exactly on the plane, so that the
// parts of neighbours fit and their areas add up to the whole but for rounding.
void cut(const ConvexPolygon& polygon, int axis, double at, ConvexPolygon& below, ConvexPolygon& above);

// What of a polygon lies between two corners of a box.
ConvexPolygon clip(const ConvexPolygon& polygon, const glm::dvec3& low, const glm::dvec3& high);

// The part of a triangle's area inside one cell.
struct CellShare {
  glm::ivec3 cell;  // the unit cube from `cell` to `cell` + 1
  double area;      // [squared side of a cell], > 0
};

// (D2) Appends the shares of the cells that a flat polygon crosses, by cutting it into slabs along x, these into
// columns along y, and these into cells along z. The shares add up to the polygon's area but for rounding. Coordinates
// are in units of the side of a cell, at most 2^30 in size.
//   normal  perpendicular to the polygon, of any length; a zero vector shares nothing
void shareAmongCells(const ConvexPolygon& polygon, const glm::dvec3& normal, std::vector<CellShare>& shares);

}  // namespace sunfleck
