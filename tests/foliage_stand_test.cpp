#include "grid/foliage_stand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "grid/neighbours.hpp"
#include "leaf_shapes.hpp"
#include "plants/random_leaves.hpp"

namespace {

using namespace sunfleck;
using Mesh = std::shared_ptr<const TreeMesh>;
constexpr Direction kDown{0.f, 0.f, -1.f};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

FoliageEffort coarse(int cells = 6) {
  return {.axes = spreadAxes(5), .sample_resolution = 48, .light_resolution = 48, .cells = cells};
}

// Horizontal squares of side 1 above each other at the given heights.
Mesh stack(std::initializer_list<float> heights) {
  auto mesh = std::make_shared<TreeMesh>();
  for (const float z : heights)
    shapes::addPolygon(*mesh, mesh->leaf_triangles,
                       shapes::rectangle({0.5f, 0.5f, z}, {0.5f, 0.f, 0.f}, {0.f, 0.5f, 0.f}));
  finish(*mesh, "stack");
  return mesh;
}

Mesh crown(int leaves = 300, glm::vec3 size = {2.f, 2.f, 2.f}) {
  return std::make_shared<TreeMesh>(randomCrown({.size = size, .leaf_side = 0.2f, .leaves = leaves}, 3));
}

// What a stand did between two looks at it.
class Costs {
 public:
  explicit Costs(const FoliageStand& stand) : stand_(stand), last_(stand.costs()) {}
  // Of all products of which something was made, adjusted or skipped since the last call: "name made+adjusted".
  std::string since() {
    std::string text;
    const std::vector<ProductCost> now = stand_.costs();
    for (std::size_t i = 0; i < now.size(); ++i) {
      const std::size_t made = now[i].made - last_[i].made, adjusted = now[i].adjusted - last_[i].adjusted;
      if (made + adjusted == 0) continue;
      text += (text.empty() ? "" : ", ") + now[i].name + " " + std::to_string(made);
      if (adjusted > 0) text += "+" + std::to_string(adjusted);
    }
    last_ = now;
    return text;
  }

 private:
  const FoliageStand& stand_;
  std::vector<ProductCost> last_;
};

// 8 x 8 trees 3 m apart, with everything prepared.
struct Plot {
  FoliageStand stand{coarse()};
  std::vector<std::size_t> all;

  explicit Plot(std::size_t lights = 1) {
    stand.addPrototype(crown(60));
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) stand.add(0, {3.f * static_cast<float>(x), 3.f * static_cast<float>(y), 0.f});
    stand.setLights(std::vector<Direction>(lights, sunlight(0.7f, 0.3f)));
    stand.setSky(std::vector<glm::vec3>(10, glm::vec3(1.f)));
    all = stand.allInstances();
    prepare();
  }
  void prepare() {
    stand.prepareCompensation(all);
    stand.prepareSkyLight(all);
  }
};

// (D4) Check cell depths at known places: below a stack all leaves lie upward and none downward; a tree above adds its
// leaves to those above, one below to those below.
TEST(D4_FoliageStand, DepthsInAStack) {
  FoliageStand stand({.axes = {{0.f, 0.f, 1.f}}, .sample_resolution = 64, .cells = 4});
  stand.addPrototype(stack({0.5f, 0.6f, 0.f, 1.f}));
  stand.add(0, {5.f, 0.f, 3.f});
  const std::vector<std::size_t> first{0};
  const auto depth = [&](std::size_t layer, std::size_t direction) {
    stand.prepareSkyLight(first);
    return depthOf(stand.depths(0, direction)[(layer * 4 + 1) * 4 + 1]);
  };
  ASSERT_EQ(stand.cells(0).size, glm::ivec3(4));
  ASSERT_EQ(stand.cells(0).active.size(), 64u);
  EXPECT_EQ(depth(3, 0), 1.f);  // between 0.75 and 1: the square at 1 above, three below
  EXPECT_EQ(depth(3, 1), 3.f);
  EXPECT_EQ(depth(0, 0), 3.f);
  EXPECT_EQ(depth(0, 1), 1.f);
  stand.add(0, {5.f, 0.f, 13.f});
  EXPECT_EQ(depth(3, 0), 5.f);
  EXPECT_EQ(depth(3, 1), 3.f);
  stand.move(1, {5.f, 0.f, -13.f});
  EXPECT_EQ(depth(3, 0), 1.f);
  EXPECT_EQ(depth(3, 1), 7.f);
  stand.move(1, {15.f, 0.f, 13.f});
  EXPECT_EQ(depth(3, 0), 1.f);
}

