#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "grid/deep_opacity_map.hpp"
#include "grid/leaf_depth.hpp"
#include "grid/neighbours.hpp"
#include "plants/random_leaves.hpp"

namespace {

using namespace sunfleck;
constexpr Direction kDown{0.f, 0.f, -1.f};

// Horizontal squares of side 1 above each other at the given heights.
TreeMesh stack(std::initializer_list<float> heights) {
  TreeMesh mesh;
  for (const float z : heights) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
      mesh.vertices.emplace_back(corner, z);
    mesh.leaf_triangles.push_back({first, first + 1, first + 2});
    mesh.leaf_triangles.push_back({first, first + 2, first + 3});
  }
  finish(mesh, "stack");
  return mesh;
}

// (D3) Check that every pixel over a stack of squares counts each square once, the pixels on the diagonal that two
// triangles share included, in order of depth.
TEST(D3_DeepOpacityMap, CountsEachLeafOnce) {
  const TreeMesh mesh = stack({3.f, 1.f, 2.f});
  for (int resolution : {1, 2, 16, 37}) {
    const DeepOpacityMap map(mesh, kDown, resolution);
    ASSERT_EQ(map.size(), glm::ivec2(resolution));
    for (int y = 0; y < resolution; ++y)
      for (int x = 0; x < resolution; ++x) {
        const auto line = map.crossings(x, y);
        ASSERT_EQ(line.size(), 3u) << x << " " << y;
        EXPECT_EQ(line[0].leaf, 0u);
        EXPECT_EQ(line[1].leaf, 2u);
        EXPECT_EQ(line[2].leaf, 1u);
        EXPECT_NEAR(line[1].depth - line[0].depth, 1.f, 1e-6f);
      }
  }
}

// (D3) Check the counts on either side of a point, and that a leaf can leave itself out.
TEST(D3_DeepOpacityMap, CountsBeforeAndBeyondAPoint) {
  const DeepOpacityMap map(stack({3.f, 1.f, 2.f}), kDown, 8);
  const auto between = map.counts({0.4f, 0.4f, 1.5f});
  EXPECT_EQ(between.before, 2);
  EXPECT_EQ(between.beyond, 1);
  const auto on_middle = map.counts({0.4f, 0.4f, 2.f}, 2u);
  EXPECT_EQ(on_middle.before, 1);
  EXPECT_EQ(on_middle.beyond, 1);
  EXPECT_EQ(map.counts({5.f, 0.4f, 0.f}).before, 0);
}

// (D3) Check that the map's crossings times the pixel's area are the leaves' projected area, for random leaves along
// random directions. Each leaf's pixel count is off by at most its boundary's pixels, whose mean is 0 and whose
// standard deviation is about half a pixel per side; 9,000 leaves make the sum's relative error about 1e-3 at this
// resolution.
TEST(D3_DeepOpacityMap, KeepsTheProjectedArea) {
  const TreeMesh mesh = randomCrown({}, 3);
  for (const Direction& along : spreadAxes(5)) {
    const DeepOpacityMap map(mesh, along, 512);
    const auto projections = leafProjections(mesh, along);
    const auto areas = leafAreas(mesh);
    double expected = 0.;
    for (std::size_t leaf = 0; leaf < areas.size(); ++leaf) expected += areas[leaf] * double{projections[leaf]};
    const double pixel = double{map.pixelSize()} * double{map.pixelSize()};
    EXPECT_NEAR(static_cast<double>(map.crossings().size()) * pixel, expected, 5e-3 * expected);
  }
}

