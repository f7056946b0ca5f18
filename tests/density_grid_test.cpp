#include "grid/density_grid.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "core/require.hpp"
#include "grid/triangle_clipping.hpp"
#include "tests/random_leaves.hpp"

using namespace sunfleck;

namespace {

TreeMesh oneTriangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  TreeMesh mesh;
  mesh.vertices = {a, b, c};
  mesh.leaf_triangles = {{0, 1, 2}};
  finish(mesh, "one triangle");
  return mesh;
}

std::vector<CellShare> sharesOf(const ConvexPolygon& polygon) {
  std::vector<CellShare> shares;
  shareAmongCells(polygon, glm::cross(polygon.corners[1] - polygon.corners[0], polygon.corners[2] - polygon.corners[0]),
                  shares);
  return shares;
}

double total(const std::vector<CellShare>& shares) {
  return std::accumulate(shares.begin(), shares.end(), 0., [](double sum, const CellShare& s) { return sum + s.area; });
}

double shareOf(const std::vector<CellShare>& shares, glm::ivec3 cell) {
  double area = 0.;
  for (const CellShare& share : shares)
    if (share.cell == cell) area += share.area;
  return area;
}

}  // namespace

// Check the shares of a right triangle over the four squares it crosses, where they are plain: 1, 1/2, 1/2, 0. Exact in
// binary but for the rounding of the sums: a few ulp.
TEST(D2_TriangleClipping, SharesOfAFlatTriangleAreThoseOfPlaneGeometry) {
  const auto shares = sharesOf(triangle({0., 0., .5}, {2., 0., .5}, {0., 2., .5}));
  EXPECT_EQ(shares.size(), 3u);
  EXPECT_NEAR(shareOf(shares, {0, 0, 0}), 1., 1e-15);
  EXPECT_NEAR(shareOf(shares, {1, 0, 0}), .5, 1e-15);
  EXPECT_NEAR(shareOf(shares, {0, 1, 0}), .5, 1e-15);
}

// Check a tilted triangle x + y + z = 1.5 across the unit cell: the middle is a regular hexagon of side 1 / sqrt(2),
// whose area is 3 sqrt(3) / 4. Error: rounding.
TEST(D2_TriangleClipping, DiagonalPlaneCutsAHexagonFromACell) {
  const auto shares = sharesOf(triangle({4.5, -1.5, -1.5}, {-1.5, 4.5, -1.5}, {-1.5, -1.5, 4.5}));
  EXPECT_NEAR(shareOf(shares, {0, 0, 0}), 0.75 * std::sqrt(3.), 1e-14);
}

// Check that the shares of random triangles of all sizes, in place and far away, add up to the triangle's area and that
// no cell gets more than the largest flat section of a cube, sqrt(2). Error: rounding of coordinates, 1e-16 of the
// distance from the origin, over the triangle's size.
TEST(D2_TriangleClipping, SharesAddUpToTheTriangle) {
  Random random(5, 0);
  const auto point = [&] {
    return glm::dvec3(random.uniformDouble(), random.uniformDouble(), random.uniformDouble()) - 0.5;
  };
  for (const double size : {0.01, 1., 10., 60.})
    for (const double distance : {0., 1e3, 1e6})
      for (int repeat = 0; repeat < 50; ++repeat) {
        const glm::dvec3 away = distance * point();
        const ConvexPolygon t = triangle(away + size * point(), away + size * point(), away + size * point());
        const glm::dvec3 area_vector = 0.5 * glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
        const auto shares = sharesOf(t);
        const double rounding = 1e-13 + 1e-14 * distance / size;
        EXPECT_NEAR(total(shares) / (size * size), glm::length(area_vector) / (size * size), rounding);
        for (const CellShare& share : shares) ASSERT_LE(share.area, std::sqrt(2.) + rounding * size * size);
      }
}

