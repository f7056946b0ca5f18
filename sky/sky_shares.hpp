#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/directions.hpp"
#include "sky/sky_map.hpp"

namespace sunfleck {

// (R28) Radiance of the sky as some directions see it that stand for all others, per band [1/sr]: the mean over a
// direction's share of the sky, which is what lies nearer to it than to any other that points up; all times a factor,
// so that their mean is that of the whole sky, whatever it looks like. 0 for directions that do not point up.
//   directions  to the sky, unit vectors
std::vector<glm::vec3> skyShares(const SkyMap& sky, std::span<const Direction> directions);

}  // namespace sunfleck
