#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

#include "core/directions.hpp"
#include "core/random.hpp"

namespace sunfleck::detail {

// A direction about the unit vector `normal` with the density cos / pi [1/sr] of Lambert's law.
inline glm::vec3 lambertDirection(const glm::vec3& normal, Random& random) {
  const float radius_squared = random.uniform();
  const float angle = 2.f * std::numbers::pi_v<float> * random.uniform();
  const float radius = std::sqrt(radius_squared);
  const Axes axes = axesAlong(normal);
  return radius * std::cos(angle) * axes.right + radius * std::sin(angle) * axes.up +
         std::sqrt(1.f - radius_squared) * normal;
}

}  // namespace sunfleck::detail
