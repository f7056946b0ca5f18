#pragma once

#include <span>

namespace sunfleck::pp {

// One homogeneous slab of Henyey-Greenstein scatterers on a black ground under a beam.
struct SlabCase {
  double asymmetry = 0.;  // g [1], -1 < g < 1
  double albedo = 0.;     // omega [1], 0 .. 1
  double thickness = 1.;  // optical [1], 1e-100 .. 1e100, or infinite
  double mu0 = 1.;        // |cos| of the beam to the normal [1], 1e-100 .. 1
};

// Relative to the flux that arrives.
struct SlabFluxes {
  double reflectance, transmittance, direct;  // [1]; transmittance includes direct
};

// Solves all cases: nodes and polynomials are shared, several cases run in the lanes of one vector, and all threads
// that TBB may use take part. The same as Solver gives, to rounding, whatever the number of threads. Assumes valid
// cases; result.size() = cases.size().
//   streams  N, even, 2 .. 256
void solveSlabs(std::span<const SlabCase> cases, std::span<SlabFluxes> result, int streams, bool delta_m = true);

}  // namespace sunfleck::pp