// Check that a share agrees with counting: of points spread over a triangle by a uniform lattice, those in each cell.
// With n^2 points a cell's share is uncertain by the points along its outline: at most 4 sides of n points.
TEST(D2_TriangleClipping, SharesAgreeWithCountedPoints) {
  const glm::dvec3 a(0.1, 0.3, -0.7), b(3.2, 1.4, 0.6), c(1.3, 2.9, 2.2);
  const auto shares = sharesOf(triangle(a, b, c));
  const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
  constexpr int n = 1000;
  for (const CellShare& share : shares) {
    int inside = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const glm::dvec3 p = a + (b - a) * ((i + 1. / 3.) / n) + (c - a) * ((j + 1. / 3.) / n);
        inside += glm::ivec3(glm::floor(p)) == share.cell;
      }
    EXPECT_NEAR(share.area, area * inside / (0.5 * n * n), area * 4. * n / (0.5 * n * n));
  }
}

// Check that leaves in a wall between cells are counted once, in the upper cell, and that slivers, needles and points
// share what area they have: no more, and no less than rounding takes.
TEST(D2_TriangleClipping, DegenerateTrianglesAreSafe) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 corners[3] = {{0.2, 0.2, 0.2}, {0.8, 0.2, 0.5}, {0.3, 0.9, 0.7}};
    for (glm::dvec3& corner : corners) corner[axis] = 3.;
    const auto shares = sharesOf(triangle(corners[0], corners[1], corners[2]));
    ASSERT_EQ(shares.size(), 1u);
    EXPECT_EQ(shares[0].cell[axis], 3);
  }
  EXPECT_TRUE(sharesOf(triangle({1., 1., 1.}, {1., 1., 1.}, {1., 1., 1.})).empty());
  EXPECT_TRUE(sharesOf(triangle({0., 0., 0.}, {5., 5., 5.}, {9., 9., 9.})).empty());
  const auto needle = sharesOf(triangle({0., 0.5, 0.5}, {1000., 0.5, 0.5}, {1000., 0.5 + 1e-9, 0.5}));
  EXPECT_EQ(needle.size(), 1000u);
  // Each of 1000 cuts moves an edge, at most 1000 long, by a digit of 0.5, 1e-16, at most: 1000 * 1000 / 2 * 1e-16.
  EXPECT_NEAR(total(needle), 5e-7, 5e-11);
  const auto on_corners = sharesOf(triangle({0., 0., 0.}, {4., 4., 0.}, {0., 4., 4.}));
  EXPECT_NEAR(total(on_corners), 8. * std::sqrt(3.), 1e-13);  // side 4 sqrt(2): 8 sqrt(3)
}

// Check that the grid's integral is the area of the leaves, at any cell size and place, the triangles being smaller and
// larger than a cell and a block. Error: each density is rounded to a float, 6e-8 at most.
TEST(D1_DensityGrid, IntegralIsTheLeafArea) {
  for (const glm::vec3 centre : {glm::vec3(0.f), glm::vec3(-1234.5f, 777.7f, 3.f)})
    for (const float half_side : {0.02f, 0.5f}) {
      const TreeMesh mesh = randomLeaves(500, 1.f, half_side, centre);
      for (const float cell_size : {0.05f, 0.25f, 1.f, 30.f}) {
        const DensityGrid grid = DensityGrid::voxelize(mesh, cell_size);
        EXPECT_NEAR(grid.leafArea() / leafArea(mesh), 1., 1e-7) << cell_size << " " << half_side;
        EXPECT_GT(grid.memoryBytes(), 4 * grid.occupiedCells());
      }
    }
}

// Check the value of single cells: a leaf of 0.02 m^2 in a cell of side 0.5 m has density 0.02 / 0.125, and cells span
// whole multiples of their side, negative ones too.
TEST(D1_DensityGrid, DensityIsLeafAreaOverVolume) {
  const DensityGrid grid =
      DensityGrid::voxelize(oneTriangle({-.4f, .1f, 1.1f}, {-.2f, .1f, 1.1f}, {-.4f, .3f, 1.1f}), .5f);
  EXPECT_EQ(grid.occupiedCells(), 1u);
  EXPECT_FLOAT_EQ(grid.cellSize(), .5f);
  const float expected = 0.02f / 0.125f;
  EXPECT_NEAR(grid.at({-.3f, .2f, 1.2f}), expected, 1e-6f * expected);  // coordinates are floats: some 1e-7
  EXPECT_EQ(grid.at({-.01f, .49f, 1.01f}), grid.at({-.49f, .01f, 1.49f}));
  EXPECT_EQ(grid.at({.01f, .2f, 1.2f}), 0.f);
  EXPECT_EQ(grid.at({-.3f, .2f, 1.51f}), 0.f);
  EXPECT_EQ(grid.occupied().low, glm::vec3(-.5f, 0.f, 1.f));
  EXPECT_EQ(grid.occupied().high, glm::vec3(0.f, .5f, 1.5f));
}

