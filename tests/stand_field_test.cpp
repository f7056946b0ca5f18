// Check that the light field of a stand is told as pictures and tables read it.
#include "render/stand_field.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "core/require.hpp"
#include "plants/random_leaves.hpp"
#include "render/stand_geometry.hpp"

namespace {

using namespace sunfleck;

// 60 leaves about a post of wood, which reaches far below them.
std::shared_ptr<const TreeMesh> tree() {
  RandomCrown crown;
  crown.leaves = 60;
  crown.leaf_side = 0.3f;
  TreeMesh mesh = randomCrown(crown, 5);
  const Bounds leaves = leafBounds(mesh);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const float z : {leaves.low.z - 4.f, leaves.low.z - 3.9f, leaves.centre().z, leaves.centre().z + 0.1f})
    for (const float x : {-0.02f, 0.02f}) mesh.vertices.emplace_back(leaves.centre().x + x, leaves.centre().y, z);
  for (const std::uint32_t v : {first, first + 4}) mesh.wood_triangles.push_back({v, v + 1, v + 2});
  finish(mesh, "test");
  return std::make_shared<const TreeMesh>(std::move(mesh));
}

Scene scene() {
  Scene scene{.name = "test"};
  scene.kinds[0].mesh = tree();
  scene.kinds[0].leaf = {LeafOptics{0.4f, 0.4f}, {0.3f, 0.1f}, {0.f, 0.f}};
  scene.stand.trees = {{}, {.position = {4.f, 0.f, 0.f}, .rotation = 1.f}};
  return scene;
}

// (F26) Check that a leaf's place has its scattered light, and that wood has the mean of the leaves around it: of those
// of its cell, and of all where there are none.
TEST(F26_StandField, TellsOfLeavesAndOfTheWoodAmongThem) {
  const Scene given = scene();
  StandField field;
  field.update(given);
  const TreeMesh& mesh = *given.kinds[0].mesh;
  const auto places = field.places(0);
  ASSERT_EQ(places.size(), mesh.leaf_triangles.size() + 2);
  for (std::size_t t = 0; t < mesh.leaf_triangles.size(); ++t) EXPECT_EQ(places[t], mesh.leaf_of_triangle[t]);
  for (std::size_t tree = 0; tree < 2; ++tree) {
    const auto sides = field.sides(tree);
    glm::vec3 mean(0.f), least(1e9f), most(0.f);
    for (std::uint32_t leaf = 0; leaf < mesh.leaf_count; ++leaf) {
      for (int band = 0; band < kBands; ++band) {
        const SideIrradiance expected = field.result().trees[tree][leaf].scattered[static_cast<std::size_t>(band)];
        EXPECT_EQ(sides[2 * leaf][band], expected.front);
        EXPECT_EQ(sides[2 * leaf + 1][band], expected.back);
      }
      const glm::vec3 of_leaf = 0.5f * (sides[2 * leaf] + sides[2 * leaf + 1]);
      mean += of_leaf / static_cast<float>(mesh.leaf_count);
      least = glm::min(least, of_leaf);
      most = glm::max(most, of_leaf);
    }
    const std::uint32_t far = places[places.size() - 2], within = places.back();
    EXPECT_NEAR(sides[2 * far].x, mean.x, 1e-5f * mean.x);  // 60 roundings
    EXPECT_EQ(sides[2 * far], sides[2 * far + 1]);
    EXPECT_GE(sides[2 * within].x, least.x);
    EXPECT_LE(sides[2 * within].x, most.x);
    EXPECT_GT(mean.x, 0.01f);
    EXPECT_EQ(mean.z, 0.f);  // black leaves scatter nothing
  }
}

