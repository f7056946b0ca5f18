#pragma once

#include <cstdint>

#include "core/progress.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// Which units to compute, and how.
struct TraceUnits {
  std::uint64_t seed = 1;
  std::uint64_t first = 0, last = 0;  // units [first, last)
  int threads = 0;                    // at most; 0: all cores
};

// Computes those of `units` that `sums` has not yet, side by side, and adds them. `progress` is told after each, when
// nobody adds to the sums; when it answers false, what is being computed is dropped.
void runUnits(const TraceJob& job, const TraceUnits& units, TraceSums& sums, const Progress& progress = {});

}  // namespace sunfleck