// (D4) Check that a tree of a periodic stand has the depths of one among all copies that count, bit for bit: the period
// is a whole number of metres, so that no copy's place is rounded.
TEST(D4_FoliageStand, IsPeriodicAsAmongItsCopies) {
  const Mesh mesh = crown();
  FoliageStand periodic(coarse()), finite(coarse());
  for (FoliageStand* const stand : {&periodic, &finite}) {
    stand->addPrototype(mesh);
    stand->add(0, {0.f, 0.f, 0.f});
    stand->setLights(std::vector<Direction>{sunlight(1.2f, 0.4f)});
  }
  periodic.setPeriod(glm::vec2(3.f, 2.f));
  const glm::ivec2 around = periodsAround({.period = glm::vec2(3.f, 2.f)}, leafBounds(*mesh));
  for (int y = -around.y; y <= around.y; ++y)
    for (int x = -around.x; x <= around.x; ++x)
      if (x != 0 || y != 0) finite.add(0, {3.f * static_cast<float>(x), 2.f * static_cast<float>(y), 0.f});
  const std::vector<std::size_t> first{0};
  for (FoliageStand* const stand : {&periodic, &finite}) stand->prepareCompensation(first);
  for (std::size_t direction = 0; direction < 10; ++direction)
    for (std::size_t i = 0; i < periodic.depths(0, direction).size(); ++i)
      ASSERT_EQ(periodic.depths(0, direction)[i], finite.depths(0, direction)[i]);
  for (std::size_t i = 0; i < periodic.compensation(0, 0).size(); ++i)
    ASSERT_EQ(periodic.compensation(0, 0)[i], finite.compensation(0, 0)[i]);
}

// (D4) Check that a wider kind of tree, which brings more copies into a periodic stand, reaches the trees that were
// there, and is refused where the period is too short for it.
TEST(D4_FoliageStand, TakesAWiderKindIntoAPeriodicStand) {
  const std::vector<std::size_t> first{0};
  const auto depths = [&](bool at_once) {
    FoliageStand stand({.axes = {{1.f, 0.f, 0.f}, {0.6f, 0.8f, 0.f}}, .sample_resolution = 48, .cells = 6});
    stand.addPrototype(crown(100, {1.f, 1.f, 2.f}));
    stand.add(0, {0.f, 0.f, 0.f});
    stand.setPeriod(glm::vec2(1.f));
    if (!at_once) stand.prepareSkyLight(first);
    stand.addPrototype(crown(100, {5.f, 4.f, 1.f}));
    stand.add(1, {0.5f, 0.5f, 0.f});
    EXPECT_THROW(stand.addPrototype(crown(100, {9.f, 1.f, 1.f})), InvalidInput);
    EXPECT_THROW(stand.replacePrototype(0, crown(100, {9.f, 1.f, 1.f})), InvalidInput);
    stand.prepareSkyLight(first);
    std::vector<FixedDepth> all;
    for (std::size_t j = 0; j < 4; ++j) all.insert(all.end(), stand.depths(0, j).begin(), stand.depths(0, j).end());
    return all;
  };
  EXPECT_EQ(depths(true), depths(false));
}

