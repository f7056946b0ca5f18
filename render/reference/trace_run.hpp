#pragma once

#include <filesystem>
#include <functional>

#include "core/progress.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// Which units to compute, and how.
struct TraceUnits {
  std::uint64_t seed = 1;
  std::uint64_t first = 0, last = 0;  // units [first, last) ...
  int threads = 0;                    // at most; 0: all cores
};

// Told after each unit, by one thread at a time, while nobody adds to the sums: false ends the run.
using UnitDone = std::function<bool(const TraceSums& sums)>;

// Computes those of `units` that `sums` has not yet, side by side, and adds them. When `unit_done` answers false,
// what is being computed is dropped, at least one unit having been added.
void runUnits(const TraceJob& job, const TraceUnits& units, TraceSums& sums, const UnitDone& unit_done);

}  // namespace sunfleck
