#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "field/detail/lanes.hpp"
#include "field/detail/returning.hpp"
#include "field/field_solver.hpp"

namespace sunfleck::detail {

// Light before it is scattered from element to element, as irradiance of each side [the problems' light]: suns' light
// scattered once (F6); light of the sky and, without a period, of the ground.
struct LightSources {
  std::vector<Lanes> source;          // the last entry is the ground's
  std::vector<Lanes> direct;          // suns' light itself, scaled
  std::array<float, kLanes> scale{};  // of it: its power is then what the elements, as large as their lines make them,
                                      // pass on [1]
  std::array<FieldBalance, kLanes> balance{};  // what came in, and what the first scattering sent out
};

// Of up to kLanes problems.
//   optics       of each kind, those of the problems in its lanes
//   ground_area  of the ground, as large as its lines make it [m^2]
LightSources lightSources(const FieldGeometry& geometry, std::span<const FieldProblem> problems,
                          std::span<const KindOptics> optics, const Returning& returning, double ground_area);

// Radiance of the ground around a stand without a period [the problem's light / sr].
double openGround(const FieldProblem& problem);

// Irradiance by lines of a side per sum over them of radiance, in units of 1 / pi.
inline float perLine(const LineExchange& exchange, std::size_t side) {
  return 1.f / static_cast<float>(std::max(exchange.lines[side / 2], 1u));
}

}  // namespace sunfleck::detail
