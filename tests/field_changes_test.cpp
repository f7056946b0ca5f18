// Check that the field on lines computes anew what a change asks for and nothing else, whatever has been changed
// before, and that it then is to the bit what it would be from scratch; and that neither threads nor the order of trees
// show.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "core/random.hpp"
#include "field/clumping.hpp"
#include "field/grid_field.hpp"
#include "field/leaf_field.hpp"
#include "plants/random_leaves.hpp"
#include "sky/sky_models.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

// Elements, exchange, recollision, direct light, solutions.
using Counts = std::array<std::size_t, 5>;

Counts madeBy(const LeafField& field) {
  Counts counts{};
  const std::vector<ProductCost> costs = field.costs();
  EXPECT_EQ(costs.size(), counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = costs[i].made;
  return counts;
}

std::shared_ptr<const TreeMesh> twig(std::uint64_t seed) {
  TreeMesh mesh = leafBox(30, seed);
  addPolygon(mesh, mesh.wood_triangles, rectangle({0, 0, 0}, {0.9f, 0, 0}, {0, 0.03f, 0.03f}));
  finish(mesh, "twig");
  return std::make_shared<const TreeMesh>(std::move(mesh));
}

std::shared_ptr<const SkyMap> skyOf(double radiance) {
  return std::make_shared<SkyMap>(uniformSky(glm::dvec3(radiance)));
}

struct World {
  std::array<std::shared_ptr<const TreeMesh>, 2> kinds{twig(1), twig(2)};
  Stand stand{.trees = {{.position = {0, 0, 0}}, {.position = {1.5f, 0.5f, 0.1f}, .rotation = 1.f, .kind = 1}},
              .period = glm::vec2(3.2f, 2.3f)};
  FieldLighting lighting{.suns = {{.along = sunlight(0.4f, 0.2f)}, {.along = sunlight(0.9f, 2.f)}},
                         .sky = skyOf(1.),
                         .kinds = {FieldKind{}, FieldKind{}},
                         .ground_albedo = glm::vec3(0.2f)};

  const FieldResult& solvedBy(LeafField& field) const {
    field.setStand(kinds, stand);
    return field.solve(lighting);
  }
};

struct Change {
  const char* name;
  std::function<void(World&, float)> make;  // by a number that is another each time, 0 .. 1
  Counts costs;                             // of members that are made anew
};

// Two suns and a sky: three sources.
const std::vector<Change> kChanges{
    {"nothing", [](World&, float) {}, {0, 0, 0, 0, 0}},
    {"a sun's colour",
     [](World& world, float x) {
       world.lighting.suns[1].irradiance = {x, 1.f, 0.5f * x};
     },
     {0, 0, 0, 0, 0}},
    {"leaves of a kind",
     [](World& world, float x) { world.lighting.kinds[1].leaf[2].reflectance = 0.4f * x; },
     {0, 0, 1, 0, 3}},
    {"wood of a kind", [](World& world, float x) { world.lighting.kinds[0].wood_reflectance.y = x; }, {0, 0, 1, 0, 3}},
    {"ground", [](World& world, float x) { world.lighting.ground_albedo.x = x; }, {0, 0, 1, 0, 3}},
    {"sky", [](World& world, float x) { world.lighting.sky = skyOf(double{x}); }, {0, 0, 0, 0, 1}},
    {"a sun's direction",
     [](World& world, float x) { world.lighting.suns[0].along = sunlight(0.2f + x, 1.f); },
     {0, 0, 0, 1, 1}},
    {"a tree's place", [](World& world, float x) { world.stand.trees[1].position.z = x; }, {1, 1, 1, 2, 3}},
    {"a tree's turn", [](World& world, float x) { world.stand.trees[0].rotation = x; }, {1, 1, 1, 2, 3}},
    {"period", [](World& world, float x) { world.stand.period->x = 3.f + x; }, {1, 1, 1, 2, 3}},
};

bool same(const std::vector<std::vector<LeafLight>>& a, const std::vector<std::vector<LeafLight>>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t tree = 0; tree < a.size(); ++tree)
    if (a[tree].size() != b[tree].size() ||
        std::memcmp(a[tree].data(), b[tree].data(), a[tree].size() * sizeof(LeafLight)) != 0)
      return false;
  return true;
}

// RMS of the differences of scattered light, relative to it.
double distance(const std::vector<std::vector<LeafLight>>& a, const std::vector<std::vector<LeafLight>>& b) {
  double squares = 0., all = 0.;
  for (std::size_t tree = 0; tree < a.size(); ++tree)
    for (std::size_t leaf = 0; leaf < a[tree].size(); ++leaf)
      for (std::size_t band = 0; band < kBands; ++band) {
        const SideIrradiance &x = a[tree][leaf].scattered[band], &y = b[tree][leaf].scattered[band];
        squares += std::pow(double{x.front} - double{y.front}, 2) + std::pow(double{x.back} - double{y.back}, 2);
        all += std::pow(double{x.front}, 2) + std::pow(double{x.back}, 2);
      }
  return std::sqrt(squares / all);
}

}  // namespace

