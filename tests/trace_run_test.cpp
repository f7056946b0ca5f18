// Check that sums of units do not depend on who adds them when, that runs go on where they were, and that files of
// other runs, damaged or foreign ones are refused.
#include "render/reference/trace_run.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/trace_goal.hpp"
#include "tests/leaf_shapes.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;
namespace fs = std::filesystem;

namespace {

// A scene with light of three bands.
struct Example {
  TreeMesh mesh = leafBox(60, 3);
  RayScene scene{mesh, {.period = glm::vec2(1.5f, 1.f)}, true};
  std::vector<TraceLight> bands{
      {.sun = sunlight(0.6f, 1.f), .leaf = {.reflectance = 0.1f, .transmittance = 0.05f}, .ground_albedo = 0.1f},
      {.sun = sunlight(0.6f, 1.f), .leaf = {.reflectance = 0.5f, .transmittance = 0.45f}, .ground_albedo = 0.3f},
      {.sun = sunlight(0.6f, 1.f), .leaf = {.reflectance = 0.3f, .transmittance = 0.f}, .ground_albedo = 0.f}};
  ForwardJob job{scene, bands, 64};
  PixelRays rays{.corner = {-0.5f, 0.5f, 2.f},
                 .right_step = {0.02f, 0.f, 0.f},
                 .down_step = {0.f, -0.02f, 0.f},
                 .width = 50,
                 .height = 40};
  CameraJob camera{scene, bands, rays, -1.f, 2};
  BrfJob brf{scene, bands, {{0.2, 0.}, {0.9, 2.}}, 16};
};

void expectSame(const TraceSums& a, const TraceSums& b) {
  ASSERT_EQ(a.bins(), b.bins());
  EXPECT_EQ(a.done(), b.done());
  for (std::size_t i = 0; i < a.bins(); ++i) {
    ASSERT_TRUE(a.bin(i).sum.whole == b.bin(i).sum.whole) << i;
    ASSERT_TRUE(a.bin(i).squares.whole == b.bin(i).squares.whole) << i;
  }
}

TraceSums whole(const TraceJob& job, std::uint64_t units) {
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.wanted = {0, units}, .threads = 1}, sums);
  return sums;
}

std::string bytesOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

// Check sets of units against sets of single numbers, over random ranges.
TEST(UnitRanges, AreTheSetsTheySay) {
  Random random(5, 0);
  for (int trial = 0; trial < 200; ++trial) {
    std::array<std::vector<bool>, 2> has{std::vector<bool>(64), std::vector<bool>(64)};
    std::array<UnitRanges, 2> ranges;
    for (std::size_t set = 0; set < 2; ++set)
      for (std::uint64_t unit = 0; unit < 64; ++unit)
        if (random.uniform() < 0.6f && !has[set][unit]) {
          has[set][unit] = true;
          ranges[set].add(unit);
        }
    const UnitRanges without = ranges[0].without(ranges[1]);
    std::uint64_t count = 0, thirds = 0;
    bool overlaps = false;
    for (std::uint64_t unit = 0; unit < 64; ++unit) {
      EXPECT_EQ(ranges[0].contains(unit), has[0][unit]);
      EXPECT_EQ(without.contains(unit), has[0][unit] && !has[1][unit]);
      count += has[0][unit];
      thirds += has[0][unit] && unit % 3 == 1;
      overlaps = overlaps || (has[0][unit] && has[1][unit]);
    }
    EXPECT_EQ(ranges[0].count(), count);
    EXPECT_EQ(ranges[0].countOf(1, 3), thirds);
    const auto [first, last] = ranges[0].overlap(ranges[1]);
    EXPECT_EQ(first < last, overlaps);
    for (std::uint64_t unit = first; unit < last; ++unit) EXPECT_TRUE(has[0][unit] && has[1][unit]);
    if (overlaps) {
      EXPECT_THROW(ranges[0].add(first), std::logic_error);
    }
  }
}

