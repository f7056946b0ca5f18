#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "core/leaf_mask.hpp"

namespace sunfleck::detail {

// A closed line through these points, of the image [pixel, x to the right and y down]. What is leaf lies on its right
// as seen in a picture with y down, so that the signed area below is positive of outlines and negative of holes.
using Outline = std::vector<glm::dvec2>;
double signedArea(const Outline& outline);  // [pixel^2]

// The lines between leaf and no leaf along the pixels' edges, without corners on straight lines. Pixels that touch at a
// corner alone are apart.
std::vector<Outline> outlinesOf(const LeafMask& mask);

// Takes corners out of outlines while the area of each stays the same: two neighbours B and C of A B C D make way for
// one, where that moves the line over the least area (segment collapse: Kronenfeld et al. 2020) and neither crosses nor
// passes by another line, until the least is above `most` [pixel^2] or 4 corners are left.
void simplify(std::vector<Outline>& outlines, double most);

}  // namespace sunfleck::detail