// (D3) (D6) Check that one thread and four make the same map and the same depths, bit by bit.
TEST(D3_DeepOpacityMap, IsTheSameForAnyNumberOfThreads) {
  const TreeMesh mesh = randomCrown({}, 3);
  const Stand stand{.trees = {{}, {.position = {1.5f, 0.2f, 0.f}}, {.position = {-0.7f, 1.1f, 0.3f}}}};
  const Direction slanted = glm::normalize(glm::vec3(0.3f, -0.5f, -0.8f));
  const auto made = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    DeepOpacityMap map(mesh, slanted, 256);
    LeafDepths depths = leafDepths(mesh, map, stand).front();
    return std::pair(std::move(map), std::move(depths));
  };
  const auto [map, depths] = made(1);
  const auto [same_map, same_depths] = made(4);
  EXPECT_TRUE(std::ranges::equal(map.first(), same_map.first()));
  EXPECT_TRUE(std::ranges::equal(map.crossings(), same_map.crossings(), [](const Crossing& a, const Crossing& b) {
    return a.depth == b.depth && a.leaf == b.leaf;
  }));
  EXPECT_EQ(depths.depth, same_depths.depth);
  EXPECT_EQ(depths.thickness, same_depths.thickness);
}

// (D3) Check that inSpace and inMap undo each other. Error: float rounding of metres.
TEST(D3_DeepOpacityMap, MapsPointsBothWays) {
  const DeepOpacityMap map(stack({1.f, 0.f}), glm::normalize(glm::vec3(0.3f, -0.5f, -0.8f)), 20);
  const glm::vec3 point = map.inSpace(7, 11, 0.25f);
  const glm::vec3 at = map.inMap(point);
  EXPECT_NEAR((at.x - map.corner().x) / map.pixelSize(), 7.5f, 1e-4f);
  EXPECT_NEAR((at.y - map.corner().y) / map.pixelSize(), 11.5f, 1e-4f);
  EXPECT_NEAR(at.z, 0.25f, 1e-6f);
}

// (D3) Check a map of one pixel, and that of a single leaf edge-on, which has an area of 0 to the light: they count
// what the lines of their pixels meet, and points on the rim, beside the map and far away are asked without harm.
TEST(D3_DeepOpacityMap, OfOnePixelAndOfALeafEdgeOn) {
  TreeMesh edge_on;
  edge_on.vertices = {{0.f, 1.f, 0.f}, {0.f, 3.f, 0.f}, {0.f, 2.f, 1.f}};
  edge_on.leaf_triangles = {{0, 1, 2}};
  finish(edge_on, "edge-on");
  const auto total = [](DeepOpacityMap::Counts counts) { return counts.before + counts.beyond; };
  for (const int resolution : {1, 3, 64}) {
    const DeepOpacityMap map(edge_on, kDown, resolution);
    EXPECT_GT(map.pixelSize(), 0.f);
    EXPECT_TRUE(map.crossings().empty());
    EXPECT_EQ(map.first().size(), static_cast<std::size_t>(map.size().x * map.size().y) + 1);
    const LeafDepths depths = leafDepths(edge_on, map).front();
    EXPECT_EQ(depths.depth[0], 0.f);
    EXPECT_EQ(depths.thickness[0], 1.f);
  }

  const DeepOpacityMap pixel(stack({3.f, 1.f, 2.f}), kDown, 1);
  ASSERT_EQ(pixel.size(), glm::ivec2(1));
  EXPECT_EQ(total(pixel.counts({0.9f, 0.1f, 2.5f})), 3);
  EXPECT_EQ(pixel.counts({0.9f, 0.1f, 2.5f}).before, 1);

  constexpr float kFar = 1e30f, kInfinity = std::numeric_limits<float>::infinity();
  const DeepOpacityMap map(stack({3.f, 1.f, 2.f}), kDown, 8);
  for (const float beside : {-0.01f, 1.01f, -kFar, kFar, -kInfinity, kInfinity, std::nanf("")}) {
    EXPECT_EQ(total(map.counts({beside, 0.5f, 0.f})), 0) << beside;
    EXPECT_EQ(total(map.counts({0.5f, beside, 0.f})), 0) << beside;
  }
  for (int i = 0; i <= 8; ++i) {  // on the borders of pixels either neighbour may answer, on the map's rim nobody
    const int met = total(map.counts({static_cast<float>(i) / 8.f, 0.4f, kFar}));
    EXPECT_TRUE(met == 3 || ((i == 0 || i == 8) && met == 0)) << i;
  }
  EXPECT_EQ(map.counts({0.5f, 0.4f, kFar}).beyond, 3);
  EXPECT_EQ(map.counts({0.5f, 0.4f, -kFar}).before, 3);
}

