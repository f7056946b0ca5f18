#include "field/sphere_ordinates.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"

namespace sunfleck {
namespace {

using Quarters = std::array<std::vector<glm::dvec3>, 4>;  // axes by their octant with z > 0

Quarters byOctant(const std::vector<glm::dvec3>& axes) {
  Quarters quarters;
  for (glm::dvec3 axis : axes) {
    if (axis.z < 0.) axis = -axis;
    quarters[(axis.x < 0. ? 1u : 0u) + (axis.y < 0. ? 2u : 0u)].push_back(axis);
  }
  return quarters;
}

// How far a turned set is from what is wanted: first of all few rows, then, in the mean square, the fluxes through the
// faces of a cell, which Lambert's law and the balance of a slab are made of. None may graze a face, and least of all
// be level: level light passes a stand without end again and again.
double defect(const std::vector<glm::dvec3>& axes) {
  constexpr double grazing = 0.02;
  std::size_t most = 0;
  for (const auto& quarter : byOctant(axes)) most = std::max(most, quarter.size());
  double squares = 0.;
  const double n = static_cast<double>(axes.size());
  for (int a = 0; a < 3; ++a) {
    double flux = 0., second = 0.;
    for (const glm::dvec3& axis : axes) {
      flux += std::abs(axis[a]) / n;
      second += axis[a] * axis[a] / n;
      if (std::abs(axis[a]) < grazing) return 1e9;
    }
    squares += std::pow(2. * flux - 1., 2) + std::pow(3. * second - 1., 2);
  }
  return static_cast<double>((most + SphereOrdinates::kLanes - 1) / SphereOrdinates::kLanes) + std::sqrt(squares);
}

std::vector<glm::dvec3> wellTurned(const std::vector<Direction>& spread) {
  const std::vector<glm::dvec3> axes(spread.begin(), spread.end());
  std::vector<glm::dvec3> best = axes;
  double least = defect(axes);
  Random random(1, 0);
  constexpr int tries = 4000;  // some hundred of which fill the rows of 64 directions
  for (int i = 0; i < tries; ++i) {
    const auto u = [&] { return 2. * random.uniformDouble() - 1.; };
    const glm::dquat turn = glm::normalize(glm::dquat(u(), u(), u(), u()));
    std::vector<glm::dvec3> turned;
    for (const glm::dvec3& axis : axes) turned.push_back(turn * axis);
    if (const double found = defect(turned); found < least) {
      least = found;
      best = std::move(turned);
    }
  }
  return best;
}

std::size_t octantOf(const glm::dvec3& s) {
  return (s.x < 0. ? 1u : 0u) + (s.y < 0. ? 2u : 0u) + (s.z < 0. ? 4u : 0u);
}

}  // namespace

SphereOrdinates::SphereOrdinates(const std::array<std::vector<glm::dvec3>, kOctants>& of_octants, float weight) {
  std::size_t most = 1;
  for (const auto& of_octant : of_octants) most = std::max(most, of_octant.size());
  const std::size_t lanes = (most + kLanes - 1) / kLanes * kLanes;
  for (std::size_t octant = 0; octant < kOctants; ++octant) {
    const glm::dvec3 filling = glm::dvec3(octant & 1 ? -1. : 1., octant & 2 ? -1. : 1., octant & 4 ? -1. : 1.);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const bool filled = lane < of_octants[octant].size();
      directions_.push_back(glm::normalize(glm::vec3(filled ? of_octants[octant][lane] : filling)));
      weights_.push_back(filled ? weight : 0.f);
    }
  }
  for (int a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < size(); ++i)
      half_flux_[static_cast<std::size_t>(a)] += 0.5 * double{weights_[i]} * std::abs(double{directions_[i][a]});
}

// (F13)
SphereOrdinates::SphereOrdinates(int directions) {
  require(directions >= 8 && directions <= 2048 && directions % 2 == 0, "directions", directions,
          "an even number of 8 to 2048");
  std::array<std::vector<glm::dvec3>, kOctants> of_octants;
  for (const glm::dvec3& axis : wellTurned(spreadAxes(directions / 2))) {
    // A direction and its opposite stand at the same place of opposite octants.
    of_octants[octantOf(axis)].push_back(axis);
    of_octants[kOctants - 1 - octantOf(axis)].push_back(-axis);
  }
  *this = SphereOrdinates(of_octants, 4.f * std::numbers::pi_v<float> / static_cast<float>(directions));
}

SphereOrdinates SphereOrdinates::beam(const Direction& along) {
  std::array<std::vector<glm::dvec3>, kOctants> of_octants;
  of_octants[octantOf(along)].emplace_back(along);
  return {of_octants, 1.f};
}

}  // namespace sunfleck
