#include "core/directions.hpp"

#include <algorithm>
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
namespace {

// Moves each axis down the slope of the energy that like charges at both ends of all axes have.
void relax(std::vector<glm::dvec3>& axes) {
  constexpr int kSteps = 400;  // the energy of 11 or 24 axes has come to rest by then
  const auto count = static_cast<double>(axes.size());
  const double step =
      1. / (std::sqrt(2. * count) * count);  // the force of a neighbour grows as count, their gap shrinks
  std::vector<glm::dvec3> forces(axes.size());
  const auto repulsion = [](glm::dvec3 apart) {
    const double squared = glm::dot(apart, apart);
    return apart / (squared * std::sqrt(squared));
  };
  for (int k = 0; k < kSteps; ++k) {
    std::fill(forces.begin(), forces.end(), glm::dvec3(0.));
    for (std::size_t i = 0; i < axes.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const glm::dvec3 near = repulsion(axes[i] - axes[j]), far = repulsion(axes[i] + axes[j]);
        forces[i] += near + far;
        forces[j] += far - near;
      }
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i] = glm::normalize(axes[i] + step * (forces[i] - axes[i] * glm::dot(axes[i], forces[i])));
  }
}

// The upper half of 2 count spherical Fibonacci points.
std::vector<glm::dvec3> fibonacciPoints(int count) {
  std::vector<glm::dvec3> points;
  const double golden_angle = std::numbers::pi * (3. - std::sqrt(5.));
  for (int i = 0; i < count; ++i) {
    const double z = 1. - (2. * i + 1.) / (2. * count);
    const double r = std::sqrt(1. - z * z);
    points.emplace_back(r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z);
  }
  return points;
}

// Turns all axes alike, so that lines along them pass a level layer on ways as short as can be: in sum over the axes,
// the length seen from above, |cot| of the elevation.
void turnFromLevel(std::vector<glm::dvec3>& axes) {
  constexpr int kTried = 4096;  // directions that may become the vertical
  const auto way = [&](const glm::dvec3& up) {
    double sum = 0.;
    for (const glm::dvec3& axis : axes) {
      const double rise = std::abs(glm::dot(axis, up));
      sum += std::sqrt(std::max(0., 1. - rise * rise)) / std::max(rise, 1e-9);
    }
    return sum;
  };
  const std::vector<glm::dvec3> tried = fibonacciPoints(kTried);
  std::vector<double> ways;
  for (const glm::dvec3& up : tried) ways.push_back(way(up));
  const auto best = std::min_element(ways.begin(), ways.end()) - ways.begin();
  const Axes turned = axesAlong(glm::vec3(tried[static_cast<std::size_t>(best)]));
  for (glm::dvec3& axis : axes)
    axis = {glm::dot(axis, glm::dvec3(turned.right)), glm::dot(axis, glm::dvec3(turned.up)),
            glm::dot(axis, glm::dvec3(turned.along))};
}

}  // namespace

std::vector<Direction> spreadAxes(int count) {
  assert(count > 0);
  std::vector<glm::dvec3> axes = fibonacciPoints(count);
  if (count <= kMostRelaxedAxes) relax(axes);
  turnFromLevel(axes);
  std::vector<Direction> directions;
  for (const glm::dvec3& axis : axes) directions.push_back(glm::normalize(glm::vec3(axis)));
  return directions;
}

}  // namespace sunfleck
