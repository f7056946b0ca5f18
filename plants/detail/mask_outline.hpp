#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/leaf_mask.hpp"

namespace sunfleck::detail {

// A closed line through these points, of the image [pixel, x to the right and y down]. What is leaf lies on its right
// as seen in a picture with y down, so that the signed area below is positive of outlines and negative of holes.
using Outline = std::vector<glm::dvec2>;
double signedArea(const Outline& outline);  // [pixel^2]

// Twice the signed area of the triangle of three points: above 0 where c lies on the left of the line from a to b, with
// y up.
inline double turnOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether a closed line winds about the point, by the even-odd rule.
bool contains(std::span<const glm::dvec2> outline, const glm::dvec2& point);

// The lines between leaf and no leaf along the pixels' edges, without corners on straight lines. Pixels that touch at a
// corner alone are apart.
std::vector<Outline> outlinesOf(const LeafMask& mask);

// Takes corners out of outlines while the area of each stays the same: two neighbours B and C of A B C D make way for
// one, where that moves the line over the least area (segment collapse: Kronenfeld et al. 2020) and neither crosses nor
// passes by another line, until the least is above `most` [pixel^2] or 4 corners are left.
void simplify(std::vector<Outline>& outlines, double most);

}  // namespace sunfleck::detail
