#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/leaf_optics.hpp"
#include "core/progress.hpp"
#include "field/elements.hpp"
#include "field/line_exchange.hpp"
#include "field/lit_places.hpp"

namespace sunfleck {

// What an element does to light: a leaf scatters from either side to both; wood reflects.
struct ElementOptics {
  float reflectance = 0.f, transmittance = 0.f;  // [1], >= 0, together <= 1
  float albedo() const { return reflectance + transmittance; }
  bool operator==(const ElementOptics&) const = default;
};

// One case to solve: light of one band and from one source, and what it meets.
struct FieldProblem {
  const DirectLight* direct = nullptr;  // of a sun; none: dark
  const LitPlaces* lit = nullptr;       // and where it falls; none: evenly on each side
  // What the lines of each side bring of that sun's light, scattered once where it falls: pi times the sum of their
  // radiances [1]; empty: that follows from the above. Of what leaves along lines to the outside nothing is told, which
  // the balance then lacks.
  std::span<const float> scattered_once{};
  // Irradiance of each side by light that comes along the exchange's lines from beyond it [1]; empty: none.
  std::span<const float> arriving{};
  std::span<const float> outside{};       // radiance of the sky in which light travels in each of the exchange's
                                          // directions [1/sr]; 0 for those that rise; empty: none
  std::span<const ElementOptics> optics;  // of each kind
  float ground_albedo = 0.f;              // [1], 0 .. 1
  float ground_open = 0.f;                // without a period: irradiance of the ground, taken as open [1]
};

// Where the light went, in units of irradiance times area [m^2]. in = absorbed + up + down, but for the error of the
// iteration.
struct FieldBalance {
  double in = 0.;  // direct light that meets elements or ground, and light of the sky and, without period, of
                   // the ground that enters
  double absorbed_leaves = 0., absorbed_wood = 0., absorbed_ground = 0.;
  double out_up = 0., out_down = 0.;  // leaves the stand; with a period nothing leaves downward: the ground takes it
};

struct FieldSolution {
  std::vector<float> scattered;  // irradiance of each side by all but the suns' direct light [as the problem's light]
  double ground = 0.;            // irradiance of the ground: with a period the mean over it, else that of open ground
  FieldBalance balance;
  int iterations = 0;
  double error_bound =
      0.;  // bound on the error that iteration leaves in the light of all sides: RMS, relative to it [1]
  bool converged = true;
};

struct SolverEffort {
  double error = 2e-3;  // bound on the relative RMS error of all sides' light at which iteration ends [1]
  int most_iterations = 200;
};

// What light meets in some problems, at most.
struct FieldAlbedo {
  std::vector<ElementOptics> of_kinds;  // of each kind of element
  float ground = 0.f;                   // with a period [1], 0 .. 1
  bool operator==(const FieldAlbedo&) const = default;
};

// Elements, what they exchange, and how light goes back where it came from.
struct FieldGeometry {
  const FieldElements& elements;
  const LineExchange& exchange;
  std::span<const std::uint32_t> kinds;  // of each element: which of each problem's optics are its
  std::span<const float> near_return;    // (F7) of each kind [1]
  bool periodic;
};

// (F5) The share of the light that stays in the stand from one scattering to the next, where it is spread as it stays
// longest: the largest eigenvalue of exchange and albedo together [1], 0 .. 1. Throws std::runtime_error("interrupted")
// when `progress`, asked before each step, ends it.
double recollision(const FieldGeometry& geometry, const FieldAlbedo& albedo, const Progress& progress = {});

FieldAlbedo largestAlbedo(std::span<const FieldProblem> problems);

// (F4) Solves some problems at once, by Anderson's acceleration of the passage of light from element to element
// (Anderson 1965; Walker & Ni 2011). The result is the same to the bit for any number of threads.
//   recollision  of the problems' largestAlbedo()
// Throws InvalidInput where light that comes in can neither leave nor be absorbed: there is no steady state; and
// std::runtime_error("interrupted") when `progress`, told after each iteration, ends it.
std::vector<FieldSolution> solveField(const FieldGeometry& geometry, std::span<const FieldProblem> problems,
                                      double recollision, const SolverEffort& effort = {},
                                      const Progress& progress = {});

}  // namespace sunfleck
