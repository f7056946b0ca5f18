// Check that the viewer's background makes what is wished for and leaves alone what is looked at, and that a session
// computes anew what its edits need.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <glm/geometric.hpp>
#include <thread>
#include <tuple>

#include "apps/view/session.hpp"
#include "core/require.hpp"
#include "leaves/prospect.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/leaf_texture_file.hpp"
#include "render/stand_field.hpp"
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

// Check that a field that takes work comes as a preview first, then along lines; at once along lines where it takes
// none; and that another wish ends the field under way, but not its preview.
TEST(StandWorker, MakesThePreviewOfTheFieldFirst) {
  Scene scene = smallDocument().scene;
  StandWorker worker;
  const auto wish = [&](std::uint64_t revision) {
    StandWish asked = wishOf(scene, revision);
    asked.needs.field = true;
    worker.wish(asked);
  };
  std::optional<StandWorker::Result> result;
  const auto next = [&](std::uint64_t revision, FieldBy by) {
    ASSERT_TRUE(comes([&] { return (result = worker.take()).has_value(); }));
    EXPECT_EQ(result->made.revision, revision);
    EXPECT_EQ(result->made.needs.preview, by == FieldBy::cells);
    ASSERT_NE(result->geometry->field(), nullptr);
    EXPECT_EQ(result->geometry->field()->by(), by);
    ASSERT_EQ(result->levels.size(), 1u);
    EXPECT_NE(result->levels[0], nullptr);
  };
  wish(1);
  next(1, FieldBy::cells);
  const auto levels = result->levels[0];
  EXPECT_TRUE(worker.state().busy);
  worker.release();
  next(1, FieldBy::lines);
  StandField expected;
  expected.update(scene);
  const auto made = result->geometry->field()->sides(1), direct = expected.sides(1);
  EXPECT_TRUE(std::equal(made.begin(), made.end(), direct.begin(), direct.end()));
  EXPECT_EQ(result->levels[0], levels);
  worker.release();
  scene.suns[0].irradiance = glm::vec3(0.5f);
  wish(2);
  next(2, FieldBy::lines);
  worker.release();
  scene.suns[0].zenith = 0.5f;
  wish(3);
  next(3, FieldBy::cells);
  scene.suns[0].zenith = 0.6f;
  wish(4);
  worker.release();
  next(4, FieldBy::cells);
  worker.release();
  next(4, FieldBy::lines);
  worker.release();
  EXPECT_TRUE(comes([&] { return !worker.state().busy; }));
  EXPECT_EQ(worker.failure(), nullptr);
}

