// Check that StandGeometry follows a scene from one state to the next: it computes what the change makes stale and
// nothing else, tells what that was and which contents are new, and gives what it would give of the scene alone.
#include "render/stand_geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "plants/random_leaves.hpp"

namespace {

using namespace sunfleck;

constexpr GeometryEffort kCoarse{.light_resolution = 48, .sample_directions = 10, .sample_resolution = 48, .cells = 6};

std::shared_ptr<const TreeMesh> crown(int leaves, std::uint64_t seed = 3) {
  return std::make_shared<const TreeMesh>(
      randomCrown({.size = {2.f, 1.6f, 2.f}, .leaf_side = 0.2f, .leaves = leaves}, seed));
}

// 4 x 4 trees 3 m apart, of two kinds in turn, under a sun and an even sky, on ground that reflects.
Scene plot() {
  Scene scene;
  scene.kinds = {{.name = "a", .mesh = crown(60)}, {.name = "b", .mesh = crown(40, 5)}};
  scene.stand.trees.clear();
  for (std::uint32_t i = 0; i < 16; ++i)
    scene.stand.trees.push_back({.position = 3.f * glm::vec3(i % 4, i / 4, 0.f), .kind = i % 2});
  scene.suns[0].zenith = 0.7f;
  scene.sky = {.kind = SceneSky::Kind::uniform, .irradiance = glm::dvec3(0.2, 0.3, 0.5)};
  scene.ground_albedo = glm::vec3(0.2f);
  return scene;
}

// What the last update made: "name made+adjusted", of those products of which there was something.
std::string made(const StandGeometry& stand) {
  std::string text;
  for (const ProductCost& cost : stand.lastCosts()) {
    if (cost.made + cost.adjusted == 0) continue;
    text += (text.empty() ? "" : ", ") + cost.name + " " + std::to_string(cost.made);
    if (cost.adjusted > 0) text += "+" + std::to_string(cost.adjusted);
  }
  return text;
}

void expectSame(const StandGeometry& a, const StandGeometry& b, std::size_t trees) {
  ASSERT_EQ(a.lights().size(), b.lights().size());
  for (std::size_t tree = 0; tree < trees; ++tree) {
    for (std::size_t light = 0; light < a.lights().size(); ++light)
      EXPECT_TRUE(std::ranges::equal(a.compensation(tree, light), b.compensation(tree, light))) << tree;
    EXPECT_TRUE(std::ranges::equal(a.skyLight(tree), b.skyLight(tree))) << tree;
  }
  EXPECT_TRUE(std::ranges::equal(a.groundSky().irradiance, b.groundSky().irradiance));
}

// (D4) (D5) (D10) Check by what is computed that a camera that moves costs nothing, a sun that turns its own maps,
// depths and G, and what the sky and the leaves change the environment's light alone.
TEST(D4_StandGeometry, MakesWhatAChangeMakesStale) {
  StandGeometry stand(kCoarse);
  Scene scene = plot();
  const auto after = [&] {
    stand.update(scene);
    return made(stand);
  };
  after();
  EXPECT_EQ(after(), "");
  scene.camera = kOverview;
  EXPECT_EQ(after(), "");
  scene.suns[0].irradiance = glm::vec3(0.5f);
  EXPECT_EQ(after(), "");
  scene.suns[0].zenith = 0.5f;
  EXPECT_EQ(after(), "light maps 2, light depths, trees 2, light depths 16, G 16, light on the ground 1");
  scene.suns.push_back({.zenith = 1.f, .irradiance = glm::vec3(0.1f)});
  EXPECT_EQ(after(), "light maps 2, light depths, trees 2, light depths 16, G 16, light on the ground 1");
  scene.suns[1].zenith = 1.6f;  // it sets
  EXPECT_EQ(after(), "");
  scene.sky.irradiance = glm::dvec3(0.1);
  EXPECT_EQ(after(), "sky light 16, light on the ground 1");
  scene.kinds[1].leaf.fill({.reflectance = 0.1f, .transmittance = 0.1f});
  EXPECT_EQ(after(), "sky light 8, ground light 8, light on the ground 2");
  scene.ground_albedo = glm::vec3(0.5f);
  EXPECT_EQ(after(), "");
  scene.kinds[1].mesh = crown(50, 7);  // the other kind is seen from cells of another size
  EXPECT_EQ(after(),
            "cells 1, sample maps 10, light maps 1, light depths, trees 2, depths 80, light depths 16, G 16, sky light "
            "16, ground light 16, light on the ground 2");
}

// (D4) Check that a moved tree's own depths are made along 5 axes and the light, and those of others at most adjusted;
// that trees that stand as before are found whatever their places in the list; and that each state is to the bit that
// of a geometry made for it alone.
TEST(D4_StandGeometry, FollowsTreesThatMoveComeAndGo) {
  StandGeometry stand(kCoarse);
  Scene scene = plot();
  stand.update(scene);
  const auto afresh = [&] {
    StandGeometry other(kCoarse);
    other.update(scene);
    expectSame(stand, other, scene.stand.trees.size());
  };
  const auto count = [&](const std::string& name) {
    const std::vector<ProductCost> costs = stand.lastCosts();
    return std::ranges::find(costs, name, &ProductCost::name)->made;
  };
  scene.stand.trees[5].position += glm::vec3(0.4f, 0.3f, 0.f);
  stand.update(scene);
  EXPECT_EQ(count("depths"), 5u);
  EXPECT_EQ(count("light depths"), 1u);
  EXPECT_EQ(count("sample maps") + count("light maps") + count("cells"), 0u);
  EXPECT_LT(count("G"), 16u);
  afresh();

  const std::uint64_t far = stand.compensationRevision(15, 0);
  const std::vector<float> of_far(stand.compensation(15, 0).begin(), stand.compensation(15, 0).end());
  scene.stand.trees.erase(scene.stand.trees.begin());  // all others one place further to the front
  stand.update(scene);
  EXPECT_EQ(count("depths"), 0u);
  EXPECT_LT(count("G"), 15u);
  EXPECT_EQ(stand.compensationRevision(14, 0), far);
  EXPECT_TRUE(std::ranges::equal(stand.compensation(14, 0), of_far));
  afresh();

  scene.stand.trees.push_back({.position = {13.f, 13.f, 0.f}, .kind = 1});
  stand.update(scene);
  EXPECT_EQ(count("depths"), 5u);
  afresh();

  std::ranges::reverse(scene.stand.trees);
  stand.update(scene);
  EXPECT_EQ(made(stand), "");
  afresh();

  scene.stand.trees.clear();
  stand.update(scene);
  EXPECT_EQ(made(stand), "");
  scene = plot();
  stand.update(scene);
  afresh();
}

// Check that trees turned alike share maps, that these are maps of the turned tree, and that a tree turned a quarter
// under a sun turned as far has the G of one that is not, in the mean over its cells: .03, as five sample axes do not
// turn with it; they are .017 apart.
TEST(D3_StandGeometry, TurnsTrees) {
  Scene scene = plot();
  scene.stand.trees = {{.position = glm::vec3(0.f)},
                       {.position = {6.f, 0.f, 0.f}, .rotation = glm::radians(90.f)},
                       {.position = {12.f, 0.f, 0.f}, .rotation = glm::radians(90.f)},
                       {.position = {18.f, 0.f, 0.f}, .rotation = 0.3f, .kind = 1}};
  StandGeometry stand(kCoarse);
  stand.update(scene);
  ASSERT_EQ(stand.kinds().size(), 4u);
  EXPECT_FALSE(stand.kinds()[1].stands);
  EXPECT_EQ(stand.kindOf(1), 2u);
  EXPECT_EQ(stand.kindOf(2), 2u);
  EXPECT_EQ(stand.kinds()[stand.kindOf(3)].kind, 1u);
  const TreeMesh& turned = *stand.kinds()[2].mesh;
  EXPECT_NEAR(turned.vertices[7].x, -scene.kinds[0].mesh->vertices[7].y, 1e-6f);
  EXPECT_NEAR(turned.vertices[7].y, scene.kinds[0].mesh->vertices[7].x, 1e-6f);
  const DeepOpacityMap map(turned, stand.lights()[0].along, kCoarse.light_resolution);
  EXPECT_TRUE(std::ranges::equal(map.first(), stand.light(2, 0).first()));

  scene.stand.trees.resize(1);
  StandGeometry straight(kCoarse);
  straight.update(scene);
  scene.stand.trees[0].rotation = glm::radians(90.f);
  scene.suns[0].azimuth = glm::radians(90.f);
  stand.update(scene);
  const auto mean = [](const StandGeometry& of, std::size_t kind) {
    const std::span<const float> all = of.compensation(0, 0);
    return std::accumulate(all.begin(), all.end(), 0.f) / static_cast<float>(of.cells(kind).active.size());
  };
  EXPECT_NEAR(mean(straight, 0), mean(stand, 2), 0.03f);

  scene.stand.trees.clear();
  for (int i = 0; i <= static_cast<int>(kMostKinds); ++i)
    scene.stand.trees.push_back(
        {.position = {6.f * static_cast<float>(i), 0.f, 0.f}, .rotation = 0.01f * static_cast<float>(i)});
  try {
    stand.update(scene);
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_NE(std::string(e.what()).find("each rotation_deg counted = 65: must be at most 64"), std::string::npos)
        << e.what();
  }
}

// (D3) Check lights: those that shine, in the order of the suns, each with its map; none by night.
TEST(D3_StandGeometry, HasAMapOfEachSunThatShines) {
  Scene scene = plot();
  scene.suns = {{.zenith = 2.f},
                {.zenith = 0.3f, .irradiance = {1.f, 2.f, 3.f}},
                {.irradiance = glm::vec3(0.f)},
                {.zenith = 1.f}};
  StandGeometry stand(kCoarse);
  stand.update(scene);
  ASSERT_EQ(stand.lights().size(), 2u);
  EXPECT_EQ(stand.lights()[0].sun, 1u);
  EXPECT_EQ(stand.lights()[0].irradiance, glm::vec3(1.f, 2.f, 3.f));
  EXPECT_EQ(stand.lights()[1].sun, 3u);
  for (std::size_t light = 0; light < 2; ++light) {
    EXPECT_EQ(stand.light(1, light).along(), stand.lights()[light].along);
    EXPECT_EQ(stand.compensation(3, light).size(), stand.cells(1).count());
  }
  scene.suns = {{.zenith = 2.f}};
  scene.sky.kind = SceneSky::Kind::none;
  stand.update(scene);
  EXPECT_TRUE(stand.lights().empty());
  EXPECT_EQ(stand.sky(), nullptr);
  EXPECT_TRUE(stand.skyLight(0).empty());
}

// Check that each content that is another has another revision, and what is kept keeps its.
TEST(StandGeometry, NumbersItsContents) {
  Scene scene = plot();
  StandGeometry stand(kCoarse);
  stand.update(scene);
  const auto revisions = [&] {
    return std::vector<std::uint64_t>{stand.lightRevision(0, 0), stand.compensationRevision(0, 0),
                                      stand.skyLightRevision(0), stand.groundSky().revision};
  };
  std::vector<std::uint64_t> before = revisions();
  EXPECT_EQ(std::ranges::count(before, 0u), 0);
  const auto differ = [&] {
    stand.update(scene);
    std::string which;
    const std::vector<std::uint64_t> now = revisions();
    for (std::size_t i = 0; i < now.size(); ++i) which += now[i] == before[i] ? '.' : '*';
    before = now;
    return which;
  };
  EXPECT_EQ(differ(), "....");
  scene.suns[0].zenith = 0.2f;
  EXPECT_EQ(differ(), "***.");  // the ground sends back another light
  scene.ground_albedo = glm::vec3(0.3f);
  EXPECT_EQ(differ(), "..*.");
  scene.sky.irradiance = glm::dvec3(0.4);
  EXPECT_EQ(differ(), "..**");
  scene.kinds[0].mesh = crown(70);
  EXPECT_EQ(differ(), "****");
}

}  // namespace