// Check mean and standard error of a few known units, and that sums of values whose squares cancel keep their digits.
TEST(TraceSums, GiveMeanAndStandardError) {
  TraceSums sums(2, 1);
  UnitTally tally(2);
  const std::array values{0.25, 0.5, 0.75, 1.0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    tally.add(0, values[i]);
    tally.add(1, 1e5 + values[i]);
    sums.add(1, i, tally);
    tally.clear();
  }
  const double error = std::sqrt((2. * 0.375 * 0.375 + 2. * 0.125 * 0.125) / 3. / 4.);
  EXPECT_DOUBLE_EQ(sums.estimate(0).value, 0.625);
  EXPECT_DOUBLE_EQ(sums.estimate(0).standard_error, error);
  EXPECT_NEAR(sums.estimate(1).standard_error, error, 1e-12);  // squares of 1e10 are kept to 2^-64
  EXPECT_THROW(sums.add(1, 2, tally), std::logic_error);
  tally.add(0, std::nan(""));
  EXPECT_THROW(sums.add(1, 9, tally), std::overflow_error);
}

// Check that any number of threads, any order of parts and any interruption give the same sums to the last bit, for
// all estimators.
TEST(R1_TraceRun, AnySplitGivesTheSameBits) {
  const Example example;
  for (const TraceJob* job : {static_cast<const TraceJob*>(&example.job), static_cast<const TraceJob*>(&example.camera),
                              static_cast<const TraceJob*>(&example.brf)}) {
    constexpr std::uint64_t kUnits = 40;
    const TraceSums expected = whole(*job, kUnits);
    TraceSums threaded(job->bins(), job->groups());
    runUnits(*job, {.wanted = {0, kUnits}, .threads = 5}, threaded);
    expectSame(threaded, expected);

    TraceSums parts(job->bins(), job->groups());
    for (const std::uint64_t part : {2u, 0u, 1u}) {
      TraceSums of_part(job->bins(), job->groups());
      runUnits(*job, {.wanted = partOf(kUnits, part, 3)}, of_part);
      parts.add(of_part);
    }
    expectSame(parts, expected);

    TraceSums interrupted(job->bins(), job->groups());
    int stops = 0;
    while (interrupted.units() < kUnits) {
      int calls = 0;
      runUnits(*job, {.wanted = {0, kUnits}, .threads = 2}, interrupted, [&](double) { return ++calls < 3; });
      ++stops;
    }
    EXPECT_GT(stops, 10);
    expectSame(interrupted, expected);
  }
}