// Check that a wish that comes while the field is solved along lines ends it, and is no failure; nor is what is
// cancelled, and then the preview stays.
TEST(StandWorker, EndsTheFieldForAnotherWish) {
  Document document = smallDocument();
  document.scene.kinds[0].mesh = std::make_shared<const TreeMesh>(randomLeaves(20'000, 1.f, 0.02f));
  StandWish wish = wishOf(document.scene, 1);
  wish.needs.field = true;
  StandWorker worker;
  worker.wish(wish);
  std::optional<StandWorker::Result> result;
  ASSERT_TRUE(comes([&] { return (result = worker.take()).has_value(); }));
  worker.release();
  ASSERT_TRUE(comes([&] { return worker.state().what == "light field" && worker.state().done > 0.; }));
  wish.revision = 2;
  wish.scene.suns[0].zenith = 0.4f;
  worker.wish(wish);
  ASSERT_TRUE(comes([&] { return (result = worker.take()).has_value(); }));
  EXPECT_EQ(result->made.revision, 2u);
  EXPECT_TRUE(result->made.needs.preview);
  EXPECT_EQ(worker.failure(), nullptr);
  worker.release();
  ASSERT_TRUE(comes([&] { return worker.state().what == "light field" && worker.state().done > 0.; }));
  worker.cancel();
  ASSERT_TRUE(comes([&] { return !worker.state().busy; }));
  EXPECT_FALSE(worker.take());
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

// Check that reflectance and transmittance follow from how the leaves are told, in the scene's bands, beside the gloss;
// that undo brings both back; that a drag is one step; and that a kind that comes has the scene's bands.
TEST(Session, TellsLeavesByWhatTheyAre) {
  Document document = smallDocument();
  document.scene.bands = {{{620., 680.}, {550., 550.}, {850., 850.}}};
  Session session("small", [&] { return document; });
  ASSERT_TRUE(settle(session));
  recomputed(session);
  const auto kind = [&]() -> const TreeKind& { return session.document().scene.kinds[0]; };
  const BandOptics before = kind().leaf;
  BandOptics glossy = before;
  for (LeafOptics& band : glossy) band.gloss = 0.2f;
  const auto tell = [&](const LeafDescription& leaf, std::uint64_t gesture = 0) {
    session.edit(SetOptics{0, glossy, glm::vec3(0.3f), leaf}, gesture);
  };
  const LeafByContents beech = leafOfSpecies("beech");
  tell(beech);
  const BandOptics expected = bandOptics(prospect(beech.contents), session.document().scene.bands);
  for (std::size_t band = 0; band < kBands; ++band) {
    EXPECT_EQ(kind().leaf[band].reflectance, expected[band].reflectance);
    EXPECT_EQ(kind().leaf[band].transmittance, expected[band].transmittance);
    EXPECT_EQ(kind().leaf[band].gloss, 0.2f);
  }
  const BandOptics of_beech = kind().leaf;
  for (const double chlorophyll : {30., 20., 10.}) {
    LeafByContents pale = beech;
    pale.contents.chlorophyll = chlorophyll;
    tell(pale, 5);
  }
  EXPECT_GT(kind().leaf[1].reflectance, of_beech[1].reflectance);  // less of what absorbs green
  const BandOptics of_pale = kind().leaf;
  tell(LeafByTissue{.absorption = {1.5f, 0.4f, 0.f}, .scattering = glm::vec3(10.f), .thickness = 0.2});
  EXPECT_NEAR(kind().leaf[2].albedo(), 1.f, 1e-6f);  // nothing absorbs: to single precision and the solver's 1e-10
  session.undo();
  EXPECT_EQ(kind().leaf, of_pale);
  session.undo();
  EXPECT_EQ(kind().description, LeafDescription(beech));
  EXPECT_EQ(kind().leaf, of_beech);
  session.undo();
  EXPECT_EQ(kind().description, LeafDescription());
  EXPECT_EQ(kind().leaf, before);
  session.redo();
  EXPECT_EQ(kind().description, LeafDescription(beech));
  EXPECT_EQ(kind().leaf, of_beech);
  // What cannot be changes nothing.
  EXPECT_THROW(tell(LeafByContents{.species = "oak", .contents = {}}), InvalidInput);
  EXPECT_THROW(tell(LeafByContents{.species = {}, .contents = {.chlorophyll = -1.}}), InvalidInput);
  EXPECT_THROW(tell(LeafByTissue{.absorption = glm::vec3(-1.f)}), InvalidInput);
  EXPECT_EQ(kind().leaf, of_beech);
  TreeKind other = document.scene.kinds[0];
  other.description = beech;
  other.leaf = bandOptics(other.description, std::nullopt, glossy);
  EXPECT_NE(other.leaf, of_beech);
  session.edit(AddKind{other, {9.f, 0.f, 0.f}});
  EXPECT_EQ(session.document().scene.kinds[1].leaf, of_beech);
  ASSERT_TRUE(settle(session));
}

// 8 x 6 places, the right half of twice the colour and thickness of the left.
std::shared_ptr<const LeafTexture> halves(float left) {
  LeafTexture texture{.file = {}, .width = 8, .height = 6, .colour = {}, .alpha = {}};
  for (int i = 0; i < 48; ++i) {
    const float share = i % 8 < 4 ? left : 2.f * left;
    texture.colour.emplace_back(share);
    texture.alpha.push_back(share);
  }
  return std::make_shared<const LeafTexture>(std::move(texture));
}

// Check that maps and their mean follow what the leaves are told to be, at the last wish; that undo brings them back;
// and that nothing else is computed anew, nor they by what does not touch them.
TEST(Session, MakesMapsOfLeavesInTheBackground) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  recomputed(session);
  BandOptics glossy;
  for (LeafOptics& band : glossy) band.gloss = 0.2f;
  LeafByTissue tissue{.absorption = {1.5f, 0.4f, 5.f}, .scattering = glm::vec3(10.f), .thickness = 0.2};
  const LeafTextures textures{.upper = {.detail = halves(0.4f), .gloss = nullptr},
                              .underside = {.gloss = glm::vec3(0.f)}};
  const auto tell = [&](std::uint64_t gesture = 0) {
    session.edit(SetOptics{0, glossy, glm::vec3(0.3f), tissue, textures}, gesture);
  };
  const auto shown = [&]() -> const TreeKind& { return session.shownScene()->kinds[0]; };
  // Counts of the leaf maps, where nothing else may have been made.
  const auto maps_made = [&] {
    std::size_t maps = 0;
    for (const ProductCost& cost : session.recomputed())
      if (cost.name == "leaf maps") maps = cost.made;
    EXPECT_EQ(recomputed(session), maps);
    return maps;
  };
  tell();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(maps_made(), 1u);
  const auto as_told = [&] {
    const BandOptics even = bandOptics(LeafDescription(tissue), {}, glossy);
    const auto maps = leafMaps(tissue, even, textures);
    ASSERT_NE(shown().maps, nullptr);
    EXPECT_EQ(*shown().maps, *maps);
    EXPECT_EQ(shown().leaf, meanOptics(*maps, shown().shares->at));
    EXPECT_EQ(shown().told(), even);
  };
  as_told();
  const auto first = *shown().maps;
  const BandOptics first_mean = shown().leaf;
  const auto shares = shown().shares;
  for (const double thickness : {0.25, 0.3, 0.4}) {
    tissue.thickness = thickness;
    tell(5);
    session.advance();
  }
  ASSERT_TRUE(settle(session));
  EXPECT_GE(maps_made(), 1u);  // of wishes that came before the last, as many as there was time for
  as_told();
  EXPECT_NE(shown().leaf, first_mean);
  EXPECT_EQ(shown().shares, shares);
  // What does not tell of the leaves.
  const auto thick = shown().maps;
  session.edit(SetOptics{0, glossy, glm::vec3(0.5f), tissue});
  session.edit(SetSuns{{Sun{.zenith = 0.7f}}});
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(shown().maps, thick);
  recomputed(session);
  session.undo();
  session.undo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(shown().maps, thick);
  session.undo();
  ASSERT_TRUE(settle(session));
  ASSERT_NE(shown().maps, nullptr);
  EXPECT_EQ(*shown().maps, first);
  EXPECT_EQ(shown().leaf, first_mean);
  session.undo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(shown().maps, nullptr);
  session.redo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(*shown().maps, first);
}

// Check that images are read in the background, that one that cannot be changes nothing and is told in one line, and
// that the scene that is saved has them.
TEST(Session, ReadsImagesOfLeaves) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "sunfleck_view_session_test";
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "halves.exr").string(), other = (folder / "other.exr").string();
  writeLeafTexture(file, *halves(0.5f));
  LeafTexture one{.file = {}, .width = 1, .height = 1, .colour = {glm::vec3(2.f)}, .alpha = {}};
  writeLeafTexture(other, one);
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  session.setLeafImage(0, LeafImage::upper, file);
  ASSERT_TRUE(settle(session));
  const auto textures = [&] { return session.document().scene.kinds[0].textures; };
  ASSERT_NE(textures().upper.detail, nullptr);
  EXPECT_EQ(textures().upper.detail->colour, halves(0.5f)->colour);
  ASSERT_NE(session.shownScene()->kinds[0].maps, nullptr);
  const LeafTextures before = textures();
  for (const auto& [image, wrong, why] : {std::tuple{LeafImage::lower, (folder / "none.png").string(), "none.png"},
                                          std::tuple{LeafImage::lower, other, "must be of one size"},
                                          std::tuple{LeafImage::lower_gloss, other, "in [0, 1]"}}) {
    session.setLeafImage(0, image, wrong);
    ASSERT_TRUE(comes([&] {
      session.advance();
      if (const auto result = session.take()) session.release(*result);
      return session.messageIsError();
    }));
    EXPECT_NE(session.message().find(why), std::string::npos) << session.message();
    EXPECT_EQ(session.message().find('\n'), std::string::npos);
    EXPECT_EQ(textures(), before);
    session.say("");
  }
  session.setLeafImage(0, LeafImage::lower_gloss, file);
  session.undo();
  session.edit(SetLeafImage{0, LeafImage::upper, nullptr});
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(textures().upper.detail, nullptr);
  ASSERT_NE(textures().lower.gloss, nullptr);
  std::filesystem::remove_all(folder);
}

