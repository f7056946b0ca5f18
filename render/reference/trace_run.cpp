#include "render/reference/trace_run.hpp"

#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <vector>

#include "core/elapsed.hpp"

namespace sunfleck {
namespace {

// Hands out the numbers of the ranges, one after the other.
class UnitQueue {
 public:
  explicit UnitQueue(std::vector<UnitRanges::Range> ranges) : ranges_(std::move(ranges)) {}

  bool take(std::uint64_t& unit) {
    const std::scoped_lock lock(mutex_);
    while (at_ < ranges_.size() && ranges_[at_].first == ranges_[at_].second) ++at_;
    if (at_ == ranges_.size()) return false;
    unit = ranges_[at_].first++;
    return true;
  }

 private:
  std::mutex mutex_;
  std::vector<UnitRanges::Range> ranges_;
  std::size_t at_ = 0;
};

// When a unit throws, the others need not go on.
struct StopOthers {
  Stopped& stopped;
  int exceptions = std::uncaught_exceptions();
  ~StopOthers() {
    if (std::uncaught_exceptions() > exceptions) stopped = true;
  }
};

}  // namespace

void runUnits(const TraceJob& job, const TraceUnits& units, TraceSums& sums, const Progress& progress) {
  const UnitRanges missing = units.wanted.without(sums.done(units.seed));
  const std::uint64_t wanted = units.wanted.count(), count = missing.count();
  std::uint64_t added = 0;
  UnitQueue queue(missing.ranges());
  const Elapsed elapsed;
  Stopped stopped = false;
  std::mutex adding;
  const auto work = [&] {
    UnitTally tally(job.bins());
    StopOthers stop_others{stopped};
    for (std::uint64_t unit;
         !stopped.load(std::memory_order_relaxed) && elapsed.seconds() < units.seconds && queue.take(unit);
         tally.clear()) {
      job.trace(units.seed, unit, tally, stopped);
      const std::scoped_lock lock(adding);
      if (stopped) return;
      sums.add(units.seed, unit, tally);
      ++added;
      const double done = static_cast<double>(wanted - count + added) / static_cast<double>(wanted);
      if (!goOn(progress, done)) stopped = true;
    }
  };
  const int cores = tbb::info::default_concurrency();
  const int threads = units.threads > 0 ? std::min(units.threads, cores) : cores;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::task_group group;
    for (std::uint64_t i = 1; i < std::min<std::uint64_t>(static_cast<std::uint64_t>(threads), count); ++i)
      group.run(work);
    group.run_and_wait(work);
  });
}

UnitRanges partOf(std::uint64_t count, std::uint64_t number, std::uint64_t parts) {
  // The first parts take what does not divide evenly.
  const std::uint64_t each = count / parts, rest = count % parts;
  const auto start = [&](std::uint64_t part) { return part * each + std::min(part, rest); };
  UnitRanges part;
  part.add(start(number), start(number + 1));
  return part;
}

}  // namespace sunfleck
