#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/require.hpp"
#include "grid/deep_opacity_map.hpp"
#include "grid/instance_cells.hpp"
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

// (D3) Check that inSpace and inMap undo each other. Error: float rounding of metres.
TEST(D3_DeepOpacityMap, MapsPointsBothWays) {
  const DeepOpacityMap map(stack({1.f, 0.f}), glm::normalize(glm::vec3(0.3f, -0.5f, -0.8f)), 20);
  const glm::vec3 point = map.inSpace(7, 11, 0.25f);
  const glm::vec3 at = map.inMap(point);
  EXPECT_NEAR((at.x - map.corner().x) / map.pixelSize(), 7.5f, 1e-4f);
  EXPECT_NEAR((at.y - map.corner().y) / map.pixelSize(), 11.5f, 1e-4f);
  EXPECT_NEAR(at.z, 0.25f, 1e-6f);
}

// (D6) Check depth and thickness of a stack, where they are known: n+ = 0, 1, 2 from the top, w = 3 for all.
TEST(D6_LeafDepths, OfAStack) {
  const TreeMesh mesh = stack({3.f, 1.f, 2.f});
  const LeafDepths depths = leafDepths(mesh, DeepOpacityMap(mesh, kDown, 16), {});
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
  const LeafDepths depths = leafDepths(mesh, DeepOpacityMap(mesh, kDown, 16), {});
  EXPECT_EQ(depths.depth[1], 1.f);
  EXPECT_EQ(depths.thickness[1], 2.f);
}

// (D6) Check Eq. 31 for leaves: the neighbour's map, shifted, adds its leaves. Light at 45 degrees along x; the
// neighbour stands where its squares cover the line.
TEST(D6_LeafDepths, CountNeighbours) {
  const TreeMesh mesh = stack({0.f});
  const Direction slanted = glm::normalize(glm::vec3(1.f, 0.f, -1.f));
  const DeepOpacityMap map(mesh, slanted, 64);
  const std::vector<glm::vec3> neighbours{{-1.f, 0.f, 1.f}, {2.f, 0.f, -2.f}, {0.f, 5.f, 0.f}};
  const LeafDepths depths = leafDepths(mesh, map, neighbours);
  EXPECT_NEAR(depths.depth[0], 1.f, 1e-6f);
  EXPECT_NEAR(depths.thickness[0], 3.f, 1e-6f);
}

// Check the neighbours along a direction against those worked out by hand, for trees 2 m wide that touch: 8 periods are
// kept; overhead only the 8 that touch can be met; and along x three rows, forward to the last and back to those that
// touch.
TEST(Neighbours, AlongADirectionAreThoseThatCanBeMet) {
  Bounds box;
  box.include(glm::vec3(-1.f, -1.f, 0.f));
  box.include(glm::vec3(1.f, 1.f, 3.f));
  const std::vector<glm::vec3> all =
      neighbourDisplacements({.trees = {Placement{}}, .period = glm::vec2(2.f, 2.f)}, box, 0);
  EXPECT_EQ(all.size(), 17u * 17u - 1u);
  EXPECT_EQ(neighboursAlong(all, box, kDown, true).size(), 8u);
  EXPECT_EQ(neighboursAlong(all, box, {1.f, 0.f, 0.f}, false).size(), 3u * 8u + 3u * 2u - 1u);
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
  const LeafDepths depths = leafDepths(mesh, DeepOpacityMap(mesh, kDown, 32), {});
  EXPECT_EQ(depths.depth[0], 0.f);
  EXPECT_EQ(depths.thickness[0], 1.f);
}

// (D4) Check cell depths at known places: below a stack all leaves lie upward and none downward.
TEST(D4_CellDepths, OfAStack) {
  const TreeMesh mesh = stack({0.5f, 0.6f, 0.f, 1.f});
  const CellGrid cells = cellGrid(mesh, 4);
  ASSERT_EQ(cells.size, glm::ivec3(4));
  const std::vector<Direction> axes{{0.f, 0.f, 1.f}};
  const auto maps = deepOpacityMaps(mesh, axes, 64);
  const auto depths = cellDepths(cells, maps, {});
  const auto depth = [&](int z, std::size_t j) {
    return depths[static_cast<std::size_t>((z * 4 + 1) * 4 + 1) * 2 + j];
  };
  EXPECT_EQ(depth(3, 0), 1.f);  // between 0.75 and 1: the square at 1 above, three below
  EXPECT_EQ(depth(3, 1), 3.f);
  EXPECT_EQ(depth(0, 0), 3.f);
  EXPECT_EQ(depth(0, 1), 1.f);
  // A neighbour exactly above adds its four.
  const std::vector<glm::vec3> above{{0.f, 0.f, 10.f}};
  EXPECT_EQ(cellDepths(cells, maps, above)[static_cast<std::size_t>((3 * 4 + 1) * 4 + 1) * 2], 5.f);
}

// (D5) Check the two ends of the G-factor: deep in the middle of a crown repeated without gaps it approaches 1; for a
// lone column it is lower everywhere, and always in [0, 1].
TEST(D5_CellCompensation, IsHighInAStandAndLowerForALoneTree) {
  const RandomLayer layer{.size = {1.f, 1.f}, .height = 1.f, .leaf_side = 0.05f, .leaf_area_index = 4.f};
  const TreeMesh mesh = randomLayer(layer, 5);
  const std::vector<Direction> directions = spreadAxes(11);
  const auto maps = deepOpacityMaps(mesh, directions, 128);
  const DeepOpacityMap light(mesh, kDown, 128);
  const CellGrid cells = cellGrid(mesh, 8);
  const auto mean = [&](std::span<const glm::vec3> neighbours) {
    const auto depths = cellDepths(cells, maps, neighbours);
    const auto g = cellCompensation(cells, maps, depths, light, neighbours);
    for (const float value : g) {
      EXPECT_GE(value, 0.f);
      EXPECT_LE(value, 1.f);
    }
    return std::accumulate(g.begin(), g.end(), 0.) / static_cast<double>(g.size());
  };
  const double alone = mean({});
  const double in_stand =
      mean(neighbourDisplacements({.trees = {Placement{}}, .period = layer.size}, leafBounds(mesh), 0));
  // Where chance makes a path meet fewer leaves than the slab's mean, G falls below 1, and nowhere does it rise above:
  // the loss is one-sided, .07 for this layer.
  EXPECT_GT(in_stand, 0.9);
  EXPECT_LT(alone, 0.8);
}

// Check interpolation: exact for a linear function between cell centres, and clamped outside.
TEST(CellGrid, InterpolatesLinearly) {
  const CellGrid cells = cellGrid(stack({0.f, 1.f}), 5);
  std::vector<float> values;
  for (std::size_t cell = 0; cell < cells.count(); ++cell) {
    const glm::vec3 centre = cells.lowCorner(cell) + 0.5f * cells.cell_size;
    values.push_back(1.f + 2.f * centre.x - centre.y + 3.f * centre.z);
  }
  EXPECT_NEAR(interpolate(cells, values, {0.41f, 0.37f, 0.77f}), 1.f + 0.82f - 0.37f + 2.31f, 1e-5f);
  EXPECT_NEAR(interpolate(cells, values, {-9.f, -9.f, -9.f}), interpolate(cells, values, {0.1f, 0.1f, 0.1f}), 1e-5f);
}

}  // namespace
