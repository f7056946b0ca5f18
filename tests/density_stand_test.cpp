#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "core/stand.hpp"
#include "grid/density_grid.hpp"
#include "tests/grid_files.hpp"
#include "tests/random_leaves.hpp"

using namespace sunfleck;

namespace {

// Leaves about (0.3, 0, 2) with a stick beside them. Coordinates are whole multiples of 2^-12 m, so that moving them by
// some metres rounds nothing.
TreeMesh tree() {
  TreeMesh mesh = randomLeaves(300, 1.f, .1f, {.3f, 0.f, 2.f});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{.3f, 0.f, 0.f}, {.35f, 0.f, 0.f}, {.3f, .05f, 1.9f}});
  mesh.wood_triangles = {{first, first + 1, first + 2}};
  for (glm::vec3& vertex : mesh.vertices) vertex = glm::round(vertex * 4096.f) / 4096.f;
  return mesh;
}

TreeMesh moved(TreeMesh mesh, glm::vec3 by) {
  for (glm::vec3& vertex : mesh.vertices) vertex += by;
  return mesh;
}

TreeMesh merged(TreeMesh mesh, const TreeMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const glm::uvec3& t : other.leaf_triangles) mesh.leaf_triangles.push_back(t + first);
  for (const glm::uvec3& t : other.wood_triangles) mesh.wood_triangles.push_back(t + first);
  return mesh;
}

// `same(position)` of the centre of each cell of that side in the box from (-4, -4, 0) to (4, 4, 4).
template <typename Same>
void atEachCell(float h, const Same& same) {
  for (float x = -4.f + h / 2.f; x < 4.f; x += h)
    for (float y = -4.f + h / 2.f; y < 4.f; y += h)
      for (float z = h / 2.f; z < 4.f; z += h) same(glm::vec3(x, y, z));
}

// Two trees of one kind and one of another that stands in one of them.
struct TwoKinds {
  TreeMesh one = tree(), other = randomLeaves(200, .8f, .2f, {0.f, 0.f, 1.75f});
  std::array<BandOptics, 2> optics{BandOptics{LeafOptics{.1f, .05f}, LeafOptics{.4f, .3f}, LeafOptics{.05f, .02f}},
                                   BandOptics{LeafOptics{.45f, .4f}, LeafOptics{.2f, .25f}, LeafOptics{.3f, .6f}}};
  Stand stand{.trees = {{{-1.5f, .5f, .25f}}, {{1.25f, -2.f, 0.f}}, {.position = {-1.25f, 1.f, .25f}, .kind = 1}}};

  DensityGrid voxelized(const Stand& where) const {
    return DensityGrid::voxelizeStand(std::array{&one, &other}, where, .25f, optics);
  }
};

std::vector<float> allValues(const DensityGrid& grid) {
  std::vector<float> values;
  atEachCell(.25f, [&](glm::vec3 at) {
    const LeafOrientation m = grid.orientationAt(at);
    values.insert(values.end(), {grid.at(at), m.xx, m.yy, m.xy, m.xz, m.yz, grid.woodAt(at)});
  });
  return values;
}

}  // namespace

// Check that trees moved by whole cells make the grid of all their leaves. Error: a few roundings of floats, of values
// up to the largest; the moments', relative to 1, are those of sums that the densities' roundings weigh.
TEST(D2_DensityOfStand, IsThatOfAllLeavesWhereTreesAreMovedByWholeCells) {
  const TreeMesh one = tree();
  const glm::vec3 first(-1.5f, .5f, .25f), second(1.25f, -2.f, 0.f), third(2.f, -1.5f, .5f);
  const DensityGrid stand = DensityGrid::voxelizeStand(one, {.trees = {{first}, {second}, {third}}}, .25f);
  const DensityGrid all =
      DensityGrid::voxelize(merged(merged(moved(one, first), moved(one, second)), moved(one, third)), .25f);
  EXPECT_EQ(stand.occupiedCells(), all.occupiedCells());
  EXPECT_EQ(stand.occupied().low, all.occupied().low);
  EXPECT_EQ(stand.occupied().high, all.occupied().high);
  EXPECT_NEAR(stand.leafArea() / all.leafArea(), 1., 2e-7);
  atEachCell(.25f, [&](glm::vec3 at) {
    ASSERT_NEAR(stand.at(at), all.at(at), 4e-7f * all.at(at));
    const LeafOrientation m = stand.orientationAt(at), expected = all.orientationAt(at);
    ASSERT_NEAR(m.xx, expected.xx, 4e-7f);
    ASSERT_NEAR(m.xy, expected.xy, 4e-7f);
    ASSERT_NEAR(m.yz, expected.yz, 4e-7f);
  });
  EXPECT_NEAR(stand.projectedWoodArea() / (3. * DensityGrid::voxelize(one, .25f).projectedWoodArea()), 1., 2e-7);
}

