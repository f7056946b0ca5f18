// Check that a team finds the same bits as one process, however fast its ranks are, when it is told to stop and goes
// on, and towards an error; and that ranks with different runs refuse to work together. Ranks are threads here.
#include "render/reference/team_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>
#include <chrono>
#include <functional>
#include <thread>

#include "core/require.hpp"
#include "render/reference/detail/path_random.hpp"
#include "render/reference/trace_effort.hpp"
#include "render/reference/trace_goal.hpp"

using namespace sunfleck;

namespace {

// What the ranks of a team of threads share.
struct Meeting {
  explicit Meeting(int size) : everyone(size), texts(static_cast<std::size_t>(size)), bins(texts.size()) {}
  std::barrier<> everyone;
  std::vector<std::string> texts;
  std::vector<std::span<TraceSums::Bin>> bins;
};

class ThreadTeam final : public TraceTeam {
 public:
  ThreadTeam(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(meeting_.texts.size()); }

  std::string fromFirst(std::string text) override {
    if (rank_ == 0) meeting_.texts[0] = std::move(text);
    meeting_.everyone.arrive_and_wait();
    std::string told = meeting_.texts[0];
    meeting_.everyone.arrive_and_wait();
    return told;
  }
  std::vector<std::string> toFirst(const std::string& text) override {
    meeting_.texts[static_cast<std::size_t>(rank_)] = text;
    meeting_.everyone.arrive_and_wait();
    std::vector<std::string> told;
    if (rank_ == 0) told = meeting_.texts;
    meeting_.everyone.arrive_and_wait();
    return told;
  }
  void sumToFirst(std::span<TraceSums::Bin> bins) override {
    meeting_.bins[static_cast<std::size_t>(rank_)] = bins;
    meeting_.everyone.arrive_and_wait();
    for (std::size_t rank = 1; rank_ == 0 && rank < meeting_.bins.size(); ++rank)
      for (std::size_t i = 0; i < bins.size(); ++i) {
        bins[i].sum.whole += meeting_.bins[rank][i].sum.whole;
        bins[i].squares.whole += meeting_.bins[rank][i].squares.whole;
      }
    meeting_.everyone.arrive_and_wait();
  }

 private:
  Meeting& meeting_;
  int rank_;
};

// Runs `work` as each rank of a team.
void asTeam(int size, const std::function<void(TraceTeam&)>& work) {
  Meeting meeting(size);
  std::vector<std::jthread> ranks;
  for (int rank = 0; rank < size; ++rank)
    ranks.emplace_back([&meeting, &work, rank] {
      ThreadTeam team(meeting, rank);
      work(team);
    });
}

// The mean of a random number in one bin, and of one of three others.
class Means final : public TraceJob {
 public:
  explicit Means(std::chrono::microseconds duration = {}, std::string name = "means")
      : duration_(duration), name_(std::move(name)) {}
  std::size_t bins() const override { return 4; }
  TraceIdentity identity() const override { return {{"kind", name_}}; }
  void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped&) const override {
    if (duration_.count() > 0) std::this_thread::sleep_for(duration_);
    detail::PathRandom random(detail::Stream::light, seed, unit);
    tally.add(0, double{random.pair().u});
    tally.add(1 + unit % 3, double{random.pair().u});
  }

 private:
  std::chrono::microseconds duration_;
  std::string name_;
};

void expectSame(const TraceSums& a, const TraceSums& b) {
  EXPECT_EQ(a.done(), b.done());
  for (std::size_t i = 0; i < a.bins(); ++i) {
    EXPECT_TRUE(a.bin(i).sum.whole == b.bin(i).sum.whole) << i;
    EXPECT_TRUE(a.bin(i).squares.whole == b.bin(i).squares.whole) << i;
  }
}

// What pursue() has found by one process, or by rank 0 of a team whose rank r takes `durations[r]` for a unit.
TraceSums found(const TraceGoal& goal, const std::vector<std::chrono::microseconds>& durations) {
  TraceSums sums(4, 1);
  if (durations.empty()) {
    const Means job;
    TraceStore store;
    TraceSection& section = store.section("means", job);
    EXPECT_TRUE(pursue(goal, job, section, store, 5, 1));
    return section.sums;
  }
  asTeam(static_cast<int>(durations.size()), [&](TraceTeam& team) {
    const Means job(durations[static_cast<std::size_t>(team.rank())]);
    TraceStore store;
    TraceSection& section = store.section("means", job);
    EXPECT_TRUE(pursue(goal, job, section, store, 5, 1, {}, &team));
    if (team.rank() == 0) sums = section.sums;
  });
  return sums;
}

double errorOfMean(const TraceSums& sums) {
  const Estimate mean = sums.estimate(0);
  return mean.standard_error / mean.value;
}

}  // namespace

// Check that ranks of equal and of very different speed, more ranks than units, and no units at all give the same bits
// as one process.
TEST(TeamRun, FindsWhatOneProcessFinds) {
  using std::chrono::microseconds;
  const TraceGoal some = allOf(UnitRanges(3, 1000)), few = allOf(UnitRanges(0, 2)), none = allOf({});
  const TraceSums alone = found(some, {});
  expectSame(alone, found(some, {microseconds(0)}));
  expectSame(alone, found(some, {microseconds(0), microseconds(0)}));
  expectSame(alone, found(some, {microseconds(2000), microseconds(100), microseconds(1)}));
  expectSame(found(few, {}), found(few, {microseconds(0), microseconds(0), microseconds(0), microseconds(0)}));
  expectSame(found(none, {}), found(none, {microseconds(0), microseconds(0)}));
}

// Check that a goal that rests on what was found is reached by the same units.
TEST(TeamRun, ReachesAnErrorByTheSameUnits) {
  using std::chrono::microseconds;
  const TraceGoal goal = until(0.02, errorOfMean, 100000);
  const TraceSums alone = found(goal, {});
  EXPECT_GT(alone.units(), kLeastUnits);
  EXPECT_LE(errorOfMean(alone), 0.02);
  expectSame(alone, found(goal, {microseconds(1), microseconds(30)}));
}

// Check that a team one of whose ranks is told to stop, the first or another, ends on all, and that it goes on from
// there to the same bits.
TEST(TeamRun, StopsTogetherAndGoesOn) {
  const TraceGoal goal = allOf(UnitRanges(0, 400));
  const TraceSums alone = found(goal, {});
  for (const int stopping : {0, 1}) {
    TraceStore first;
    const Means job(std::chrono::microseconds(200));
    TraceSection& kept = first.section("means", job);
    int stops = 0;
    for (bool done = false; !done && stops < 100; stops += !done)
      asTeam(2, [&](TraceTeam& team) {
        TraceStore own;
        TraceStore& store = team.rank() == 0 ? first : own;
        int units = 0;
        const Progress progress = [&](double) { return !(team.rank() == stopping && ++units == 20); };
        const bool reached = pursue(goal, job, store.section("means", job), store, 5, 1, progress, &team);
        if (team.rank() == stopping) done = reached;
      });
    EXPECT_GT(stops, 2);
    expectSame(alone, kept.sums);
  }
}

// Check that a rank whose job is another one says so.
TEST(TeamRun, RefusesDifferentRuns) {
  asTeam(2, [](TraceTeam& team) {
    const Means job({}, team.rank() == 0 ? "means" : "others");
    try {
      requireSameAtAll(team, job.identity());
      EXPECT_EQ(team.rank(), 0);
    } catch (const InvalidInput& e) {
      EXPECT_STREQ(e.what(), "this rank: made with kind = others: must be means");
    }
  });
}