// (D4) Check that a new kind of tree that came while only the sky's light was asked for stands in the sun's way too.
TEST(D4_FoliageStand, LightMeetsAKindThatCameUnlit) {
  FoliageStand stand(coarse());
  stand.addPrototype(stack({0.f, 1.f}));
  stand.add(0, {0.f, 0.f, 0.f});
  stand.setLights(std::span(&kDown, 1));
  const std::vector<std::size_t> first{0};
  stand.prepareCompensation(first);
  stand.addPrototype(stack({0.f, 0.5f, 1.f}));
  stand.add(1, {0.f, 0.f, 5.f});
  stand.prepareSkyLight(first);
  stand.prepareCompensation(first);
  const CellGrid& cells = stand.cells(0);
  EXPECT_EQ(depthOf(stand.lightDepths(0, 0)[cells.slot[cells.number({3, 3, 5})]]), 4.f);
}

// (D4) Check that a tree of a kind that had left the stand, and come and gone again since a third kind came, leaves
// nothing behind: its kind's pictures are older than the third kind.
TEST(D4_FoliageStand, ForgetsAKindThatCameAndWent) {
  const std::vector<std::size_t> first{0};
  FoliageStand stand(coarse());
  for (const auto& tree : {crown(100), crown(60, {1.f, 1.f, 1.f})}) stand.addPrototype(tree);
  for (int i = 0; i < 12; ++i) stand.add(0, {1.5f * static_cast<float>(i), 0.f, 0.f});
  const std::size_t left = stand.add(1, {2.f, 1.f, 0.f});
  stand.prepareSkyLight(stand.allInstances());
  stand.remove(left);
  stand.prepareSkyLight(stand.allInstances());
  stand.addPrototype(crown(80, {0.7f, 0.7f, 0.7f}));
  stand.add(2, {3.f, 1.f, 0.f});
  stand.prepareSkyLight(stand.allInstances());
  const std::vector<FixedDepth> before(stand.depths(0, 0).begin(), stand.depths(0, 0).end());
  stand.remove(stand.add(1, {1.f, 1.f, 0.f}));
  stand.prepareSkyLight(first);
  EXPECT_TRUE(std::ranges::equal(stand.depths(0, 0), before));
}

// Check that a map made before the cells is made anew with the tree.
TEST(D3_FoliageStand, LightMapFollowsItsTree) {
  FoliageStand stand(coarse());
  stand.addPrototype(stack({0.f}));
  stand.setLights(std::span(&kDown, 1));
  EXPECT_EQ(stand.lightMap(0, 0).crossings(5, 5).size(), 1u);
  stand.replacePrototype(0, stack({0.f, 1.f}));
  EXPECT_EQ(stand.lightMap(0, 0).crossings(5, 5).size(), 2u);
}

// (D4) (D5) (D10) Check what each change makes stale, by what is computed again. 64 trees, 5 axes.
TEST(D4_FoliageStand, MakesWhatIsStale) {
  Plot plot;
  Costs costs(plot.stand);
  const auto after = [&] {
    plot.prepare();
    return costs.since();
  };
  EXPECT_EQ(after(), "");
  plot.stand.setLeaf(0, {LeafOptics{}, {.reflectance = 0.1f, .transmittance = 0.1f}, {}});
  EXPECT_EQ(after(), "sky light 64");
  plot.stand.setSky(std::vector<glm::vec3>(10, glm::vec3(0.5f)));
  EXPECT_EQ(after(), "sky light 64");
  plot.stand.setLights(std::vector<Direction>{sunlight(0.2f, 1.f)});
  EXPECT_EQ(after(), "light maps 1, light depths, trees 1, light depths 64, G 64");
  plot.stand.setLights(std::vector<Direction>{sunlight(0.2f, 1.f), kDown});  // one light more
  EXPECT_EQ(after(), "light maps 1, light depths, trees 1, light depths 64, G 64");
  plot.stand.addPrototype(crown(50));  // none of them stands
  EXPECT_EQ(after(), "");
  plot.stand.replacePrototype(0, crown(70));
  EXPECT_EQ(after(),
            "cells 1, sample maps 5, light maps 2, light depths, trees 2, depths 320, light depths 128, G 128, "
            "sky light 64");
  plot.stand.setPeriod(glm::vec2(24.f));
  EXPECT_EQ(after(), "depths 320, light depths 128, G 128, sky light 64");

  // The same values, again.
  plot.stand.setPeriod(glm::vec2(24.f));
  plot.stand.setSky(std::vector<glm::vec3>(10, glm::vec3(0.5f)));
  plot.stand.setLights(std::vector<Direction>{sunlight(0.2f, 1.f), kDown});
  plot.stand.setLeaf(0, {LeafOptics{}, {.reflectance = 0.1f, .transmittance = 0.1f}, {}});
  plot.stand.move(5, {15.f, 0.f, 0.f});
  plot.stand.remove(plot.stand.add(0, {7.f, 0.f, 0.f}));
  plot.stand.prepareSkyLight({});
  costs.since();
  EXPECT_EQ(after(), "");
}

