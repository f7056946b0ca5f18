#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/directions.hpp"
#include "core/stand.hpp"

namespace sunfleck {

// Copies of a periodic stand farther than this many periods away are left out: a path that long through the crown layer
// meets so many leaves that nothing of it arrives.
inline constexpr int kPeriodsAround = 8;

// Displacements of the other instances of a stand from tree `index` [m]: the other trees and, in a periodic stand,
// their copies and its own within kPeriodsAround. Rotations are not regarded.
std::vector<glm::vec3> neighbourDisplacements(const Stand& stand, std::size_t index);

// Those of the displacements whose instance can be met from somewhere in `box` along `direction`, or against it when
// `both_ways`. `box` is that of one instance.
std::vector<glm::vec3> neighboursAlong(std::span<const glm::vec3> displacements, const Bounds& box, Direction direction,
                                       bool both_ways);

}  // namespace sunfleck