// Check the cells of a leaf in one cell, moved by 1/4, 1/2 and 0 of its side: four cells by the volumes in common.
TEST(D2_DensityOfStand, SharesAMovedCellAmongThoseItOverlaps) {
  TreeMesh leaf;
  leaf.vertices = {{.25f, .25f, .5f}, {.75f, .25f, .5f}, {.25f, .75f, .5f}};
  leaf.leaf_triangles = {{0, 1, 2}};
  finish(leaf, "a leaf");
  const DensityGrid grid = DensityGrid::voxelizeStand(leaf, {.trees = {{{-7.75f, 2.5f, 16.f}}}}, 1.f);
  EXPECT_EQ(grid.occupiedCells(), 4u);
  EXPECT_FLOAT_EQ(grid.at({-7.5f, 2.5f, 16.5f}), .125f * .75f * .5f);
  EXPECT_FLOAT_EQ(grid.at({-7.5f, 3.5f, 16.5f}), .125f * .75f * .5f);
  EXPECT_FLOAT_EQ(grid.at({-6.5f, 2.5f, 16.5f}), .125f * .25f * .5f);
  EXPECT_FLOAT_EQ(grid.at({-6.5f, 3.5f, 16.5f}), .125f * .25f * .5f);
  EXPECT_EQ(grid.orientationAt({-6.5f, 3.5f, 16.5f}).zz(), 1.f);
}

// Check that a stand holds the area of all its trees wherever they stand, turned or not, alone or in a period that is
// longer or shorter than a tree is wide and no whole number of cells. Error: roundings of two floats for each cell.
TEST(D2_DensityOfStand, HoldsTheAreaOfAllTrees) {
  const TreeMesh one = tree();
  Stand stand{.trees = {{{.013f, -.7f, 0.f}, 0.f}, {{1.3f, .41f, -.2f}, .8f}, {{-2.2f, 3.3f, .3f}, -2.f}}};
  for (const float h : {.07f, .25f, 3.f})
    for (const glm::vec2 period : {glm::vec2(0.f), glm::vec2(5.03f, 6.3f), glm::vec2(1.7f, 4.f)}) {
      if (period.x > 0.f && h > std::min(period.x, period.y)) continue;  // refused
      stand.period = period.x > 0.f ? std::optional(period) : std::nullopt;
      const DensityGrid grid = DensityGrid::voxelizeStand(one, stand, h);
      EXPECT_NEAR(grid.leafArea() / (3. * leafArea(one)), 1., 2e-7) << h << " " << period.x;
      if (period.x == 0.f) continue;
      const glm::vec3 size = grid.occupied().size();  // at most the period, and what the last cells are longer
      EXPECT_LT(size.x, period.x + 1.001f * h);
      EXPECT_LT(size.y, period.y + 1.001f * h);
    }
}

// Check a tree turned by a right angle: x becomes y. The cosine of a right angle in floats is 4e-8 and not 0, which
// moves an edge of a leaf, all of them 300 * 0.8 m long, by 4e-8 m at most within its cell of 0.25 m: 1e-5 m^2 / h^3 at
// the very most.
TEST(D2_DensityOfStand, TurnsTreesCounterClockwise) {
  const TreeMesh one = tree();
  const DensityGrid turned =
      DensityGrid::voxelizeStand(one, {.trees = {{glm::vec3(0.f), std::numbers::pi_v<float> / 2.f}}}, .25f);
  const DensityGrid straight = DensityGrid::voxelize(one, .25f);
  double area = 0.;
  atEachCell(.25f, [&](glm::vec3 at) {
    const glm::vec3 there(-at.y, at.x, at.z);
    ASSERT_NEAR(turned.at(there), straight.at(at), 7e-4f);
    if (straight.at(at) > .1f) {
      ASSERT_NEAR(turned.orientationAt(there).yy, straight.orientationAt(at).xx, 1e-2f);
      area += 1.;
    }
  });
  EXPECT_GT(area, 100.);
}

