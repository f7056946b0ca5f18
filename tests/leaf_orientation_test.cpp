#include "grid/leaf_orientation.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

#include "core/random.hpp"
#include "grid/density_grid.hpp"
#include "grid/triangle_clipping.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "scattering/leaf_angles.hpp"
#include "scattering/leaf_scattering.hpp"
#include "tests/random_leaves.hpp"

using namespace sunfleck;

namespace {

std::array<float, 6> entries(const LeafOrientation& m) {
  return {m.xx, m.yy, m.zz(), m.xy, m.xz, m.yz};
}

// n n^T, in the same order.
std::array<double, 6> product(const glm::dvec3& n) {
  return {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
}

glm::dvec3 areaVector(const TreeMesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
  return 0.5 * glm::cross(b - a, c - a);
}

std::vector<glm::vec3> cellCentres(float cell_size, int half) {
  std::vector<glm::vec3> centres;
  for (int x = -half; x < half; ++x)
    for (int y = -half; y < half; ++y)
      for (int z = -half; z < half; ++z) centres.push_back(cell_size * (glm::vec3(x, y, z) + 0.5f));
  return centres;
}

// The surface of a box, outward, as wood or as leaves.
void addBox(TreeMesh& mesh, std::vector<glm::uvec3>& triangles, const glm::vec3& low, const glm::vec3& high) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const auto& [pu, pv] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        glm::vec3 corner = low;
        corner[axis] = upper ? high[axis] : low[axis];
        if (pu == 1) corner[u] = high[u];
        if (pv == 1) corner[v] = high[v];
        mesh.vertices.push_back(corner);
      }
      const auto at = [&](std::uint32_t i) { return first + (upper ? i : 3 - i); };
      triangles.push_back({at(0), at(1), at(2)});
      triangles.push_back({at(0), at(2), at(3)});
    }
}

TreeMesh finished(TreeMesh mesh) {
  finish(mesh, "test");
  return mesh;
}

// A leaf far from the wood that is looked at.
void addLeaf(TreeMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{9.1f, 9.1f, 9.1f}, {9.2f, 9.1f, 9.1f}, {9.1f, 9.2f, 9.1f}});
  mesh.leaf_triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

// Check that a flat leaf, which crosses many cells, has M = n n^T in each. Error: floats of the vertices, some 1e-7 of
// the leaf's size.
TEST(D7_LeafOrientation, FlatLeafHasOneNormal) {
  TreeMesh mesh;
  mesh.vertices = {{-1.f, -.8f, -.6f}, {1.f, -.3f, .2f}, {-.2f, 1.f, .9f}};
  mesh.leaf_triangles = {{0, 1, 2}};
  mesh = finished(mesh);
  const auto expected = product(glm::normalize(areaVector(mesh, mesh.leaf_triangles[0])));
  const DensityGrid grid = DensityGrid::voxelize(mesh, .1f);
  ASSERT_GT(grid.occupiedCells(), 100u);
  for (const glm::vec3& cell : cellCentres(.1f, 15)) {
    if (grid.at(cell) == 0.f) continue;
    const auto found = entries(grid.orientationAt(cell));
    for (std::size_t i = 0; i < 6; ++i) ASSERT_NEAR(static_cast<double>(found[i]), expected[i], 1e-6);
  }
  EXPECT_EQ(entries(grid.orientationAt(glm::vec3(5.f))), entries(LeafOrientation{}));  // no leaves there
}