// (D4) Check that a moved tree's own depths are made and those of others adjusted, fewer than all: along an axis no
// more than two dozen of 64 trees of 2 m, 3 m apart, meet it where it stood or stands.
TEST(D4_FoliageStand, AdjustsWhatAMovedTreeMeets) {
  Plot plot;
  const std::vector<ProductCost> before = plot.stand.costs();
  plot.stand.move(27, {9.5f, 9.2f, 0.3f});
  plot.prepare();
  const std::vector<ProductCost> after = plot.stand.costs();
  const auto made = [&](std::size_t product) { return after[product].made - before[product].made; };
  for (std::size_t product = 0; product < after.size(); ++product) {
    const std::string& name = after[product].name;
    if (name == "depths") {
      EXPECT_EQ(made(product), 5u);
      EXPECT_GT(after[product].adjusted, before[product].adjusted);
      EXPECT_LT(after[product].adjusted - before[product].adjusted, 6u * 24u);
    } else if (name == "light depths") {
      EXPECT_EQ(made(product), 1u);
    } else if (name == "G" || name == "sky light") {
      EXPECT_GE(made(product), 1u);
      EXPECT_LT(made(product), 64u);
    } else {
      EXPECT_EQ(made(product), 0u) << name;
    }
  }
}

// (D4) (D5) (D10) Check that only the trees asked for are computed, and what they have is used again.
TEST(D4_FoliageStand, MakesWhatIsAskedFor) {
  FoliageStand stand(coarse());
  stand.addPrototype(crown(60));
  for (int i = 0; i < 20; ++i) stand.add(0, {2.f * static_cast<float>(i), 0.f, 0.f});
  stand.setLights(std::span(&kDown, 1));
  stand.setSky(std::vector<glm::vec3>(10, glm::vec3(1.f)));
  Costs costs(stand);
  const std::vector<std::size_t> two{3, 8}, three{3, 4, 8};
  stand.prepareSkyLight(two);
  EXPECT_EQ(costs.since(), "cells 1, sample maps 5, depths 10, sky light 2");
  stand.prepareCompensation(three);
  EXPECT_EQ(costs.since(), "light maps 1, light depths, trees 1, depths 5, light depths 3, G 3");
  stand.prepareSkyLight(three);
  EXPECT_EQ(costs.since(), "sky light 1");
  stand.remove(8);
  stand.prepareSkyLight(two);  // a removed tree is passed over
  for (const ProductCost& cost : stand.costs())
    if (cost.name == "depths") {
      EXPECT_EQ(cost.reused, 10u + 15u + 5u);
    }
}

