#pragma once

#include <string>
#include <vector>

#include "core/progress.hpp"
#include "pp_solver/slab_batch.hpp"
#include "pp_solver/solver.hpp"

namespace sunfleck {

// What one way of solving one slab costs and how far it is off.
struct SlabBenchPoint {
  std::string problem;  // its name
  pp::SlabCase slab;
  pp::Settings settings;
  double flux_seconds = 0.;      // to solve and read reflectance and transmittance: median of repeats
  double flux_error = 0.;        // the larger error of the two [1]
  double radiance_seconds = 0.;  // to solve and read radiances at 6 cosines, 3 azimuths and 3 depths: median
  double radiance_error = 0.;    // RMS of their errors over the RMS of the radiances [1]
};

// The exact solver at N = 2, 4, 8 ... 128, with and without delta-M and corrections, against itself at N = 256, on the
// problem of bench_pp_solver (g 0.85, omega 0.99, thickness 10, mu0 0.5) and the same with isotropic scattering, where
// delta-M and corrections have nothing to do and are on. On one thread. Ended early by `progress`: an empty list.
std::vector<SlabBenchPoint> benchSlabs(const Progress& progress = {});

std::string slabBenchCsv(const std::vector<SlabBenchPoint>& points);
std::string slabBenchPlot(const std::vector<SlabBenchPoint>& points);  // SVG

}  // namespace sunfleck