// A field is there when it has been solved along lines, and its preview counts with it as what a change made.
TEST(Session, TellsOfTheField) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.fieldText().empty());
  EXPECT_FALSE(session.drawable(Model::field));
  session.edit(SetModel{Model::field});
  std::vector<std::string> told;
  ASSERT_TRUE(comes([&] {
    session.advance();
    if (const auto result = session.take()) {
      session.release(*result);
      told.push_back(session.fieldText());
      EXPECT_TRUE(session.drawable(Model::field) && session.showsField());
      EXPECT_EQ(session.upToDate(), told.size() == 2);
    }
    return session.upToDate() && !session.work().busy;
  }));
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0], "preview on cells");
  EXPECT_TRUE(told[1].starts_with("field: ")) << told[1];
  EXPECT_NE(told[1].find(" iterations, error below 0."), std::string::npos) << told[1];
  for (const std::string name : {"field: solutions", "preview: solutions"}) {
    const auto cost = std::ranges::find(session.lastCosts(), name, &ProductCost::name);
    ASSERT_NE(cost, session.lastCosts().end()) << name;
    EXPECT_EQ(cost->made, 1u) << name;
  }
}

// 8 x 8 trees. A sun that turns makes one map, each tree's depths and G along it; a tree that moves makes no map, and
// changes those trees alone that stand so near that their leaves count in each other's cells.
TEST(Session, CountsWhatAStandComputesAnew) {
  Document document = smallDocument();
  document.scene.stand.trees.clear();
  for (int i = 0; i < 64; ++i)
    document.scene.stand.trees.push_back(
        {.position = {3.f * static_cast<float>(i % 8), 3.f * static_cast<float>(i / 8), 0.f}});
  Session session("grid", [&] { return document; });
  ASSERT_TRUE(settle(session));
  const auto anew = [&](const std::string& name) {
    for (const ProductCost& cost : session.lastCosts())
      if (cost.name == name) return cost.made + cost.adjusted;
    ADD_FAILURE() << name;
    return std::size_t{0};
  };
  const std::size_t all_depths = anew("depths");
  EXPECT_GT(session.preparedSeconds(), 0.);
  session.edit(SetSuns{{Sun{.zenith = 0.7f}}});
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(anew("light maps"), 1u);
  EXPECT_EQ(anew("G"), 64u);
  for (const char* name : {"cells", "sample maps", "depths"}) EXPECT_EQ(anew(name), 0u) << name;
  session.edit(MoveTree{27, {10.f, 9.3f, 0.f}});
  ASSERT_TRUE(settle(session));
  for (const char* name : {"cells", "sample maps", "light maps"}) EXPECT_EQ(anew(name), 0u) << name;
  EXPECT_GT(anew("depths"), 0u);
  EXPECT_LT(anew("depths"), all_depths);
  EXPECT_LT(anew("G"), 64u);
}