// Check that leaves that face all directions alike, the faces of a cube, give 1/3 of the unit matrix, and that leaves
// count by their area: of two flat ones, of 3 and of 1, 3/4 and 1/4. Error: rounding to floats.
TEST(D7_LeafOrientation, IsAMeanOverTheArea) {
  TreeMesh cube;
  addBox(cube, cube.leaf_triangles, glm::vec3(.25f), glm::vec3(.75f));
  const auto isotropic = entries(DensityGrid::voxelize(finished(cube), 1.f).orientationAt(glm::vec3(.5f)));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(isotropic[i], i < 3 ? 1.f / 3.f : 0.f, 1e-7f);

  TreeMesh two;
  two.vertices = {{.1f, .1f, .5f}, {.7f, .1f, .5f}, {.1f, .2f, .5f}, {.5f, .1f, .1f}, {.5f, .2f, .1f}, {.5f, .1f, .3f}};
  two.leaf_triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto mean = entries(DensityGrid::voxelize(finished(two), 1.f).orientationAt(glm::vec3(.5f)));
  EXPECT_NEAR(mean[0], .25f, 1e-6f);
  EXPECT_NEAR(mean[2], .75f, 1e-6f);
}

// Check that the moments of the cells, weighed by their leaf area, add up to those of the mesh, at any cell size, and
// that each is possible. Error: rounding of each to a float, 6e-8.
TEST(D7_LeafOrientation, CellsAddUpToTheMesh) {
  const TreeMesh mesh = randomLeaves(1000, 1.f, .1f);
  std::array<double, 6> expected{};
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    const glm::dvec3 vector = areaVector(mesh, t);
    const auto of_triangle = product(glm::normalize(vector));
    for (std::size_t i = 0; i < 6; ++i) expected[i] += glm::length(vector) * of_triangle[i];
  }
  for (const float h : {.1f, .4f}) {
    const DensityGrid grid = DensityGrid::voxelize(mesh, h);
    std::array<double, 6> sums{};
    for (const glm::vec3& cell : cellCentres(h, h < .2f ? 15 : 5)) {
      const LeafOrientation m = grid.orientationAt(cell);
      ASSERT_TRUE(m.possible());
      for (std::size_t i = 0; i < 6; ++i)
        sums[i] += std::pow(static_cast<double>(h), 3) * static_cast<double>(grid.at(cell) * entries(m)[i]);
    }
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(sums[i], expected[i], 2e-7 * leafArea(mesh)) << h << " " << i;
  }
}

TEST(D7_LeafOrientation, IsTheSameForAnyNumberOfThreads) {
  const TreeMesh mesh = grow(species("cherry"), 1);
  std::vector<std::array<float, 7>> one;
  for (const std::size_t threads : {1u, 2u, 5u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const DensityGrid grid = DensityGrid::voxelize(mesh, .5f);
    std::vector<std::array<float, 7>> found;
    for (const glm::vec3& cell : cellCentres(.5f, 20)) {
      const auto m = entries(grid.orientationAt(cell));
      found.push_back({m[0], m[1], m[2], m[3], m[4], m[5], grid.woodAt(cell)});
    }
    if (threads == 1) one = found;
    EXPECT_EQ(found, one) << threads;
    EXPECT_GT(grid.projectedWoodArea(), 0.);
  }
}

TEST(D7_LeafOrientation, TellsWhatIsNoMeanOfNormals) {
  EXPECT_TRUE(LeafOrientation{}.possible());
  EXPECT_TRUE((LeafOrientation{1.f, 0.f, 0.f, 0.f, 0.f}.possible()));
  EXPECT_TRUE((LeafOrientation{.5f, .5f, .5f, 0.f, 0.f}.possible()));
  EXPECT_FALSE((LeafOrientation{.7f, .7f, 0.f, 0.f, 0.f}.possible()));   // trace
  EXPECT_FALSE((LeafOrientation{-.1f, .5f, 0.f, 0.f, 0.f}.possible()));  // a square below 0
  EXPECT_FALSE((LeafOrientation{.5f, .3f, .5f, 0.f, 0.f}.possible()));   // |n_x n_y| too large
  EXPECT_FALSE((LeafOrientation{.3f, .3f, .25f, .25f, -.25f}.possible()));
  EXPECT_FALSE((LeafOrientation{std::nanf(""), .3f, 0.f, 0.f, 0.f}.possible()));
}

// Check the cases in which the second moments tell all: parallel leaves, |n . s|; all directions alike, 1/2; and that
// leaves which stand upright, turned every way, are 2/pi seen from the side and 0 from above. The model's 2/pi is
// sqrt(13/32), .0008 above.
TEST(D8_Projection, IsRightWhereTheMomentsTellAll) {
  Random random(4, 0);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const auto direction = [&] {
      return glm::normalize(glm::vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5f);
    };
    const glm::vec3 n = direction(), s = direction();
    const LeafOrientation parallel{n.x * n.x, n.y * n.y, n.x * n.y, n.x * n.z, n.y * n.z};
    // Near 0 it is the root of the rounding of zz, some 1e-7.
    EXPECT_NEAR(parallel.projection(s), std::abs(glm::dot(n, s)), 5e-4f);
    EXPECT_NEAR(LeafOrientation{}.projection(s), .5f, 1e-6f);
  }
  const LeafOrientation upright{.5f, .5f, 0.f, 0.f, 0.f};
  EXPECT_NEAR(upright.projection({1.f, 0.f, 0.f}), 2.f / std::numbers::pi_v<float>, 8e-4f);
  EXPECT_EQ(upright.projection({0.f, 0.f, 1.f}), 0.f);
}

