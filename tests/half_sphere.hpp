#pragma once

#include <cmath>
#include <functional>
#include <glm/vec3.hpp>
#include <numbers>

#include "core/directions.hpp"

// Directions and integrals over the upper half of the sphere, for tests of what surfaces send.
namespace sunfleck::half_sphere {

// Unit vector at these angles [rad].
inline glm::vec3 towards(double zenith, double azimuth) {
  return glm::vec3(
      glm::dvec3(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)));
}

inline glm::vec3 mirrored(const glm::vec3& v) {
  return {-v.x, -v.y, v.z};
}

// Integral over the upper half of the sphere, by the rule of midpoints about an axis: near it the rings lie close.
inline double integral(const std::function<double(const glm::vec3&)>& value, const glm::vec3& about, int rings) {
  constexpr double kPi = std::numbers::pi;
  const Axes axes = axesAlong(about);
  double sum = 0.;
  for (int i = 0; i < rings; ++i) {
    const double share = (i + 0.5) / rings, angle = kPi * share * share * share;
    const double ring = kPi * 3. * share * share / rings * std::sin(angle) * 2. * kPi / rings;
    for (int j = 0; j < rings; ++j) {
      const double turn = 2. * kPi * (j + 0.5) / rings;
      const glm::vec3 direction = static_cast<float>(std::cos(angle)) * axes.along +
                                  static_cast<float>(std::sin(angle) * std::cos(turn)) * axes.right +
                                  static_cast<float>(std::sin(angle) * std::sin(turn)) * axes.up;
      if (direction.z > 0.f) sum += ring * value(direction);
    }
  }
  return sum;
}

}  // namespace sunfleck::half_sphere
