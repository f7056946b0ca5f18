#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "core/bounds.hpp"
#include "core/stand.hpp"

namespace sunfleck {

// Copies of a periodic stand farther than this many tree widths or periods, whichever is longer, are left out: a path
// that long through the crown layer meets so many leaves that nothing of it arrives.
inline constexpr int kWidthsAround = 8;

// A period may be this much shorter than the tree is wide; more would overlap so many copies that no medium is like it.
inline constexpr int kMostOverlap = 8;

// How many periods away copies count, in x and in y: 0, 0 without a period. `box` is that of one tree. Throws
// InvalidInput when the trees overlap more than kMostOverlap-fold.
glm::ivec2 periodsAround(const Stand& stand, const Bounds& box);

// Throws InvalidInput when more than kMostOverlap^2 trees of the stand stand on the ground of one: within half of the
// width and depth of its kind's box, or of their own if that is smaller, copies counted. Each would be summed into
// each.
//   kinds  boxes of the kinds of trees
void requireApart(const Stand& stand, std::span<const Bounds> kinds);

}  // namespace sunfleck