// (D5) Check that cells that no light reaches are skipped, counted, and have no G: under a pile of 200 leaves.
TEST(D5_FoliageStand, SkipsUnlitCells) {
  auto pile = std::make_shared<TreeMesh>();
  for (int i = 0; i < 200; ++i)
    shapes::addPolygon(
        *pile, pile->leaf_triangles,
        shapes::rectangle({0.f, 0.f, 0.005f * static_cast<float>(i)}, {0.5f, 0.f, 0.f}, {0.f, 0.5f, 0.f}));
  finish(*pile, "pile");
  FoliageStand stand(coarse(4));
  stand.addPrototype(pile);
  stand.add(0, {0.f, 0.f, 0.f});
  stand.setLights(std::span(&kDown, 1));
  const std::vector<std::size_t> first{0};
  stand.prepareCompensation(first);
  std::size_t unlit = 0;
  for (std::size_t i = 0; i < stand.compensation(0, 0).size(); ++i)
    if (stand.lightDepths(0, 0)[i] == kDeepest) {
      ++unlit;
      EXPECT_EQ(stand.compensation(0, 0)[i], 0.f);
    }
  EXPECT_EQ(unlit, 16u);  // the lowest of four layers, below 150 leaves and more
  for (const ProductCost& cost : stand.costs())
    if (cost.name == "G") {
      EXPECT_EQ(cost.skipped, unlit);
    }
}

// (D5) Check the two ends of the G-factor: deep in a crown repeated without gaps it approaches 1; for a lone column it
// is lower, and always in [0, 1].
TEST(D5_FoliageStand, CompensationIsHighInAStandAndLowerForALoneTree) {
  const RandomLayer layer{.size = {1.f, 1.f}, .height = 1.f, .leaf_side = 0.05f, .leaf_area_index = 4.f};
  FoliageStand stand({.sample_resolution = 128, .light_resolution = 128, .cells = 8});
  stand.addPrototype(std::make_shared<TreeMesh>(randomLayer(layer, 5)));
  const std::vector<std::size_t> first{stand.add(0, {0.f, 0.f, 0.f})};
  stand.setLights(std::span(&kDown, 1));
  const auto mean = [&] {
    stand.prepareCompensation(first);
    double sum = 0.;
    for (const float value : stand.compensation(0, 0)) {
      EXPECT_GE(value, 0.f);
      EXPECT_LE(value, 1.f);
      sum += double{value};
    }
    return sum / static_cast<double>(stand.compensation(0, 0).size());
  };
  EXPECT_LT(mean(), 0.8);
  stand.setPeriod(layer.size);
  // Where chance makes a path meet fewer leaves than the slab's mean, G falls below 1, and nowhere does it rise above:
  // the loss is one-sided, .07 for this layer.
  EXPECT_GT(mean(), 0.9);
}

// Sky light of a crown's cells.
std::vector<glm::vec3> skyLightOf(const std::vector<glm::vec3>& sky, const std::array<LeafOptics, kBands>& leaf) {
  FoliageStand stand(coarse());
  stand.addPrototype(crown(2000));
  stand.setLeaf(0, leaf);
  const std::vector<std::size_t> first{stand.add(0, {0.f, 0.f, 0.f})};
  stand.setSky(sky);
  stand.prepareSkyLight(first);
  return {stand.skyLight(0).begin(), stand.skyLight(0).end()};
}

// (D10) Check the furnace: leaves that absorb nothing, under an even sky all round, are in its light everywhere,
// whatever shares they reflect and transmit. A slab's two faces give P+ + P- = 2 together at albedo 1; ten directions
// of depths up to 20 at 5e-6 each, rounding of their sum the rest.
TEST(D10_FoliageStand, WhiteLeavesAreInTheSkysLight) {
  const std::vector<glm::vec3> light =
      skyLightOf(std::vector<glm::vec3>(10, glm::vec3(1.f)), {LeafOptics{.reflectance = 0.5f, .transmittance = 0.5f},
                                                              {.reflectance = 1.f, .transmittance = 0.f},
                                                              {.reflectance = 0.25f, .transmittance = 0.75f}});
  for (const glm::vec3& of_cell : light)
    for (int band = 0; band < kBands; ++band) EXPECT_NEAR(of_cell[band], 1.f, 1e-5f);
}