// Check the model's error against the exact projection of the classical leaf angles, whose second moments are not all
// there is to know: as EQUATIONS.md states it, rounded up.
TEST(D8_Projection, IsCloseForTheClassicalLeafAngles) {
  const std::vector<std::tuple<const char*, double>> largest_errors = {{"spherical", 1e-6},    {"planophile", .025},
                                                                       {"erectophile", .005},  {"plagiophile", .042},
                                                                       {"extremophile", .046}, {"uniform", .019}};
  for (const auto& [name, largest] : largest_errors) {
    const LeafAngles angles = LeafAngles::named(name);
    const double zz = angles.mean([](double theta) { return std::cos(theta) * std::cos(theta); }, 0.5);
    const auto xx = static_cast<float>((1. - zz) / 2.);
    double found = 0.;
    for (int i = 0; i <= 20; ++i) {
      const float mu = static_cast<float>(i) / 20.f;
      const float model = LeafOrientation{xx, xx, 0.f, 0.f, 0.f}.projection({std::sqrt(1.f - mu * mu), 0.f, mu});
      found = std::max(found, std::abs(static_cast<double>(model) - leafProjection(angles, static_cast<double>(mu))));
    }
    EXPECT_LE(found, largest) << name;
  }
}

// Check the model against exact means of |n . s| in the cells of a grown tree, whose cells hold few leaves each, and in
// their sum: errors as EQUATIONS.md states them, rounded up.
TEST(D8_Projection, IsCloseInTheCellsOfATree) {
  const TreeMesh mesh = grow(species("cherry"), 1);
  const std::vector<Direction> directions = spreadAxes(4);
  const glm::vec3 size = leafBounds(mesh).size();
  for (const auto& [cells, rms, of_all] : {std::tuple{16.f, .02, .004}, {64.f, .031, .004}}) {
    const float h = std::max({size.x, size.y, size.z}) / cells;
    const DensityGrid grid = DensityGrid::voxelize(mesh, h);
    struct Exact {
      double area = 0.;
      std::array<double, 4> projected{};
    };
    std::map<std::array<int, 3>, Exact> exact;
    std::vector<CellShare> shares;
    for (const glm::uvec3& t : mesh.leaf_triangles) {
      const auto corner = [&](std::uint32_t i) { return glm::dvec3(mesh.vertices[i]) / static_cast<double>(h); };
      const glm::dvec3 vector = areaVector(mesh, t), n = glm::normalize(vector);
      shares.clear();
      shareAmongCells(triangle(corner(t.x), corner(t.y), corner(t.z)), vector, shares);
      for (const CellShare& share : shares) {
        Exact& cell = exact[{share.cell.x, share.cell.y, share.cell.z}];
        cell.area += share.area;
        for (std::size_t j = 0; j < 4; ++j)
          cell.projected[j] += share.area * std::abs(glm::dot(n, glm::dvec3(directions[j])));
      }
    }
    double squares = 0., area = 0.;
    std::array<double, 4> totals{};
    for (const auto& [index, cell] : exact) {
      const glm::vec3 centre = h * (glm::vec3(index[0], index[1], index[2]) + 0.5f);
      area += cell.area;
      for (std::size_t j = 0; j < 4; ++j) {
        const auto model = static_cast<double>(grid.orientationAt(centre).projection(directions[j]));
        squares += cell.area * std::pow(model - cell.projected[j] / cell.area, 2);
        totals[j] += cell.projected[j];
      }
    }
    EXPECT_LT(std::sqrt(squares / area / 4.), rms) << cells;
    for (std::size_t j = 0; j < 4; ++j) {
      const double whole = grid.projectedLeafArea(directions[j]) / grid.leafArea() - totals[j] / area;
      EXPECT_LT(std::abs(whole), of_all) << cells;
    }
  }
}

