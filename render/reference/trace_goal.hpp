#pragma once

#include <functional>
#include <limits>

#include "core/progress.hpp"
#include "render/reference/trace_run.hpp"
#include "render/reference/trace_store.hpp"

namespace sunfleck {

// When a run ends.
struct TraceGoal {
  // What to compute next, given what has been found; nothing when that is enough.
  std::function<UnitRanges(const TraceSums& sums)> next;
  bool decides_by_findings = false;  // whether `next` rests on more than what it is to compute
  double seconds = std::numeric_limits<double>::infinity();
};

// Computes the units `wanted`, or those of them that are missing.
TraceGoal allOf(UnitRanges wanted);

// Computes units [0, most) until `error` of what was found, looked at from time to time, is at most `target`.
TraceGoal until(double target, std::function<double(const TraceSums& sums)> error, std::uint64_t most);

// Works towards the goal from what the section has, writing the store's file now and then and at the end. Answers false
// when time or `progress` ended it early; what was computed by then is in the section. A run that is told to stop in
// the middle and goes on later finds the same to the last bit.
bool pursue(const TraceGoal& goal, const TraceJob& job, TraceSection& section, TraceStore& store, std::uint64_t seed,
            int threads, const Progress& progress = {});

}  // namespace sunfleck
