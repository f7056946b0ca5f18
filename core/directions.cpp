#include "core/directions.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace sunfleck {

Direction sunlight(float zenith, float azimuth) {
  const glm::dvec3 to_sun(std::sin(double{zenith}) * std::cos(double{azimuth}),
                          std::sin(double{zenith}) * std::sin(double{azimuth}), std::cos(double{zenith}));
  return glm::normalize(glm::vec3(-to_sun));
}

// Branch-free basis of Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
Axes axesAlong(Direction along) {
  const float sign = std::copysign(1.f, along.z);
  const float a = -1.f / (sign + along.z);
  const float b = along.x * along.y * a;
  return {.right = {1.f + sign * along.x * along.x * a, sign * b, -sign * along.x},
          .up = {b, sign + along.y * along.y * a, -along.y},
          .along = along};
}

std::vector<Direction> spreadDirections(int count) {
  assert(count > 0);
  std::vector<Direction> directions;
  directions.reserve(static_cast<std::size_t>(count));
  const double golden_angle = std::numbers::pi * (3. - std::sqrt(5.));
  for (int i = 0; i < count; ++i) {
    const double z = 1. - (2. * i + 1.) / count;
    const double r = std::sqrt(1. - z * z);
    const double azimuth = golden_angle * i;
    directions.push_back(glm::normalize(glm::vec3(glm::dvec3(r * std::cos(azimuth), r * std::sin(azimuth), z))));
  }
  return directions;
}

}  // namespace sunfleck