// (D6) Check depth and thickness of a stack, where they are known: n+ = 0, 1, 2 from the top, w = 3 for all.
TEST(D6_LeafDepths, OfAStack) {
  const TreeMesh mesh = stack({3.f, 1.f, 2.f});
  const LeafDepths depths = leafDepths(mesh, DeepOpacityMap(mesh, kDown, 16)).front();
  EXPECT_EQ(depths.depth, (std::vector<float>{0.f, 2.f, 1.f}));
  EXPECT_EQ(depths.thickness, (std::vector<float>{3.f, 3.f, 3.f}));
}

// (D6) Check that an edge-on leaf, which no light ray meets, is still counted at its centre.
TEST(D6_LeafDepths, OfALeafEdgeOnToTheLight) {
  TreeMesh mesh = stack({3.f});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const glm::vec3 corner : {glm::vec3(0.2f, 0.5f, 0.f), glm::vec3(0.8f, 0.5f, 0.f), glm::vec3(0.8f, 0.5f, 1.f)})
    mesh.vertices.push_back(corner);
  mesh.leaf_triangles.push_back({first, first + 1, first + 2});
  finish(mesh, "edge-on");
  const LeafDepths depths = leafDepths(mesh, DeepOpacityMap(mesh, kDown, 16)).front();
  EXPECT_EQ(depths.depth[1], 1.f);
  EXPECT_EQ(depths.thickness[1], 2.f);
}

// (D6) Check Eq. 31 for leaves: the neighbour's map, shifted, adds its leaves. Light at 45 degrees along x; the
// neighbour stands where its squares cover the line.
TEST(D6_LeafDepths, CountNeighbours) {
  const TreeMesh mesh = stack({0.f});
  const Direction slanted = glm::normalize(glm::vec3(1.f, 0.f, -1.f));
  const DeepOpacityMap map(mesh, slanted, 64);
  const Stand stand{
      .trees = {{}, {.position = {-1.f, 0.f, 1.f}}, {.position = {2.f, 0.f, -2.f}}, {.position = {0.f, 5.f, 0.f}}}};
  const LeafDepths depths = leafDepths(mesh, map, stand).front();
  EXPECT_NEAR(depths.depth[0], 1.f, 1e-6f);
  EXPECT_NEAR(depths.thickness[0], 3.f, 1e-6f);
}

// (D6) Check depth and thickness in a periodic stand of two trees, squares of side 1, against counts by hand. Light at
// 45 degrees along x; the second tree is 2 m higher, so that its shadow on z = 0 lies 2 m on: on [1.25, 2.25] and so on
// by periods of 2 m, which meets a quarter of the first tree's [0, 1].
TEST(D6_LeafDepths, CountTheCopiesOfAPeriodicStand) {
  const TreeMesh mesh = stack({0.f});
  const Direction slanted = glm::normalize(glm::vec3(1.f, 0.f, -1.f));
  const DeepOpacityMap map(mesh, slanted, 64);
  const Stand stand{.trees = {{}, {.position = {1.25f, 0.f, 2.f}}}, .period = glm::vec2(2.f, 1.f)};
  const std::vector<LeafDepths> depths = leafDepths(mesh, map, stand);
  const float pixel = 1.f / 64.f;  // the pixel nearest to the shifted one is up to half of one off
  EXPECT_NEAR(depths[0].depth[0], 0.25f, pixel);
  EXPECT_NEAR(depths[0].thickness[0], 1.25f, pixel);
  EXPECT_EQ(depths[1].depth[0], 0.f);
  EXPECT_NEAR(depths[1].thickness[0], 1.25f, pixel);
}