TEST(D1_DensityGrid, IsZeroFarAwayAndWhereThereIsNoPlace) {
  const DensityGrid grid = DensityGrid::voxelize(randomLeaves(10, 1.f, .1f), .1f);
  for (const float x : {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(grid.at({x, 0.f, 0.f}), 0.f);
}

// Check that the grid is the same, bit for bit, for any number of threads.
TEST(D1_DensityGrid, IsTheSameForAnyNumberOfThreads) {
  const TreeMesh mesh = randomLeaves(5000, 1.f, .1f);
  std::vector<float> one;
  double area = 0.;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const DensityGrid grid = DensityGrid::voxelize(mesh, .1f);
    const std::vector<float> values = sampled(grid);
    if (threads == 1) {
      one = values;
      area = grid.leafArea();
    }
    EXPECT_EQ(std::memcmp(values.data(), one.data(), one.size() * sizeof(float)), 0) << threads;
    EXPECT_EQ(grid.leafArea(), area);
  }
}

TEST(D1_DensityGrid, RefusesCellSizesThatCannotBe) {
  const TreeMesh mesh = randomLeaves(10, 1.f, .1f);
  for (const float bad : {0.f, -1.f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          1e-7f, 1e7f, 1e-6f /* 2e6 cells along an axis */})
    EXPECT_THROW(DensityGrid::voxelize(mesh, bad), InvalidInput) << bad;
  const TreeMesh wide = oneTriangle({0.f, 0.f, 0.f}, {1e4f, 0.f, 0.f}, {0.f, 1e4f, 0.f});
  EXPECT_THROW(DensityGrid::voxelize(wide, .02f), InvalidInput);  // 1e11 cells
  const TreeMesh far = oneTriangle({9e3f, 0.f, 0.f}, {9e3f + 1.f, 0.f, 0.f}, {9e3f, 1.f, 0.f});
  EXPECT_THROW(DensityGrid::voxelize(far, 2e-6f), InvalidInput);  // 4.5e9 cells from the origin
  EXPECT_THROW(DensityGrid::voxelize(TreeMesh{}, .1f), InvalidInput);
}

// Check that cells are refused before they are made when they would take more than 8 GiB, with the figure: a leaf of
// half a square of 28,000 cells a side crosses 6 million blocks of 2 KiB each and more.
TEST(D1_DensityGrid, RefusesMoreMemoryThanThereIs) {
  const TreeMesh mesh = oneTriangle({0.f, 0.f, 0.f}, {28.f, 0.f, 0.f}, {0.f, 28.f, 0.f});
  try {
    DensityGrid::voxelize(mesh, .001f);
    FAIL();
  } catch (const InvalidInput& wrong) {
    const std::string line = wrong.what();
    EXPECT_NE(line.find("cell size [m] = 0.001: must be so large that the grids take less memory: "), line.npos)
        << line;
    EXPECT_NE(line.find(" GB, of "), line.npos) << line;
  }
}

TEST(D1_DensityGrid, TellsProgressAndStopsWhenAsked) {
  const TreeMesh mesh = randomLeaves(100, 1.f, .1f);
  std::vector<double> told;
  DensityGrid::voxelize(mesh, .1f, [&](double done) { return told.push_back(done), true; });
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.front(), 0.);
  EXPECT_EQ(told.back(), 1.);
  EXPECT_THROW(DensityGrid::voxelize(mesh, .1f, [](double done) { return done < 0.5; }), std::runtime_error);
}