// Check that a sun of another colour changes the light and computes nothing anew but sums: none of the products that
// follow from the trees, from where the sun stands or from optics.
TEST(StandField, TakesOtherColoursOfTheSunForNothing) {
  Scene given = scene();
  StandGeometry stand({.light_resolution = 32, .sample_resolution = 32, .cells = 4});
  stand.update(given, needsOf(Model::ss));
  EXPECT_EQ(stand.field(), nullptr);
  stand.update(given, needsOf(Model::field));
  ASSERT_NE(stand.field(), nullptr);
  const std::uint64_t revision = stand.field()->revision();
  const float before = stand.field()->sides(0)[0].x;
  given.suns[0].irradiance = {0.5f, 1.f, 1.f};
  stand.update(given, needsOf(Model::field));
  EXPECT_NE(stand.field()->revision(), revision);
  EXPECT_NEAR(stand.field()->sides(0)[0].x, 0.5f * before, 1e-6f * before);  // a rounding
  std::size_t of_field = 0;
  for (const ProductCost& cost : stand.lastCosts()) {
    EXPECT_EQ(cost.made, 0u) << cost.name;
    of_field += cost.name.starts_with("field: ");
  }
  EXPECT_GE(of_field, 4u);
  stand.update(given, needsOf(Model::ss));
  EXPECT_EQ(stand.field(), nullptr);
}

// (F27) Check the mean over the trees of each kind on numbers worked out by hand.
TEST(F27_LeafIrradiance, IsTheMeanOfTheTreesOfAKind) {
  Scene given{.name = "test"};
  TreeMesh one;
  one.vertices = {{0.f, 0.f, 0.f}, {1.f, 0.f, 0.f}, {0.f, 1.f, 0.f}};
  one.leaf_triangles = {{0, 1, 2}};
  finish(one, "test");
  given.kinds.resize(2);
  for (TreeKind& kind : given.kinds) kind.mesh = std::make_shared<const TreeMesh>(one);
  given.stand.trees = {{.kind = 1}, {.kind = 0}, {.kind = 1}};
  FieldResult field;
  for (const float light : {1.f, 10.f, 3.f}) {
    LeafLight leaf{};
    leaf.direct[1] = {light, 0.f};
    leaf.scattered[1] = {0.5f, 0.25f};
    leaf.scattered[0] = {9.f, 9.f};
    field.trees.push_back({leaf});
  }
  EXPECT_EQ(leafIrradiance(field, given, 1), (std::vector<float>{10.75f, 2.75f}));
}

// Check that stands are refused that have more leaves than the field can tell of one by one, before anything is
// computed.
TEST(StandField, RefusesForests) {
  Scene forest = scene();
  forest.stand.trees.assign(700'000, Placement{});
  EXPECT_FALSE(fieldFits(forest));
  EXPECT_THROW(StandField().update(forest), InvalidInput);
}

// Check that the field of a stand of very many trees, too, tells how far it is, ends when it is told, and comes when it
// is asked again: 2.1 million leaves, of which a picture shows a tree.
TEST(StandField, EndsWhenItIsToldInForests) {
  Scene forest = scene();
  forest.kinds[0].mesh = std::make_shared<const TreeMesh>(randomCrown({.leaves = 3'000}, 1));
  forest.stand.trees.clear();
  for (int i = 0; i < 700; ++i)
    forest.stand.trees.push_back(
        {.position = {3.f * static_cast<float>(i % 28), 3.f * static_cast<float>(i / 28), 0.f}});
  const std::array<std::size_t, 1> shown{350};
  StandField field;
  double last = 0.;
  for (const double end : {0.3, 0.9}) {
    const auto until = [&](double done) { return (last = done) < end; };
    EXPECT_THROW(field.update(forest, FieldBy::lines, until, {}, shown), std::runtime_error);
    EXPECT_GE(last, end);
    EXPECT_LT(last, 1.);
  }
  field.update(forest, FieldBy::lines, {}, {}, shown);
  EXPECT_EQ(field.sides(350).size(), 6'000u);
  EXPECT_TRUE(field.sides(0).empty());
}

}  // namespace
