#include "render/reference/trace_goal.hpp"

#include <algorithm>
#include <utility>

#include "core/elapsed.hpp"
#include "render/reference/trace_effort.hpp"

namespace sunfleck {

TraceGoal allOf(UnitRanges wanted) {
  return {.next = [wanted = std::move(wanted), given = false](const TraceSums&) mutable {
    return std::exchange(given, true) ? UnitRanges() : wanted;
  }};
}

TraceGoal until(double target, std::function<double(const TraceSums& sums)> error, std::uint64_t most) {
  return {.next =
              [=](const TraceSums& sums) {
                const std::uint64_t done = sums.units();
                if (done >= most || (done >= kLeastUnits && error(sums) <= target)) return UnitRanges();
                return UnitRanges(0, std::min(most, std::max(kLeastUnits, done + done / 2)));
              },
          .decides_by_findings = true};
}

bool pursue(const TraceGoal& goal, const TraceJob& job, TraceSection& section, TraceStore& store, std::uint64_t seed,
            int threads, const Progress& progress) {
  const Elapsed elapsed;
  bool go_on = true;
  const Progress watch = [&](double done) {
    store.writeIfDue();
    go_on = goOn(progress, done) && elapsed.seconds() < goal.seconds && go_on;
    return go_on;
  };
  if (!goal.decides_by_findings) section.planned = {};
  while (go_on) {
    if (section.planned.without(section.sums.done(seed)).count() == 0) section.planned = goal.next(section.sums);
    if (section.planned.count() == 0) break;
    runUnits(job, {.seed = seed, .wanted = section.planned, .threads = threads}, section.sums, watch);
  }
  if (!goal.decides_by_findings) section.planned = {};
  store.write();
  return go_on;
}

}  // namespace sunfleck
