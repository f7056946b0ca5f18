#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

// The convention of all directions, stated here once: a direction is a unit vector along which light TRAVELS. A vector
// that points back to where light comes from is named so: `to_sun`, `to_eye`. z is up; lengths are metres; angles are
// radians inside the program and degrees where a person types or reads them.
namespace sunfleck {

using Direction = glm::vec3;

// Direction in which sunlight travels when the sun stands at `zenith` [rad, 0 = overhead] and `azimuth` [rad, from +x
// towards +y].
Direction sunlight(float zenith, float azimuth);

// Right-handed orthonormal axes with `along` as the third: right x up = along. Continuous but at along = (0, 0, -1).
struct Axes {
  glm::vec3 right, up, along;
};
inline Axes axesAlong(Direction along) {
  const float sign = std::copysign(1.f, along.z);
  const float a = -1.f / (sign + along.z);
  const float b = along.x * along.y * a;
  return {.right = {1.f + sign * along.x * along.x * a, sign * b, -sign * along.x},
          .up = {b, sign + along.y * along.y * a, -along.y},
          .along = along};
}

// `count` > 0 axes spread evenly: each stands for itself and for the direction opposite. Up to kMostRelaxedAxes they
// are moved from spherical Fibonacci points (Swinbank & Purser 2006) until their Coulomb energy hardly falls any more,
// which for small sets makes the mean of a function of direction a third more accurate; beyond that the points are good
// enough. The set is turned so that no axis is nearly level where that can be: a level line meets the most trees.
std::vector<Direction> spreadAxes(int count);
inline constexpr int kMostRelaxedAxes = 128;

}  // namespace sunfleck
