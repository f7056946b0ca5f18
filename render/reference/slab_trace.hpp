#pragma once

#include <vector>

#include "core/progress.hpp"
#include "render/reference/trace_effort.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// A homogeneous slab of Henyey-Greenstein scatterers on a black ground, in parallel light from above.
struct TracedSlab {
  double asymmetry = 0.;  // g, mean cosine of scattering [1], -1 < g < 1
  double albedo = 0.;     // omega [1], 0 .. 1
  double thickness = 1.;  // optical [1], above 0; may be infinite
  double mu0 = 1.;        // |cos| of the beam to the normal [1], (0, 1]
};

// Where and in which direction of travel radiance is asked for.
struct SlabView {
  double depth = 0.;    // optical, below the lit face [1], 0 .. thickness
  double mu = -1.;      // cos to the downward normal [1], [-1, 1], not 0
  double azimuth = 0.;  // from that of the beam [rad]
};

// What a trace measures beside the totals.
struct SlabMeasures {
  std::vector<double> depths;  // of fluxes [1], 0 .. thickness
  std::vector<SlabView> views;
};

struct SlabTraceResult {
  // Shares of the flux that arrives: reflectance + transmittance + absorptance = 1. Transmittance includes the direct
  // light, which is known exactly.
  Estimate reflectance, transmittance, absorptance;
  double direct = 0.;
  // Per irradiance of the beam on a plane that faces it.
  std::vector<Estimate> flux_down, flux_up;  // at each depth [1], the direct light's mu0 e^(-z / mu0) included
  std::vector<Estimate> radiance;            // of each view, diffuse light alone [1/sr]
  std::uint64_t paths = 0;                   // traced; fewer than asked for when ended early
  double seconds = 0., cpu_seconds = 0.;     // wall time, and of all threads of the process
};

// (R8) Monte Carlo of a slab. A path of a million scatterings is absorbed where it is: only without absorption and in a
// slab thicker than some hundreds is that ever seen, as 2e-3 of the light at most (infinite thickness), and paths are
// slow there. When `progress` ends it early, the units done until then are the result, at least one.
// Throws InvalidInput on a slab, a measure or an effort out of its range.
SlabTraceResult traceSlab(const TracedSlab& slab, const SlabMeasures& measures, const TraceEffort& effort,
                          const Progress& progress = {});

}  // namespace sunfleck