// (D6) Check that the depths of each tree of many are the same to the bit as if only those that can be met stood there:
// trees in a row across the light do not see each other, and the order is none.
TEST(D6_LeafDepths, OfEachTreeCountThoseItMeets) {
  const TreeMesh mesh = randomCrown({}, 3);
  const float width = leafBounds(mesh).size().x + leafBounds(mesh).size().y;
  const Direction slanted = glm::normalize(glm::vec3(1.f, 0.f, -0.2f));
  const DeepOpacityMap map(mesh, slanted, 64);
  Stand stand;
  stand.trees.clear();
  for (int row = 0; row < 5; ++row)
    for (const float x : {0.f, 0.7f, 2.5f})
      stand.trees.push_back({.position = {x, width * static_cast<float>(row), 0}});
  const std::vector<LeafDepths> all = leafDepths(mesh, map, stand);
  const std::vector<LeafDepths> of_row =
      leafDepths(mesh, map, {.trees = {stand.trees[2], stand.trees[1], stand.trees[0]}});
  for (std::size_t tree = 0; tree < all.size(); ++tree) {
    EXPECT_EQ(all[tree].depth, of_row[2 - tree % 3].depth) << tree;
    EXPECT_EQ(all[tree].thickness, of_row[2 - tree % 3].thickness) << tree;
  }
  EXPECT_NE(all[0].depth, leafDepths(mesh, map).front().depth);
}

// Check that as many trees may stand in one place as the shortest period allows, and no more: alone, as copies, and
// both.
TEST(Neighbours, AreNotTooManyInOnePlace) {
  Bounds box;
  box.include(glm::vec3(-1.f, -1.f, 0.f));
  box.include(glm::vec3(1.f, 1.f, 3.f));
  Stand stand{.trees = std::vector<Placement>(64)};
  for (std::size_t i = 0; i < 64; ++i) stand.trees[i].position.x = 1e-3f * static_cast<float>(i);
  EXPECT_NO_THROW(requireApart(stand, std::span(&box, 1)));
  stand.trees.push_back({.position = {5.f, 0.f, 0.f}});
  EXPECT_NO_THROW(requireApart(stand, std::span(&box, 1)));
  stand.period = glm::vec2(5.f, 9.f);  // a copy of the last stands among them
  EXPECT_THROW(requireApart(stand, std::span(&box, 1)), InvalidInput);
  stand = {.trees = {Placement{}}, .period = glm::vec2(0.251f)};
  EXPECT_NO_THROW(requireApart(stand, std::span(&box, 1)));
  stand.trees.emplace_back();
  EXPECT_THROW(requireApart(stand, std::span(&box, 1)), InvalidInput);
}

// Check that overlapping copies are all kept, as far as 8 widths, and that a period too short for the models is
// refused.
TEST(Neighbours, ReachAsFarForShortPeriods) {
  Bounds box;
  box.include(glm::vec3(-1.f, -1.f, 0.f));
  box.include(glm::vec3(1.f, 1.f, 3.f));
  EXPECT_EQ(periodsAround({.trees = {Placement{}}, .period = glm::vec2(0.5f, 4.f)}, box), glm::ivec2(32, 8));
  EXPECT_EQ(periodsAround({}, box), glm::ivec2(0));
  EXPECT_THROW(periodsAround({.trees = {Placement{}}, .period = glm::vec2(0.2f, 4.f)}, box), InvalidInput);
}

// (D6) Check that a leaf folded over itself does not stand in its own light.
TEST(D6_LeafDepths, OfAFoldedLeaf) {
  TreeMesh mesh;
  mesh.vertices = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {1, 0.9f, 0}};
  mesh.leaf_triangles = {{0, 1, 2}, {0, 1, 3}};  // two flaps on one edge, the second below the first
  finish(mesh, "folded");
  ASSERT_EQ(mesh.leaf_count, 1u);
  const LeafDepths depths = leafDepths(mesh, DeepOpacityMap(mesh, kDown, 32)).front();
  EXPECT_EQ(depths.depth[0], 0.f);
  EXPECT_EQ(depths.thickness[0], 1.f);
}

}  // namespace
