// Check that the viewer's background makes what is wished for and leaves alone what is looked at, and that a session
// computes anew what its edits need.
#include <gtest/gtest.h>

#include <chrono>
#include <glm/geometric.hpp>
#include <thread>

#include "apps/view/session.hpp"
#include "core/require.hpp"
#include "tests/random_leaves.hpp"

namespace sunfleck::view {
namespace {

constexpr GeometryEffort kCoarse{.light_resolution = 32, .sample_directions = 6, .sample_resolution = 16, .cells = 4};

Document smallDocument() {
  Document document;
  document.scene.name = document.scene.origin = "small";
  document.scene.kinds[0].name = "random";
  document.scene.kinds[0].mesh = std::make_shared<const TreeMesh>(randomLeaves(200, 1.f, 0.1f));
  document.scene.stand.trees = {{}, {.position = {3.f, 0.f, 0.f}}};
  document.effort = kCoarse;
  return document;
}

// Until something is there, or for a minute.
template <typename Ready>
bool comes(const Ready& ready) {
  for (int i = 0; i < 60'000; ++i) {
    if (ready()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

StandWish wishOf(const Scene& scene, std::uint64_t revision) {
  return {.scene = scene, .needs = {}, .effort = kCoarse, .revision = revision};
}

TEST(StandWorker, MakesWhatTheStandGeometryMakes) {
  const Scene scene = smallDocument().scene;
  StandWorker worker;
  worker.wish(wishOf(scene, 7));
  std::optional<StandWorker::Result> result;
  ASSERT_TRUE(comes([&] { return (result = worker.take()).has_value(); }));
  EXPECT_EQ(result->made.revision, 7u);
  StandGeometry expected(kCoarse);
  expected.update(scene);
  for (std::size_t tree = 0; tree < 2; ++tree) {
    const auto made = result->geometry->compensation(tree, 0), direct = expected.compensation(tree, 0);
    EXPECT_TRUE(std::equal(made.begin(), made.end(), direct.begin(), direct.end()));
  }
  EXPECT_FALSE(result->costs.empty());
}

TEST(StandWorker, LeavesAloneWhatIsLookedAt) {
  Scene scene = smallDocument().scene;
  StandWorker worker;
  worker.wish(wishOf(scene, 1));
  std::optional<StandWorker::Result> first, second;
  ASSERT_TRUE(comes([&] { return (first = worker.take()).has_value(); }));
  const auto revision = first->geometry->lightRevision(0, 0);
  scene.suns[0].zenith = 0.5f;
  worker.wish(wishOf(scene, 2));
  scene.suns[0].zenith = 0.9f;
  worker.wish(wishOf(scene, 3));  // in the place of the one before
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(worker.take());
  EXPECT_EQ(first->geometry->lightRevision(0, 0), revision);
  EXPECT_TRUE(worker.state().busy);
  worker.release();
  ASSERT_TRUE(comes([&] { return (second = worker.take()).has_value(); }));
  EXPECT_EQ(second->made.revision, 3u);
  EXPECT_NE(second->geometry->lightRevision(0, 0), revision);
  worker.release();
  EXPECT_TRUE(comes([&] { return !worker.state().busy; }));
}

TEST(StandWorker, TellsWhatWentWrongAndGoesOn) {
  Scene scene = smallDocument().scene;
  StandWorker worker;
  worker.run("failing", [] { throw InvalidInput("no such file"); });
  std::exception_ptr failure;
  ASSERT_TRUE(comes([&] { return (failure = worker.failure()) != nullptr; }));
  EXPECT_THROW(std::rethrow_exception(failure), InvalidInput);
  worker.wish(wishOf(scene, 1));
  EXPECT_TRUE(comes([&] { return worker.take().has_value(); }));
}

TEST(StandWorker, EndsWhatIsCancelled) {
  StandWorker worker;
  worker.wish(wishOf(smallDocument().scene, 1));
  worker.cancel();
  ASSERT_TRUE(comes([&] { return !worker.state().busy || worker.take(); }));
  EXPECT_EQ(worker.failure(), nullptr);
}

// Hands everything on until the session has what it needs, as the viewer does.
bool settle(Session& session) {
  return comes([&] {
    session.advance();
    if (const auto result = session.take()) session.release(*result);
    return session.upToDate() && !session.work().busy;
  });
}

std::size_t recomputed(Session& session) {
  std::size_t count = 0;
  for (const ProductCost& cost : session.recomputed()) count += cost.made + cost.adjusted;
  session.clearRecomputed();
  return count;
}

TEST(Session, ComputesAnewWhatAnEditNeedsAlone) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  EXPECT_GT(recomputed(session), 0u);
  session.camera.azimuth += 1.f;
  session.look.display.exposure = 1.f;
  session.edit(SetModel{Model::ss});
  session.edit(SetOptics{0, BandOptics{}, glm::vec3(0.5f)});
  session.edit(SaveCamera{{"here", session.camera}});
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(recomputed(session), 0u);
  session.edit(SetSuns{{Sun{.zenith = 0.7f}}});
  ASSERT_TRUE(settle(session));
  EXPECT_GT(recomputed(session), 0u);
  session.undo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(session.document().scene.sun().zenith, 0.f);
}

TEST(Session, PaintsNoTreeTooNear) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  constexpr float kSpacing = 2.5f, kRadius = 8.f;
  session.paint({1.f, 1.f}, kRadius, kSpacing, 0, 4);
  session.paint({4.f, 1.f}, kRadius, kSpacing, 0, 4);
  const std::vector<Placement>& trees = session.document().scene.stand.trees;
  ASSERT_GT(trees.size(), 6u);
  for (std::size_t i = 0; i < trees.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(glm::distance(trees[i].position, trees[j].position), kSpacing);
  session.undo();  // both strokes were one gesture
  EXPECT_EQ(session.document().scene.stand.trees.size(), 2u);
  EXPECT_THROW(session.paint({0.f, 0.f}, kRadius, kSpacing, 1), InvalidInput);
}

TEST(Session, SaysWhyItRefuses) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  session.attempt([&] { session.moveSelected({1.f, 0.f}); });
  EXPECT_TRUE(session.messageIsError());
  EXPECT_EQ(session.message(), "no tree is selected");
  session.select(1);
  session.moveSelected({1.f, 0.f});
  EXPECT_EQ(session.document().scene.stand.trees[1].position.x, 4.f);
  session.addKind("no such species", 1);
  ASSERT_TRUE(comes([&] {
    session.advance();
    if (const auto result = session.take()) session.release(*result);
    return session.messageIsError();
  }));
  EXPECT_EQ(session.document().scene.kinds.size(), 1u);
  EXPECT_TRUE(settle(session));
}

TEST(Session, PassesOnWhyASceneCannotBeRead) {
  Session session("none", []() -> Document { throw InvalidInput("none: must be a scene"); });
  EXPECT_THROW(comes([&] {
                 session.advance();
                 return session.loaded();
               }),
               InvalidInput);
}

TEST(Session, TurnsTheSunByDateAndPlace) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  // At the equinox the sun stands over the equator at noon, but for the equation of time: 7 minutes, 1.9 degrees.
  session.turnSunByDate(0, "2026-03-20", "12:07", 0., 0.);
  EXPECT_NEAR(session.document().scene.sun().zenith, 0.f, 0.02f);
  session.turnSunByDate(0, "2026-03-20", "00:00", 0., 0.);
  EXPECT_FALSE(session.document().scene.sun().up());
  EXPECT_THROW(session.turnSunByDate(0, "2026-02-30", "12:00", 0., 0.), InvalidInput);
  EXPECT_THROW(session.turnSunByDate(1, "2026-03-20", "12:00", 0., 0.), InvalidInput);
}

}  // namespace
}  // namespace sunfleck::view