// Check that what stands beyond the sides of a period enters at the opposite ones: each value is the sum over all
// periods. Error: rounding of floats.
TEST(D2_DensityOfStand, WrapsAPeriod) {
  const TreeMesh one = tree();
  const glm::vec2 period(1.25f, 3.f);
  const DensityGrid wrapped = DensityGrid::voxelizeStand(one, {.trees = {{}}, .period = period}, .25f);
  const DensityGrid single = DensityGrid::voxelize(one, .25f);
  std::size_t cells = 0;
  atEachCell(.25f, [&](glm::vec3 at) {
    if (wrapped.at(at) == 0.f) return;
    float sum = 0.f;
    for (int x = -3; x <= 3; ++x)
      for (int y = -1; y <= 1; ++y)
        sum += single.at(at + glm::vec3(static_cast<float>(x) * period.x, static_cast<float>(y) * period.y, 0.f));
    ASSERT_NEAR(wrapped.at(at), sum, 4e-7f * sum);
    ++cells;
  });
  EXPECT_EQ(cells, wrapped.occupiedCells());
}

// Check that the crown of a canopy that covers its period without a gap is the period, whatever part of the last cells
// lies within, so that leaf area over crown area is right. Error: rounding of the period to floats.
TEST(D2_DensityOfStand, CrownOfAClosedCanopyIsThePeriod) {
  TreeMesh sheet;
  sheet.vertices = {{-1.f, -2.f, 1.1f}, {1.f, -2.f, 1.1f}, {1.f, 2.f, 1.1f}, {-1.f, 2.f, 1.1f}};
  sheet.leaf_triangles = {{0, 1, 2}, {0, 2, 3}};
  finish(sheet, "a sheet");
  for (const float h : {.25f, .3f, .7f, 1.5f}) {
    const DensityGrid grid =
        DensityGrid::voxelizeStand(sheet, {.trees = {{{.2f, .1f, 0.f}}}, .period = glm::vec2(1.5f, 3.7f)}, h);
    EXPECT_NEAR(grid.crownArea(), 1.5 * 3.7, 1e-6) << h;
    EXPECT_NEAR(grid.leafArea(), 8., 2e-6) << h;
  }
}

