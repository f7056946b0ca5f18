#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

#include "core/directions.hpp"
#include "render/reference/detail/path_random.hpp"

namespace sunfleck::detail {

// A direction about the unit vector `normal` with the density cos / pi [1/sr] of Lambert's law.
inline glm::vec3 lambertDirection(const glm::vec3& normal, PathRandom& random) {
  const auto [radius_squared, turn] = random.pair();
  const float angle = 2.f * std::numbers::pi_v<float> * turn;
  const float radius = std::sqrt(radius_squared);
  const Axes axes = axesAlong(normal);
  return radius * std::cos(angle) * axes.right + radius * std::sin(angle) * axes.up +
         std::sqrt(1.f - radius_squared) * normal;
}

}  // namespace sunfleck::detail