// Check wood that is thinner than a cell: a box within one, whose mean shadow is a quarter of its surface (Cauchy).
// Error: the vertices are floats.
TEST(D9_Wood, BodyInACellIsItsMeanShadow) {
  TreeMesh mesh;
  addBox(mesh, mesh.wood_triangles, {.1f, .2f, .3f}, {.2f, .5f, .9f});
  addLeaf(mesh);
  const DensityGrid grid = DensityGrid::voxelize(finished(mesh), 2.f);
  const double surface = 2. * (.1 * .3 + .3 * .6 + .6 * .1);
  EXPECT_NEAR(static_cast<double>(grid.woodAt(glm::vec3(1.f))), surface / 4. / 8., 1e-6);
  EXPECT_NEAR(grid.projectedWoodArea(), surface / 4., 1e-6);
  EXPECT_EQ(grid.at(glm::vec3(1.f)), 0.f);  // wood is no leaf
  EXPECT_EQ(grid.woodAt(glm::vec3(3.f)), 0.f);
  EXPECT_EQ(grid.grids().back().cells, 1u);
}

// Check wood that is thicker than a cell, a box of 4 cells a side: cells within a face hold a wall, of which half its
// area is seen in the mean of all directions; those at an edge two at right angles, S = 2, |V| = sqrt 2; and no wood is
// found inside. Error: rounding.
TEST(D9_Wood, WallsOfAThickBody) {
  TreeMesh mesh;
  addBox(mesh, mesh.wood_triangles, glm::vec3(.25f), glm::vec3(1.75f));
  addLeaf(mesh);
  const DensityGrid grid = DensityGrid::voxelize(finished(mesh), .5f);
  const auto wall = [&](glm::vec3 at) { return static_cast<double>(grid.woodAt(at)); };
  EXPECT_NEAR(wall({.3f, .8f, 1.2f}), 1. / (2. * .5), 1e-6);
  EXPECT_NEAR(wall({.8f, 1.7f, 1.2f}), 1. / (2. * .5), 1e-6);
  EXPECT_NEAR(wall({.3f, .3f, 1.2f}), .5 * (2. + std::sqrt(2.)) / (4. * .5), 1e-6);
  EXPECT_EQ(grid.woodAt({.8f, .8f, 1.2f}), 0.f);
}

// Check that the tubes of a grown tree are seen as bodies: their extinction adds up to at least a quarter of the
// surface, and to at most a half, which it would be if each cell held but a wall.
TEST(D9_Wood, OfATreeLiesBetweenBodiesAndWalls) {
  const TreeMesh mesh = grow(species("cherry"), 1);
  double surface = 0.;
  for (const glm::uvec3& t : mesh.wood_triangles) surface += glm::length(areaVector(mesh, t));
  const double coarse = DensityGrid::voxelize(mesh, 2.f).projectedWoodArea() / surface;
  const double fine = DensityGrid::voxelize(mesh, .05f).projectedWoodArea() / surface;
  EXPECT_GT(coarse, .25);
  EXPECT_LT(coarse, .27);  // hardly a cell cuts the wood's surface
  EXPECT_GT(fine, coarse);
  EXPECT_LT(fine, .5);
}