// Check that threads change no bit, and the order of the trees only roundings of the sums, which show in the last digit
// of a float.
TEST(D2_DensityOfStand, DependsNeitherOnThreadsNorOnTheOrderOfTrees) {
  const TreeMesh one = tree();
  Stand stand;
  stand.trees.clear();
  for (int i = 0; i < 20; ++i)
    stand.trees.push_back({{.37f * static_cast<float>(i % 7) - 1.f, .29f * static_cast<float>(i % 5) - .5f, 0.f}});
  std::vector<float> values;
  for (const std::size_t threads : {1u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const std::vector<float> now = allValues(DensityGrid::voxelizeStand(one, stand, .25f));
    if (threads > 1) {
      EXPECT_EQ(now, values);
    }
    values = now;
  }
  std::reverse(stand.trees.begin(), stand.trees.end());
  const std::vector<float> reversed = allValues(DensityGrid::voxelizeStand(one, stand, .25f));
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(reversed[i], values[i], 3e-7f * std::max(1.f, values[i]));
}

// (D11) Check the optics of cells where trees of two kinds stand in each other: each cell has the mean over the leaf
// areas of both, which their grids apart tell; a cell of one kind alone that kind's. Error: roundings of floats.
TEST(D11_OpticsOfCells, AreMeansOverTheLeafArea) {
  const TwoKinds two;
  const DensityGrid grid = two.voxelized(two.stand);
  Stand apart = two.stand;
  apart.trees.pop_back();
  const DensityGrid first = DensityGrid::voxelizeStand(two.one, apart, .25f);
  apart.trees = {two.stand.trees.back()};
  apart.trees[0].kind = 0;
  const DensityGrid second = DensityGrid::voxelizeStand(two.other, apart, .25f);
  int mixed = 0, alone = 0;
  atEachCell(.25f, [&](glm::vec3 at) {
    const float a = first.at(at), b = second.at(at);
    const auto found = grid.opticsAt(at);
    ASSERT_EQ(found.has_value(), a + b > 0.f);
    if (!found) return;
    (a > 0.f && b > 0.f ? mixed : alone) += 1;
    for (std::size_t band = 0; band < kBands; ++band) {
      const LeafOptics &of_a = two.optics[0][band], &of_b = two.optics[1][band];
      ASSERT_NEAR((*found)[band].reflectance, (a * of_a.reflectance + b * of_b.reflectance) / (a + b), 4e-7f);
      ASSERT_NEAR((*found)[band].transmittance, (a * of_a.transmittance + b * of_b.transmittance) / (a + b), 4e-7f);
      if (a == 0.f || b == 0.f) {
        ASSERT_EQ((*found)[band], b == 0.f ? of_a : of_b);
      }
    }
  });
  EXPECT_GT(mixed, 50);
  EXPECT_GT(alone, 50);
}

// (D11) Check that the cells' optics weighted by their leaf area are those of all leaves, wherever the trees stand and
// turned or not, alone and in a period; that the order of trees and of kinds changes roundings alone; and that the
// density is that of a stand without optics. Error: roundings of floats, and of the cells' areas.
TEST(D11_OpticsOfCells, MakeUpThatOfAllLeaves) {
  TwoKinds two;
  two.stand.trees[0].rotation = .7f;
  two.stand.trees[2].position += glm::vec3(.013f, -.07f, .031f);
  for (const bool periodic : {false, true}) {
    if (periodic) two.stand.period = glm::vec2(2.53f, 3.1f);
    const DensityGrid grid = two.voxelized(two.stand);
    const double a = 2. * leafArea(two.one), b = leafArea(two.other);
    const BandOptics mean = grid.meanOptics().value();
    for (std::size_t band = 0; band < kBands; ++band) {
      const LeafOptics &of_a = two.optics[0][band], &of_b = two.optics[1][band];
      const auto weighted = [&](float of_one, float of_other) {
        return (a * static_cast<double>(of_one) + b * static_cast<double>(of_other)) / (a + b);
      };
      EXPECT_NEAR(mean[band].reflectance, weighted(of_a.reflectance, of_b.reflectance), 3e-7);
      EXPECT_NEAR(mean[band].transmittance, weighted(of_a.transmittance, of_b.transmittance), 3e-7);
    }
    Stand reversed = two.stand;
    std::reverse(reversed.trees.begin(), reversed.trees.end());
    for (Placement& tree : reversed.trees) tree.kind = 1 - tree.kind;
    const DensityGrid other = DensityGrid::voxelizeStand(std::array{&two.other, &two.one}, reversed, .25f,
                                                         std::array{two.optics[1], two.optics[0]});
    const DensityGrid without = DensityGrid::voxelizeStand(std::array{&two.one, &two.other}, two.stand, .25f);
    EXPECT_FALSE(without.meanOptics());
    atEachCell(.25f, [&](glm::vec3 at) {
      ASSERT_EQ(without.at(at), grid.at(at));
      ASSERT_NEAR(other.at(at), grid.at(at), 3e-7f * grid.at(at));
      if (const auto found = grid.opticsAt(at)) {
        ASSERT_NEAR((*found)[1].reflectance, (*other.opticsAt(at))[1].reflectance, 3e-7f);
        ASSERT_EQ(without.orientationAt(at).xy, grid.orientationAt(at).xy);
      }
    });
  }
}

// (D11) Check that optics are read back to the bit, that damage to them is found, and that the hash tells optics, kinds
// and places apart.
TEST(D11_OpticsOfCells, AreWrittenAndReadBack) {
  const TemporaryFolder folder;
  const TwoKinds two;
  const DensityGrid grid = two.voxelized(two.stand);
  grid.write(folder / "a.vdb", sourceNamed("two kinds"));
  grid.write(folder / "a.nvdb", sourceNamed("two kinds"));
  EXPECT_GT(fs::file_size(folder / "a.nvdb"), 0u);
  const DensityGrid read = DensityGrid::read(folder / "a.vdb");
  EXPECT_EQ(read.meanOptics(), grid.meanOptics());
  EXPECT_EQ(read.grids().size(), 1 + 5 + 6 + 1u);
  EXPECT_EQ(read.grids()[6].name, "reflectance_red");
  atEachCell(.25f, [&](glm::vec3 at) { ASSERT_EQ(read.opticsAt(at), grid.opticsAt(at)); });

  openvdb::io::File file((folder / "a.vdb").string());
  file.open(false);
  const auto grids = file.getGrids();
  EXPECT_EQ(file.readGrid("transmittance_blue")->metaValue<std::string>("unit_transmittance_blue"), "1");
  file.close();
  const auto changed = [&](const std::string& name, float value) {
    openvdb::GridPtrVec kept;
    for (const auto& one : *grids) {
      if (one->getName() == name && value < 0.f) continue;  // left out
      kept.push_back(one->deepCopyGrid());
      if (one->getName() == name)
        for (auto cell = openvdb::gridPtrCast<openvdb::FloatGrid>(kept.back())->beginValueOn(); cell; ++cell)
          cell.setValue(value);
    }
    openvdb::io::File out((folder / "b.vdb").string());
    out.write(kept);
    out.close();
    return refusal(folder / "b.vdb");
  };
  EXPECT_NE(changed("reflectance_blue", 1.5f).find("reflectance_blue of cell"), std::string::npos);
  EXPECT_NE(changed("reflectance_blue", .99f).find("must be at most 1 together"), std::string::npos);
  EXPECT_NE(changed("reflectance_blue", -1.f).find("holds no grid named \"reflectance_blue\""), std::string::npos);
  EXPECT_EQ(changed("reflectance_blue", .1f), "");

  const std::array kinds{&two.one, &two.other};
  std::set<std::string> hashes{standHash(kinds, two.stand), standHash(kinds, two.stand, two.optics),
                               standHash(std::array{&two.one, &two.one}, two.stand),
                               standHash(std::array{&two.one}, {})};
  Stand other = two.stand;
  other.trees[0].kind = 1;
  hashes.insert(standHash(kinds, other));
  EXPECT_EQ(hashes.size(), 5u);
}

TEST(D2_DensityOfStand, RefusesWhatCannotBe) {
  const TreeMesh one = tree();
  const auto refused = [&](const Stand& stand, float h, const std::string& part) {
    try {
      DensityGrid::voxelizeStand(one, stand, h);
      ADD_FAILURE() << part;
    } catch (const InvalidInput& wrong) {
      EXPECT_NE(std::string(wrong.what()).find(part), std::string::npos) << wrong.what();
    }
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  refused({.trees = {{}, {{0.f, nan, 0.f}}}}, .1f, "tree 1 position [m] = nan: must be finite");
  refused({.trees = {{{}, nan}}}, .1f, "tree 0 rotation = nan: must be finite");
  refused({.period = glm::vec2(1.f, 0.f)}, .1f, "period [m] = 0: must be above 0");
  refused({.period = glm::vec2(3.f, .09f)}, .1f, "cell size [m] = 0.1: must be at most a side of the period, 0.09");
  refused({.trees = std::vector<Placement>(1000), .period = glm::vec2(.01f)}, .01f,
          "period [m] = 0.01: must be so long that at most 2^24 trees reach into one period");
  refused({.trees = {{.kind = 1}}}, .1f, "tree 0 kind = 1: must be below the number of kinds, 1");
  refused({}, 0.f, "cell size [m] = 0: must be");
  refused({}, 1.9e-5f, "cell size [m] = 1.9e-05: must be from 2e-5 to 1e6");
  refused({.trees = {{}, {{1e6f, 0.f, 0.f}}}}, .5f, "so large that the stand spans at most 2^20 cells");
  // 400,000 trees of a thousand blocks: found before any of them is looked at.
  Stand wide{.trees = std::vector<Placement>(400'000)};
  for (std::size_t i = 0; i < wide.trees.size(); ++i)
    wide.trees[i].position = {static_cast<float>(i % 1000) * 4.f, static_cast<float>(i / 1000) * 4.f, 0.f};
  refused(wide, .02f, "so large that the grids take less memory: they would take ");
}