// (D10) Check black leaves: the light is what of the sky shows between leaves, the mean of e^-depth. Error: 5e-6 for
// each direction.
TEST(D10_FoliageStand, BlackLeavesLetTheSkyThrough) {
  FoliageStand stand(coarse());
  stand.addPrototype(crown(2000));
  stand.setLeaf(0, {LeafOptics{0.f, 0.f}, {0.f, 0.f}, {0.f, 0.f}});
  const std::vector<std::size_t> first{stand.add(0, {0.f, 0.f, 0.f})};
  std::vector<glm::vec3> sky;
  for (int i = 0; i < 10; ++i) sky.emplace_back(static_cast<float>(i), 1.f, 0.f);
  stand.setSky(sky);
  stand.prepareSkyLight(first);
  for (std::size_t cell = 0; cell < stand.skyLight(0).size(); ++cell) {
    glm::vec3 expected(0.f);
    for (std::size_t j = 0; j < sky.size(); ++j)
      expected += 0.1f * sky[j] * std::exp(-depthOf(stand.depths(0, j)[cell]));
    for (int band = 0; band < kBands; ++band) EXPECT_NEAR(stand.skyLight(0)[cell][band], expected[band], 5e-5f);
  }
}

// (D10) Check that the light of two skies is the sum of the light of each. Error: rounding of sums of ten terms.
TEST(D10_FoliageStand, SkyLightIsLinear) {
  std::vector<glm::vec3> one(10, glm::vec3(0.f)), two(10, glm::vec3(0.2f)), both;
  one[3] = {3.f, 2.f, 1.f};
  two[8] = {0.f, 0.f, 5.f};
  for (std::size_t j = 0; j < one.size(); ++j) both.push_back(one[j] + 2.f * two[j]);
  const std::array<LeafOptics, kBands> leaf{LeafOptics{}, {0.05f, 0.1f}, {0.f, 0.9f}};
  const auto a = skyLightOf(one, leaf), b = skyLightOf(two, leaf), sum = skyLightOf(both, leaf);
  for (std::size_t cell = 0; cell < sum.size(); ++cell)
    for (int band = 0; band < kBands; ++band) EXPECT_NEAR(sum[cell][band], a[cell][band] + 2.f * b[cell][band], 2e-6f);
}

// Check that what a stand cannot work with is refused, and leaves it as it was.
TEST(FoliageStandInput, IsChecked) {
  FoliageStand stand(coarse());
  TreeMesh wood;
  shapes::addPolygon(wood, wood.wood_triangles, {{0.f, 0.f, 0.f}, {1.f, 0.f, 0.f}, {0.f, 1.f, 0.f}});
  EXPECT_THROW(stand.addPrototype(std::make_shared<TreeMesh>(wood)), InvalidInput);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float side : {0.f, -1.f, kNaN, infinity, 1e30f}) {
    EXPECT_THROW(stand.setPeriod(glm::vec2(side, 5.f)), InvalidInput) << side;
    EXPECT_THROW(stand.setPeriod(glm::vec2(5.f, side)), InvalidInput) << side;
  }
  stand.addPrototype(crown());
  stand.add(0, {0.f, 0.f, 0.f});
  EXPECT_THROW(stand.replacePrototype(0, std::make_shared<TreeMesh>(wood)), InvalidInput);
  EXPECT_THROW(stand.setPeriod(glm::vec2(0.2f, 2.f)), InvalidInput);
  for (const float x : {kNaN, infinity, -infinity, 1.1e6f, -1.1e6f}) {
    EXPECT_THROW(stand.add(0, {x, 0.f, 0.f}), InvalidInput) << x;
    EXPECT_THROW(stand.move(0, {0.f, x, 0.f}), InvalidInput) << x;
    EXPECT_THROW(stand.move(0, {0.f, 0.f, x}), InvalidInput) << x;
  }
  EXPECT_THROW(stand.setLights(std::vector<Direction>(FoliageStand::kMostLights + 1, kDown)), InvalidInput);
  for (const Direction& light : {Direction(0.f), Direction(kNaN), Direction(0.f, 0.f, 2.f), Direction(infinity)})
    EXPECT_THROW(stand.setLights(std::span(&light, 1)), InvalidInput);
  EXPECT_THROW(stand.setSky(std::vector<glm::vec3>(9, glm::vec3(1.f))), InvalidInput);
  for (const float radiance : {-1.f, kNaN, infinity})
    EXPECT_THROW(stand.setSky(std::vector<glm::vec3>(10, glm::vec3(radiance))), InvalidInput);
  EXPECT_THROW(stand.setLeaf(0, {LeafOptics{0.6f, 0.6f}, {}, {}}), InvalidInput);
  EXPECT_EQ(stand.instances(), 1u);
  stand.remove(0);
  stand.remove(0);
  EXPECT_TRUE(stand.allInstances().empty());
  stand.prepareCompensation(stand.allInstances());
  stand.prepareSkyLight(std::vector<std::size_t>{0});
  EXPECT_EQ(stand.instances(), 1u);
}