// Check that the bands of one path have the means they have alone, within five of the errors of both, and that band for
// band no light is made or lost.
TEST(R1_TraceRun, BandsOnOnePathAgreeWithEachAlone) {
  const Example example;
  const std::vector<ForwardResult> together =
      traceForwardBands(example.scene, example.bands, {.paths = 40'000, .seed = 2});
  const std::vector<CameraResult> seen =
      traceCameraBands(example.scene, example.bands, example.rays, -1.f, {.paths = 40'000, .seed = 2});
  const auto agree = [](const Estimate& a, const Estimate& b) {
    EXPECT_LE(std::abs(a.value - b.value), 5. * std::hypot(a.standard_error, b.standard_error) + 1e-9);
  };
  for (std::size_t band = 0; band < example.bands.size(); ++band) {
    const ForwardResult& r = together[band];
    const ForwardResult alone = traceForward(example.scene, example.bands[band], {.paths = 40'000, .seed = 3});
    agree(r.reflected, alone.reflected);
    agree(r.absorbed_leaves, alone.absorbed_leaves);
    agree(r.arriving_ground, alone.arriving_ground);
    agree(r.arriving_ground_direct, alone.arriving_ground_direct);
    for (std::size_t leaf = 0; leaf < r.leaf_front.size(); ++leaf) {
      agree(r.leaf_front[leaf], alone.leaf_front[leaf]);
      agree(r.leaf_back[leaf], alone.leaf_back[leaf]);
    }
    EXPECT_NEAR(r.reflected.value + r.absorbed_leaves.value + r.absorbed_wood.value + r.absorbed_ground.value, 1.,
                1e-12);
    agree(seen[band].mean,
          traceCamera(example.scene, example.bands[band], example.rays, -1.f, {.paths = 40'000, .seed = 3}).mean);
  }
}

// Check that light sorted by how leaves scattered it tells, without a new run, what a run with other leaves finds.
TEST(R1_TraceRun, OrdersGiveOtherLeavesWithoutANewRun) {
  const Example example;
  const LeafOptics traced{.reflectance = 0.4f, .transmittance = 0.5f};
  const TraceLight light{.sun = sunlight(0.6f, 1.f), .leaf = traced, .ground_albedo = 0.2f};
  const ForwardResult r = traceForward(example.scene, light, {.paths = 200'000});
  EXPECT_NEAR(r.reflected_by_order.reweighted(traced, traced).value, r.reflected.value, 1e-9);  // of rounding
  for (const LeafOptics leaf :
       {LeafOptics{0.1f, 0.05f}, LeafOptics{0.3f, 0.f}, LeafOptics{0.f, 0.f}, LeafOptics{0.2f, 0.7f}}) {
    TraceLight other = light;
    other.leaf = leaf;
    const ForwardResult direct = traceForward(example.scene, other, {.paths = 200'000, .seed = 2});
    const auto agree = [](const Estimate& a, const Estimate& b) {
      EXPECT_LE(std::abs(a.value - b.value), 5. * std::hypot(a.standard_error, b.standard_error) + 1e-9)
          << a.value << " against " << b.value;
    };
    agree(r.reflected_by_order.reweighted(traced, leaf), direct.reflected);
    agree(r.arriving_ground_by_order.reweighted(traced, leaf), direct.arriving_ground);
  }
  EXPECT_THROW(r.reflected_by_order.reweighted({0.4f, 0.f}, {0.4f, 0.1f}), InvalidInput);
}

// Check that a run stopped again and again, each time going on from its file, comes to the file of a run never stopped,
// also where what it computes next rests on what it has found.
TEST(R1_TraceRun, GoesOnFromItsFileToTheSameBits) {
  const TemporaryFolder folder;
  const Example example;
  const auto goal = [&](const TraceJob& job) {
    if (&job == &example.camera)
      return TraceGoal{.next = [&](const TraceSums& sums,
                                   std::uint64_t seed) { return example.camera.unitsFor(0.2, 64, sums, seed); },
                       .name = "picture"};
    if (&job == &example.brf)
      return TraceGoal{
          .next = [&](const TraceSums& sums, std::uint64_t seed) { return example.brf.unitsFor(0.1, 200, sums, seed); },
          .name = "views"};
    return until(
        0.02, [&](const TraceSums& sums) { return example.job.relativeError(sums); }, 400);
  };
  for (const TraceJob* job : {static_cast<const TraceJob*>(&example.job), static_cast<const TraceJob*>(&example.camera),
                              static_cast<const TraceJob*>(&example.brf)}) {
    const fs::path once = folder / "once.trace", often = folder / "often.trace";
    {
      TraceStore store(once, 1e9, {{"scene", "example"}});
      EXPECT_TRUE(pursue(goal(*job), *job, store.section("run", *job), store, 1, 2));
    }
    int stops = 0;
    for (bool done = false; !done; ++stops) {
      TraceStore store(often, 0., {{"scene", "example"}});
      int calls = 0;
      done = pursue(goal(*job), *job, store.section("run", *job), store, 1, 1, [&](double) { return ++calls < 4; });
    }
    EXPECT_GT(stops, 5);
    EXPECT_EQ(bytesOf(once), bytesOf(often));
    fs::remove(once);
    fs::remove(often);
  }
}

// Check that parts and runs of other seeds are put together, and that what must not be is refused with a line that says
// why.
TEST(R1_TraceRun, PutsPartsTogether) {
  const TemporaryFolder folder;
  const Example example;
  const auto part = [&](const char* name, std::uint64_t seed, UnitRanges units, const TraceJob& job) {
    TraceStore store(folder / name, 1e9, {{"scene", "example"}});
    TraceSection& section = store.section("light", job);
    section.asked = 30;
    pursue(allOf(std::move(units)), job, section, store, seed, 1);
    return readTraceFile(folder / name);
  };
  TraceFile all = part("a.trace", 1, {0, 10}, example.job);
  addPart(all, part("b.trace", 1, {20, 30}, example.job), "b.trace");
  EXPECT_EQ(missingUnits(all.sections.front()).at(1), UnitRanges(10, 20));
  addPart(all, part("c.trace", 1, {10, 20}, example.job), "c.trace");
  EXPECT_TRUE(missingUnits(all.sections.front()).empty());
  expectSame(all.sections.front().sums, whole(example.job, 30));

  addPart(all, part("d.trace", 7, {0, 30}, example.job), "d.trace");
  EXPECT_EQ(all.sections.front().sums.units(), 60u);
  const auto refused = [&](const TraceFile& other) -> std::string {
    try {
      addPart(all, other, "x.trace");
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refused(part("e.trace", 1, {15, 40}, example.job)),
            "x.trace: units 15 to 29 of seed 1 of light: must not be in another file too");
  const ForwardJob larger(example.scene, example.bands, 128);
  EXPECT_EQ(refused(part("f.trace", 2, {0, 2}, larger)), "x.trace: made with paths per unit = 128: must be 64");
  TraceFile elsewhere = part("g.trace", 3, {0, 2}, example.job);
  elsewhere.run["scene"] = "another";
  elsewhere.sections.front().name = "picture";
  EXPECT_EQ(refused(elsewhere), "x.trace: made with scene = another: must be example");
  EXPECT_EQ(all.sections.front().sums.units(), 60u);
}

// Check that a goal is pursued whatever part of it is there already: holes in the middle are filled, and units of other
// seeds count without being taken for its own.
TEST(R1_TraceRun, FillsHolesTowardsAnError) {
  const Example example;
  TraceStore store;
  TraceSection& section = store.section("picture", example.camera);
  pursue(allOf({17, 30}), example.camera, section, store, 1, 1);
  pursue(allOf({0, 9}), example.camera, section, store, 2, 1);
  const TraceGoal goal{
      .next = [&](const TraceSums& sums, std::uint64_t seed) { return example.camera.unitsFor(0.2, 64, sums, seed); },
      .name = "picture"};
  EXPECT_TRUE(pursue(goal, example.camera, section, store, 1, 2));
  EXPECT_EQ(example.camera.unitsFor(0.2, 64, section.sums, 1).count(), 0u);
  EXPECT_FALSE(example.camera.reached(0.01, section.sums));
  EXPECT_TRUE(section.sums.done(1).contains(0));
  TraceSection& light = store.section("light", example.job);
  pursue(allOf({5, 90}), example.job, light, store, 1, 1);
  EXPECT_TRUE(pursue(until(
                         0.01, [&](const TraceSums& sums) { return example.job.relativeError(sums); }, 400),
                     example.job, light, store, 1, 2));
  EXPECT_TRUE(light.sums.units() == 400 || example.job.relativeError(light.sums) <= 0.01);
}

// Check that a file with any byte changed or cut off is refused, that a foreign one is, and that a file is one
// process's alone.
TEST(R1_TraceRun, RefusesWhatIsNotItsFile) {
  const TemporaryFolder folder;
  const Example example;
  const fs::path file = folder / "run.trace";
  {
    TraceStore store(file, 1e9, {{"scene", "example"}});
    pursue(allOf({0, 3}), example.job, store.section("light", example.job), store, 1, 1);
    EXPECT_THROW(TraceStore(file, 1e9, {}), InvalidInput);  // in use
  }
  const std::string good = bytesOf(file);
  const auto readable = [&](const std::string& bytes) {
    std::ofstream(folder / "other.trace", std::ios::binary) << bytes;
    try {
      readTraceFile(folder / "other.trace");
    } catch (const InvalidInput& e) {
      EXPECT_TRUE(std::string(e.what()).starts_with((folder / "other.trace").string())) << e.what();
      return false;
    }
    return true;
  };
  EXPECT_TRUE(readable(good));
  Random random(1, 0);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = good;
    bytes[random.bits() % bytes.size()] ^= static_cast<char>(1u << random.bits() % 8);
    EXPECT_FALSE(readable(bytes));
    EXPECT_FALSE(readable(good.substr(0, random.bits() % good.size())));
  }
  EXPECT_FALSE(readable(""));
  EXPECT_FALSE(readable("# Wavefront"));
  EXPECT_FALSE(readable(good + "x"));
  EXPECT_THROW(TraceStore(file, 1e9, {{"scene", "another"}}), InvalidInput);
  const ForwardJob other(example.scene, example.bands, 128);
  TraceStore store(file, 1e9, {{"scene", "example"}});
  EXPECT_THROW(store.section("light", other), InvalidInput);
}

// Check that a difference in a long list, of views say, is told by the place where the lists part.
TEST(TraceIdentity, TellsWhereLongOnesPart) {
  const std::string many(100'000, 'v');
  EXPECT_NO_THROW(requireSame("a.trace", {{"views", many}}, {{"views", many}}));
  for (const std::string& other : {many.substr(0, 60'000) + "other" + many, many + "other", many.substr(0, 5)}) {
    try {
      requireSame("a.trace", {{"views", other}}, {{"views", many}});
      ADD_FAILURE() << "took them for the same";
    } catch (const InvalidInput& e) {
      const std::string message = e.what();
      EXPECT_LT(message.size(), 300u);
      EXPECT_TRUE(message.starts_with("a.trace: made with views = ... vv")) << message;
      EXPECT_EQ(message.find("other") != std::string::npos, other.size() > 5);
    }
  }
}