// The drawing thread must find the tables there: it asks drawable() first.
TEST(Session, MakesExactTablesInTheBackground) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  EXPECT_FALSE(session.drawable(Model::pp));
  session.edit(SetModel{Model::pp});
  EXPECT_FALSE(session.upToDate());
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.drawable(Model::pp));
  EXPECT_EQ(session.exactTables().made(), 1u);  // all bands have the same leaves
  session.undo();
  session.look.other = Model::pp;  // to be compared with
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.drawable(Model::pp));
  EXPECT_EQ(session.exactTables().made(), 1u);
  EXPECT_EQ(session.exactTables().of(LeafOptics{}).nodes.size(), exactPowerTable(LeafOptics{}).nodes.size());
  EXPECT_EQ(session.exactTables().made(), 1u);  // it was there
}

TEST(Session, TellsOfFilesWhenTheyAreWritten) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  std::promise<void> goes;
  session.write("slow.exr", [going = goes.get_future().share()] { going.wait(); });
  session.advance();
  EXPECT_TRUE(session.hasTasks());
  EXPECT_EQ(session.writes(), "writing slow.exr");
  goes.set_value();
  ASSERT_TRUE(comes([&] {
    session.advance();
    return !session.hasTasks();
  }));
  EXPECT_EQ(session.message(), "wrote slow.exr");
  session.write("bad.exr", [] { throw InvalidInput("bad.exr: cannot be written"); });
  ASSERT_TRUE(comes([&] {
    session.advance();
    return session.messageIsError();
  }));
  EXPECT_EQ(session.message(), "bad.exr: cannot be written");
}

TEST(Session, SetsANewKindBesideTheOthers) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  const Bounds before = bounds(session.document().scene);
  session.addKind("cherry", 1);
  ASSERT_TRUE(settle(session));
  const Scene& scene = session.document().scene;
  ASSERT_EQ(scene.stand.trees.size(), 3u);
  const Placement& tree = scene.stand.trees.back();
  EXPECT_FLOAT_EQ(bounds(*scene.kindOf(tree).mesh).low.x + tree.position.x, before.high.x);
}

// A stand without trees can be looked at, and planted again.
TEST(Session, DeletesTheLastTree) {
  Session session("small", [] { return smallDocument(); });
  ASSERT_TRUE(settle(session));
  session.edit(RemoveTrees{{0, 1}});
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.document().scene.stand.trees.empty());
  session.showWholeStand();
  session.addTree({1.f, 2.f}, 0);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(session.document().scene.stand.trees.size(), 1u);
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
