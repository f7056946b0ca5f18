#pragma once

#include <cstdint>
#include <limits>

#include "core/progress.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// What a run is to compute, and how.
struct TraceUnits {
  std::uint64_t seed = 1;
  UnitRanges wanted{};
  int threads = 0;  // at most; 0: all cores
  // After so long no further unit is begun.
  double seconds = std::numeric_limits<double>::infinity();
};

// Computes those of `units` that `sums` has not yet, side by side, and adds them. `progress` is told after each how
// much of the wanted is there, when nobody adds to the sums; when it answers false, what is being computed is dropped.
void runUnits(const TraceJob& job, const TraceUnits& units, TraceSums& sums, const Progress& progress = {});

// Part `number` of `parts` of the units [0, count), number from 0: what one of several machines computes.
UnitRanges partOf(std::uint64_t count, std::uint64_t number, std::uint64_t parts);

}  // namespace sunfleck
