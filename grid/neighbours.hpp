#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/directions.hpp"
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

// Displacements of the other instances of a stand from tree `index` [m]: the other trees and, in a periodic stand,
// their copies and its own within periodsAround(). Rotations are not regarded.
std::vector<glm::vec3> neighbourDisplacements(const Stand& stand, const Bounds& box, std::size_t index);

// Those of the displacements whose instance can be met from somewhere in `box` along `direction` or against it. `box`
// is that of one instance.
std::vector<glm::vec3> neighboursAlong(std::span<const glm::vec3> displacements, const Bounds& box,
                                       Direction direction);

}  // namespace sunfleck
