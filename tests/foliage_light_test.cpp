// Check that what light a stand's cells and its ground have of the sky and of lights is what leaves and wood let
// through.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "grid/foliage_stand.hpp"
#include "leaf_shapes.hpp"

namespace {

using namespace sunfleck;
constexpr Direction kDown{0.f, 0.f, -1.f};

// Horizontal square leaves of side 1 above each other at the given heights.
std::shared_ptr<TreeMesh> stack(std::initializer_list<float> heights) {
  auto mesh = std::make_shared<TreeMesh>();
  for (const float z : heights)
    shapes::addPolygon(*mesh, mesh->leaf_triangles,
                       shapes::rectangle({0.5f, 0.5f, z}, {0.5f, 0.f, 0.f}, {0.f, 0.5f, 0.f}));
  finish(*mesh, "stack");
  return mesh;
}

// (D13) Check a plate of wood across a stack of black leaves: cells below see nothing of the sky, those above all that
// the leaves leave, e^-1 below one. 1e-3: half a step of the depth.
TEST(D13_FoliageStand, WoodHidesTheSky) {
  const std::shared_ptr<TreeMesh> mesh = stack({0.f, 1.f});
  shapes::addPolygon(*mesh, mesh->wood_triangles,
                     shapes::rectangle({0.5f, 0.5f, 0.5f}, {0.5f, 0.f, 0.f}, {0.f, 0.5f, 0.f}));
  FoliageStand stand({.axes = {{0.f, 0.f, 1.f}}, .sample_resolution = 64, .cells = 4});
  stand.addPrototype(mesh);
  stand.setLeaf(0, {LeafOptics{0.f, 0.f}, {0.f, 0.f}, {0.f, 0.f}});
  stand.add(0, {0.f, 0.f, 0.f});
  const std::vector<std::size_t> first{0};
  stand.setSky(std::vector<glm::vec3>{glm::vec3(1.f), glm::vec3(0.f)});  // 1 from above
  stand.prepareSkyLight(first);
  stand.prepareGroundLight(first);
  ASSERT_EQ(stand.cells(0).active.size(), 64u);
  const auto inLayer = [](std::size_t layer) { return (layer * 4 + 1) * 4 + 1; };
  for (const std::size_t layer : {0u, 1u, 2u, 3u}) {
    EXPECT_NEAR(stand.skyLight(0)[inLayer(layer)].x, layer < 2 ? 0.f : 0.5f * std::exp(-1.f), 1e-3f) << layer;
    EXPECT_NEAR(stand.groundLight(0)[inLayer(layer)].x, layer < 2 ? 0.5f * std::exp(-1.f) : 0.f, 1e-3f) << layer;
  }
}

// (D12) Check the ground below a stack of three black leaves and beside it: under light and sky from overhead e^-3 of
// both arrives, and all of it. 1e-3: half a step of the depth. The sky is the mean of two directions, each of which
// stands for 2 pi.
TEST(D12_FoliageStand, LeavesShadeTheGround) {
  FoliageStand stand({.axes = {{0.f, 0.f, 1.f}}, .sample_resolution = 64, .light_resolution = 64, .cells = 4});
  stand.addPrototype(stack({0.2f, 0.4f, 1.2f}));
  stand.setLeaf(0, {LeafOptics{0.f, 0.f}, {0.f, 0.f}, {0.f, 0.f}});
  stand.add(0, {3.f, 2.f, 0.f});
  stand.setLights(std::span(&kDown, 1));
  stand.setSky(std::vector<glm::vec3>{{1.f, 2.f, 0.f}, glm::vec3(0.f)});
  stand.setGround({.low = {0.f, 0.f}, .height = 0.f, .cell_size = glm::vec2(0.2f), .size = {40, 30}});
  stand.prepareGround();
  const auto cell = [](float x, float y) {
    return static_cast<std::size_t>(y / 0.2f) * 40 + static_cast<std::size_t>(x / 0.2f);
  };
  const float leaves = std::exp(-3.f), whole = 2.f * std::numbers::pi_v<float>;
  EXPECT_NEAR(stand.groundShare(0)[cell(3.5f, 2.5f)].x, leaves, 1e-3f);
  EXPECT_EQ(stand.groundShare(0)[cell(1.5f, 2.5f)].x, 1.f);
  EXPECT_NEAR(stand.groundSky()[cell(3.5f, 2.5f)].y, 2.f * whole * leaves, 2e-3f);
  EXPECT_NEAR(stand.groundSky()[cell(3.5f, 0.5f)].y, 2.f * whole, 1e-4f);
  EXPECT_EQ(stand.groundSky()[cell(3.5f, 2.5f)].z, 0.f);
  stand.move(0, {1.f, 2.f, 0.f});
  stand.prepareGround();
  EXPECT_EQ(stand.groundShare(0)[cell(3.5f, 2.5f)].x, 1.f);
  EXPECT_NEAR(stand.groundShare(0)[cell(1.5f, 2.5f)].x, leaves, 1e-3f);
}

}  // namespace
