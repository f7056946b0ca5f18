#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_run.hpp"
#include "render/reference/trace_sums.hpp"
#include "render/reference/trace_team.hpp"

namespace sunfleck {

// Rank 0's side of a run that a team computes. Units are dealt in rounds of some time, to each rank as many as it is
// likely to do in it, and no rank begins another unit after that time: so all end a round together, however fast each
// of them is. What a rank has not done is dealt anew.
class TeamLead {
 public:
  // Throws InvalidInput when a rank is to compute another job than this one.
  TeamLead(TraceTeam& team, const TraceJob& job, std::uint64_t seed, int threads);

  // Has all of `wanted` computed that `sums` has not yet. Answers false when a rank was told to stop: what was found by
  // then is in the sums. Of the two that are told how much is there [0, 1] and answer whether to go on, `during` is
  // asked after each unit of this rank, `between` after each round, when nobody adds to the sums.
  bool work(const UnitRanges& wanted, TraceSums& sums, const Progress& during, const Progress& between);
  // Lets the others go. To be called once, whatever work() has answered.
  void end(bool go_on);

 private:
  UnitRanges deal(const UnitRanges& missing, std::uint64_t& dealt);

  TraceTeam& team_;
  const TraceJob& job_;
  std::uint64_t seed_;
  int threads_;
  double seconds_;             // of the next round
  std::vector<double> speed_;  // of each rank [unit/s]; 0: not known yet
};

// The side of all other ranks: computes what rank 0 deals out until that ends, and answers what it then said.
bool assist(TraceTeam& team, const TraceJob& job, std::uint64_t seed, int threads, const Progress& progress);

// Throws InvalidInput unless all ranks give the same: what tells their runs apart from others.
void requireSameAtAll(TraceTeam& team, const TraceIdentity& identity);

}  // namespace sunfleck
