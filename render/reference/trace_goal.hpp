#pragma once

#include <functional>
#include <limits>
#include <string>

#include "core/progress.hpp"
#include "render/reference/trace_run.hpp"
#include "render/reference/trace_store.hpp"
#include "render/reference/trace_team.hpp"

namespace sunfleck {

// What a run works towards.
struct TraceGoal {
  // What to compute next for the run of a seed, given what has been found: units that are missing; none when it is
  // enough.
  std::function<UnitRanges(const TraceSums& sums, std::uint64_t seed)> next;
  // Where `next` rests on what was found, a name of the goal: with it the plan is kept for when the run goes on.
  std::string name{};
  double seconds = std::numeric_limits<double>::infinity();  // time to stop at
};

// Computes the units `wanted`.
TraceGoal allOf(UnitRanges wanted);

// Computes units [0, most) until `error` of what was found, looked at from time to time, is at most `target`.
TraceGoal until(double target, std::function<double(const TraceSums& sums)> error, std::uint64_t most);

// Works towards the goal from what the section has, writing the store's file now and then and at the end. Answers false
// when time or `progress` ended it early; what was computed by then is in the section. A run that is told to stop in
// the middle and goes on later finds the same to the last bit. So does a team, all of whose ranks call it: rank 0 alone
// looks at the goal and has the sums and the store; to the others it answers the same.
bool pursue(const TraceGoal& goal, const TraceJob& job, TraceSection& section, TraceStore& store, std::uint64_t seed,
            int threads, const Progress& progress = {}, TraceTeam* team = nullptr);

}  // namespace sunfleck
