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

}  // namespace

SphereOrdinates::SphereOrdinates(int directions) {
  require(directions >= 8 && directions <= 2048 && directions % 2 == 0, "directions", directions,
          "an even number of 8 to 2048");
  const Quarters quarters = byOctant(wellTurned(spreadAxes(directions / 2)));
  std::size_t most = 0;
  for (const auto& quarter : quarters) most = std::max(most, quarter.size());
  const std::size_t lanes = (most + kLanes - 1) / kLanes * kLanes;
  directions_.resize(lanes * kOctants);
  weights_.assign(lanes * kOctants, 0.f);
  const float weight = 4.f * std::numbers::pi_v<float> / static_cast<float>(directions);
  for (std::size_t octant = 0; octant < 4; ++octant) {
    const glm::dvec3 filling =
        glm::dvec3(octant & 1 ? -1. : 1., octant & 2 ? -1. : 1., 1.) / std::numbers::sqrt3;  // of weight 0
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const bool filled = lane < quarters[octant].size();
      const Direction s = glm::normalize(glm::vec3(filled ? quarters[octant][lane] : filling));
      const std::size_t up = octant * lanes + lane, down = (7 - octant) * lanes + lane;
      directions_[up] = s;
      directions_[down] = -s;
      weights_[up] = weights_[down] = filled ? weight : 0.f;
    }
  }
  for (int a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < size(); ++i)
      half_flux_[static_cast<std::size_t>(a)] += 0.5 * double{weights_[i]} * std::abs(double{directions_[i][a]});
}

}  // namespace sunfleck
