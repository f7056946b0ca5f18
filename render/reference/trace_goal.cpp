#include "render/reference/trace_goal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/elapsed.hpp"
#include "render/reference/team_run.hpp"
#include "render/reference/trace_effort.hpp"

namespace sunfleck {

TraceGoal allOf(UnitRanges wanted) {
  return {.next = [wanted = std::move(wanted)](const TraceSums& sums, std::uint64_t seed) {
    return wanted.without(sums.done(seed));
  }};
}

TraceGoal until(double target, std::function<double(const TraceSums& sums)> error, std::uint64_t most) {
  return {.next =
              [=](const TraceSums& sums, std::uint64_t seed) {
                const UnitRanges& done = sums.done(seed);
                const std::uint64_t count = done.count();
                if (sums.units() >= kLeastUnits && error(sums) <= target) return UnitRanges();
                return UnitRanges(0, std::min(most, std::max(kLeastUnits, count + count / 2))).without(done);
              },
          .name = fmt::format("error {}", target)};
}

bool pursue(const TraceGoal& goal, const TraceJob& job, TraceSection& section, TraceStore& store, std::uint64_t seed,
            int threads, const Progress& progress, TraceTeam* team) {
  if (team && team->rank() > 0) return assist(*team, job, seed, threads, progress);
  const Elapsed elapsed;
  const std::string plan_of = goal.name.empty() ? "" : fmt::format("{}, seed {}", goal.name, seed);
  if (section.plan_of != plan_of) section.planned = {};
  section.plan_of = plan_of;
  std::optional<TeamLead> lead;
  if (team) lead.emplace(*team, job, seed, threads);
  bool go_on = true;
  const Progress during = [&](double done) {
    return go_on = goOn(progress, done) && elapsed.seconds() < goal.seconds && go_on;
  };
  const Progress watch = [&](double done) {
    store.writeIfDue();
    return during(done);
  };
  while (go_on) {
    section.planned = section.planned.without(section.sums.done(seed));
    if (section.planned.count() == 0) section.planned = goal.next(section.sums, seed);
    if (section.planned.count() == 0) break;
    if (lead)
      go_on = lead->work(section.planned, section.sums, during, watch) && go_on;
    else
      runUnits(job, {.seed = seed, .wanted = section.planned, .threads = threads}, section.sums, watch);
  }
  if (goal.name.empty()) section.planned = {};
  store.write();
  if (lead) lead->end(go_on);
  return go_on;
}

}  // namespace sunfleck