// Check that trees of any size and shape, and axes that run along their faces, give values in range: one leaf, a tree
// all in one upright plane, a thousandth of a metre and ten kilometres wide, at the ends of the world.
TEST(FoliageStandInput, MayBeExtreme) {
  const std::vector<Direction> axes{{1.f, 0.f, 0.f}, {0.f, 1.f, 0.f}, {0.f, 0.f, 1.f}, {0.6f, 0.f, 0.8f}};
  auto flat = std::make_shared<TreeMesh>();
  for (int i = 0; i < 5; ++i)
    shapes::addPolygon(
        *flat, flat->leaf_triangles,
        shapes::rectangle({0.f, 0.3f * static_cast<float>(i), 0.2f}, {0.f, 0.2f, 0.f}, {0.f, 0.f, 0.2f}));
  finish(*flat, "flat");
  const auto scaled = [](float size) {
    auto mesh = std::make_shared<TreeMesh>(*crown(100));
    for (glm::vec3& vertex : mesh->vertices) vertex *= size;
    finish(*mesh, "scaled");
    return mesh;
  };
  const std::vector<Mesh> meshes{stack({0.f}), flat, scaled(0.5e-3f), scaled(0.45e4f), crown()};
  const std::vector<glm::vec3> places{{0.f, 0.f, 0.f}, {1e6f, -1e6f, 1e6f}, {1e6f, 1e6f, 0.f}, {0.f, 0.f, -1e6f}};
  for (const int cells : {1, 3}) {
    FoliageStand stand({.axes = axes, .sample_resolution = 16, .light_resolution = 16, .cells = cells});
    for (const Mesh& mesh : meshes) {
      const std::size_t prototype = stand.addPrototype(mesh);
      for (const glm::vec3& place : places) stand.add(prototype, place);
    }
    stand.setLights(std::vector<Direction>{kDown, {0.f, 1.f, 0.f}, {-1.f, 0.f, 0.f}});
    stand.setSky(std::vector<glm::vec3>(8, glm::vec3(1.f)));
    for (int change = 0; change < 3; ++change) {
      stand.prepareCompensation(stand.allInstances());
      stand.prepareSkyLight(stand.allInstances());
      for (const std::size_t i : stand.allInstances()) {
        for (std::size_t light = 0; light < 3; ++light)
          for (const float g : stand.compensation(i, light)) EXPECT_TRUE(g >= 0.f && g <= 1.f) << g;
        for (const glm::vec3& light : stand.skyLight(i)) EXPECT_TRUE(light.x >= 0.f && light.x <= 1.00001f) << light.x;
      }
      stand.move(0, {1e6f, 1e6f, 1e6f});
      if (change == 1) {
        stand.remove(12);
        for (std::size_t i = 13; i < 16; ++i) stand.remove(i);  // the widest, for which the period would be too short
        stand.replacePrototype(3, crown());
        stand.setPeriod(glm::vec2(1.f, 1e6f));
      }
    }
    EXPECT_GT(stand.memoryBytes(), 1000u);
  }
}

}  // namespace