// Check each kind of change after each other: a walk through all pairs.
TEST(F4_LeafField, ComputesWhatChangedInAnySequence) {
  World world;
  LeafField field;
  world.solvedBy(field);
  Counts expected{1, 1, 1, 2, 3};
  EXPECT_EQ(madeBy(field), expected);
  Random random(1, 0);
  const auto step = [&](const Change& change) {
    change.make(world, 0.05f + 0.9f * random.uniform());
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += change.costs[i];
    const FieldResult& found = world.solvedBy(field);
    EXPECT_EQ(madeBy(field), expected) << change.name;
    expected = madeBy(field);
    LeafField fresh;
    // What either iteration may leave.
    EXPECT_LT(distance(found.trees, world.solvedBy(fresh).trees), 2. * SolverEffort{}.error) << change.name;
  };
  for (const Change& first : kChanges)
    for (const Change& second : kChanges) {
      SCOPED_TRACE(std::string("after ") + first.name);
      step(first);
      step(second);
    }
}

// A sun more or less: the others stay.
TEST(F4_LeafField, KeepsSunsThatStay) {
  World world;
  LeafField field;
  world.lighting.sky = nullptr;
  world.solvedBy(field);
  EXPECT_EQ(madeBy(field), (Counts{1, 1, 1, 2, 2}));
  world.lighting.suns.push_back({.along = sunlight(1.2f, 4.f)});
  world.solvedBy(field);
  EXPECT_EQ(madeBy(field), (Counts{1, 1, 1, 3, 3}));
  world.lighting.suns.pop_back();
  world.solvedBy(field);
  EXPECT_EQ(madeBy(field), (Counts{1, 1, 1, 3, 3}));
  world.lighting.sky = skyOf(1.);
  world.solvedBy(field);
  EXPECT_EQ(madeBy(field), (Counts{1, 1, 1, 3, 4}));
}

// Check 1, 2 and 5 threads, whatever the machine has: not a bit differs.
TEST(F4_LeafField, IsTheSameForAnyNumberOfThreads) {
  const tbb::global_control five(tbb::global_control::max_allowed_parallelism, 5);
  const World world;
  std::vector<std::vector<std::vector<LeafLight>>> found;
  for (const int threads : {1, 2, 5})
    tbb::task_arena(threads).execute([&] {
      LeafField field;
      found.push_back(world.solvedBy(field).trees);
    });
  EXPECT_TRUE(same(found[0], found[1]));
  EXPECT_TRUE(same(found[0], found[2]));
}

namespace {

struct Crowns {
  TreeMesh mesh = randomCrown({.size = {2.f, 1.6f, 3.f}, .leaf_side = 0.12f, .leaves = 1500}, 1);
  FieldElements elements = fieldElements(mesh);

  // In the light of a sun that no leaf hides from another, of trees in this order.
  std::vector<float> solved(const std::vector<Placement>& places) const {
    std::vector<PlacedElements> trees;
    for (const Placement& place : places) trees.push_back({&mesh, &elements, place});
    GridField field(cellMedium(trees), std::vector<float>{0.7f});
    const float dark = 0.f;
    return field
        .solve({.optics = {{{.leaf = {0.5f, 0.4f}}}},
                .direct = std::vector<float>(trees.size() * elements.size() * 2, 0.5f),
                .entering = field.evenSky({&dark, 1}, {&dark, 1}, {})},
               {.error = 1e-4f})
        .irradiance;
  }
};
const std::vector<Placement> kPlaces{{}, {.position = {1.7f, 0.4f, 0.3f}, .rotation = 0.7f}, {.position = {0, 2, 0}}};

}  // namespace

TEST(F17_GridField, IsTheSameForOneTwoAndFiveThreads) {
  const tbb::global_control five(tbb::global_control::max_allowed_parallelism, 5);
  const Crowns crowns;
  std::vector<std::vector<float>> found;
  for (const int threads : {1, 2, 5})
    tbb::task_arena(threads).execute([&] { found.push_back(crowns.solved(kPlaces)); });
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

// Trees in another order: sums round otherwise, and iteration, which stops at 1e-4 of the mean, may by chance take a
// step more.
TEST(F17_GridField, DoesNotDependOnTheOrderOfTrees) {
  const Crowns crowns;
  const std::vector<float> found = crowns.solved(kPlaces), other = crowns.solved({kPlaces[2], kPlaces[0], kPlaces[1]});
  const std::size_t of_tree = 2 * crowns.elements.size();
  ASSERT_EQ(found.size(), 3 * of_tree);
  for (std::size_t tree = 0; tree < 3; ++tree)
    for (std::size_t i = 0; i < of_tree; ++i)
      EXPECT_NEAR(found[tree * of_tree + i], other[(tree + 1) % 3 * of_tree + i], 1e-3f);
}
