#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/progress.hpp"

namespace sunfleck {

// What one way of computing the light in a slab costs and how far it is off, on the slabs of slabCourse().
struct SlabBenchRow {
  std::string model;       // a closed form, a table or the exact solver, pp:N
  std::string kind;        // "closed form", "table", "exact"
  int streams = 0;         // n of each half of a closed form; N over both of the exact solver
  int azimuth_orders = 0;  // of n streams; 0 where the model has no such choice
  // Seconds of one evaluation, on one thread: of P+ and P- (or of the fluxes) at a depth, and of radiance there in one
  // direction; median of rounds. Closed forms: single precision, arrays of places of one medium and beam, whose
  // constants are at hand; depth and thickness are new. Tables: a look-up. Exact: a solution.
  double power_seconds = 0., radiance_seconds = 0.;
  // Seconds of the fluxes at the faces of one of many slabs that are solved together; NaN: not the exact solver.
  double batch_seconds = std::numeric_limits<double>::quiet_NaN();
  double irradiance_error = 0.;  // of (P+ + P-) / 2: RMS of the errors over RMS of the exact values [1]
  double flux_error = 0.;      // largest of the fluxes up and down, over the flux that arrives [1]; NaN: has no fluxes
  double radiance_error = 0.;  // RMS over places and directions, for a beam of irradiance 1 [1/sr]
  bool own_powers = true;      // P+ and P- are not those of an earlier row
};

struct SlabBench {
  std::string machine;
  std::vector<SlabBenchRow> rows;
};

// Closed forms, tables and the exact solver side by side: first their errors, against the exact solver with N = 128;
// then their times, in rounds in which each has its turn, so that what else the machine does falls on all alike. Throws
// std::runtime_error where an answer is not what it should be. Ended early by `progress`: no rows.
SlabBench benchSlabs(const Progress& progress = {});

std::string slabBenchCsv(const SlabBench& bench);
std::string slabBenchPlot(const SlabBench& bench);  // SVG

}  // namespace sunfleck
