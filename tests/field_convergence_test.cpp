// Check that the field comes nearer to the truth with everything that makes it finer, one at a time, as far as that can
// bring it; and that among ever smaller leaves it comes to the light of a medium.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "field/clumping.hpp"
#include "field/grid_field.hpp"
#include "field/leaf_field.hpp"
#include "plants/random_leaves.hpp"
#include "pp_solver/solver.hpp"
#include "render/reference/forward_trace.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;

namespace {

constexpr LeafOptics kLeaf{.reflectance = 0.6f, .transmittance = 0.35f};
const Direction kSun = sunlight(0.5f, 0.3f);
constexpr DirectEffort kFineDirect{.pixels = 2000.f};  // less than 1 % off per leaf: less than what is judged

// A tree and what Monte Carlo finds of it.
struct Judge {
  std::shared_ptr<const TreeMesh> mesh;
  ForwardResult truth;

  Judge(TreeMesh of, std::uint64_t paths)
      : mesh(std::make_shared<const TreeMesh>(std::move(of))),
        truth(traceForward(RayScene(*mesh, {}, true), {.sun = kSun, .leaf = kLeaf}, {.paths = paths})) {}

  // RMS over leaves of the error of both sides' light, relative to the light, without what is Monte Carlo's.
  template <typename Light>
  double error(const Light& ofLeaf) const {
    double squares = 0., all = 0.;
    for (std::size_t i = 0; i < truth.leaf_irradiance.size(); ++i) {
      const double expected = truth.leaf_irradiance[i], noise = truth.leaf_standard_error[i];
      squares += std::pow(double{ofLeaf(i)} - expected, 2) - noise * noise;
      all += expected * expected;
    }
    return std::sqrt(std::max(squares, 0.) / all);
  }

  double ofLines(const FieldEffort& effort) const {
    LeafField field(effort);
    field.setStand(std::array{mesh}, Stand{});
    FieldLighting lighting{.suns = {{.along = kSun}}, .kinds = {FieldKind{}}};
    lighting.kinds[0].leaf.fill(kLeaf);
    const FieldResult& result = field.solve(lighting);
    EXPECT_TRUE(result.converged);
    return error([&](std::size_t i) {
      const LeafLight& leaf = result.trees[0][i];
      return leaf.direct[0].front + leaf.direct[0].back + leaf.scattered[0].front + leaf.scattered[0].back;
    });
  }

  double ofCells(int cells) const {
    const FieldElements elements = fieldElements(*mesh, {.least_flatness = 0.f, .largest_extent = 1e9f});
    const PlacedElements tree{.mesh = mesh.get(), .elements = &elements};
    CellMedium medium = cellMedium({&tree, 1}, {.cells = cells});
    const float omega = clumping(*mesh, medium);
    GridField field(std::move(medium), std::array{omega});
    const float dark = 0.f;
    const GridSolution found = field.solve({.optics = {{{.leaf = kLeaf}}},
                                            .direct = directLight(*mesh, elements, {}, kSun, kFineDirect).irradiance,
                                            .entering = field.evenSky({&dark, 1}, {&dark, 1}, {})});
    EXPECT_TRUE(found.told.empty()) << found.told;
    std::vector<float> sums(elements.size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = found.irradiance[2 * i] + found.irradiance[2 * i + 1];
    const std::vector<float> of_leaves = leafMeans(elements, mesh->leaf_count, sums);
    return error([&](std::size_t leaf) { return of_leaves[leaf]; });
  }
};

// Squares at random whose sides are cut into so many parts.
TreeMesh largeLeaves(int parts) {
  Random random(3, 0);
  TreeMesh mesh;
  for (int leaf = 0; leaf < 60; ++leaf) {
    const Axes axes = axesAlong(shapes::onSphere(random));
    const glm::vec3 centre(random.uniform(), random.uniform(), random.uniform());
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size()), row = static_cast<std::uint32_t>(parts) + 1;
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; j <= parts; ++j) {
        const glm::vec2 place = glm::vec2(i, j) / static_cast<float>(parts) - 0.5f;
        mesh.vertices.push_back(centre + 0.4f * (place.x * axes.right + place.y * axes.up));
      }
    for (std::uint32_t i = 0; i + 1 < row; ++i)
      for (std::uint32_t j = 0; j + 1 < row; ++j) {
        const std::uint32_t corner = first + i * row + j;
        mesh.leaf_triangles.emplace_back(corner, corner + row, corner + row + 1);
        mesh.leaf_triangles.emplace_back(corner, corner + row + 1, corner + 1);
      }
  }
  finish(mesh, "large leaves");
  return mesh;
}

const Judge& crown() {
  static const Judge of(randomCrown({.size = {1.f, 1.f, 1.5f}, .leaf_side = 0.05f, .leaves = 2000}, 1), 4'000'000);
  return of;
}

}  // namespace

// Check that with four times the directions, or lines in each, the error of single leaves falls. That of random lines
// would be half as large. What lines do not change remains: they take light as even on a leaf. So the first step is
// asked to take off a quarter, the second anything. A twentieth at the end is the aim for what is used by default.
TEST(F4_LeafField, FinerLinesConverge) {
  for (const bool axes : {true, false}) {
    SCOPED_TRACE(axes ? "axes" : "crossings");
    std::vector<double> errors;
    for (const int finer : {1, 4, 16}) {
      FieldEffort effort{.exchange = {.axes = 16, .crossings = 1.f}, .direct = kFineDirect};
      if (axes)
        effort.exchange.axes *= finer;
      else
        effort.exchange.crossings *= static_cast<float>(finer);
      errors.push_back(crown().ofLines(effort));
    }
    EXPECT_LT(errors[1], 0.75 * errors[0]);
    EXPECT_LT(errors[2], errors[1]);
    EXPECT_LT(errors[2], 0.05);
  }
}

// Check that with triangles of half the side the error falls, where it is that of light taken as even on an element:
// with leaves as large as their distances and fine lines. It would be half as large; 0.6 leaves room for noise.
TEST(F1_FieldElements, FinerElementsConverge) {
  const auto error = [](int parts, float flatness) {
    return Judge(largeLeaves(parts), 2'000'000)
        .ofLines({.elements = {.least_flatness = flatness, .largest_extent = 1e9f},
                  .exchange = {.axes = 256, .crossings = 64.f},
                  .direct = kFineDirect});
  };
  double before = error(1, 0.f);  // whole leaves
  for (const int parts : {1, 2, 4}) {
    const double found = error(parts, 1.1f);
    EXPECT_LT(found, parts == 1 ? before : 0.6 * before) << parts;
    before = found;
  }
  EXPECT_LT(before, 0.02);
}

// Check that smaller cells come nearer, down to those of a leaf's size (24 along 1.5 m of leaves of 0.05 m). What
// remains is that it is not known where in a cell a leaf stands.
TEST(F17_GridField, FinerCellsConverge) {
  double before = 1.;
  for (const int cells : {2, 4, 8, 16, 24}) {
    const double found = crown().ofCells(cells);
    EXPECT_LT(found, before) << cells;
    before = found;
  }
  EXPECT_LT(before, 0.08);
}

// Check that the light that a layer of leaves sends up and absorbs becomes that of a medium of such leaves (P20, P21)
// as they become smaller, under two suns: leaves of half the side are half as far off (that is as far as a leaf's
// neighbours know of its shadow); 0.8 leaves room for chance. In the end it is within 0.4 % of the light: of that,
// lines that return where they came from make up to 0.2 %, chance some 0.1 %.
TEST(F4_LeafField, SmallLeavesBecomeAMedium) {
  double before = 1.;
  // As many leaves in all, or more.
  for (const auto& [side, layers] : {std::pair(0.2f, 16), std::pair(0.05f, 4), std::pair(0.025f, 1)}) {
    double squares = 0.;
    for (const float zenith : {0.f, 0.9f}) {
      FieldLighting lighting{.suns = {{.along = sunlight(zenith, 0.3f)}}, .kinds = {FieldKind{}}};
      lighting.kinds[0].leaf.fill(kLeaf);
      double up = 0., absorbed = 0.;
      for (int seed = 1; seed <= layers; ++seed) {
        const RandomLayer layer{.leaf_side = side, .leaf_area_index = 4.f};
        LeafField field({.exchange = {.axes = 128, .crossings = 2.f}});
        field.setStand(std::array{std::shared_ptr<const TreeMesh>(
                           std::make_shared<TreeMesh>(randomLayer(layer, static_cast<std::uint64_t>(seed))))},
                       Stand{.period = layer.size});
        const FieldBalance& balance = field.solve(lighting).balance[0];
        up += balance.out_up / balance.in / layers;
        absorbed += balance.absorbed_leaves / balance.in / layers;
      }
      pp::Solver solver({.streams = 32});
      solver.solve({.layers = {{.thickness = 4.,
                                .medium = LeafScattering{.reflectance = double{kLeaf.reflectance},
                                                         .transmittance = double{kLeaf.transmittance}}}},
                    .beam = pp::Beam{.mu0 = std::cos(double{zenith})}});
      squares += std::pow(up - solver.reflectance(), 2) + std::pow(absorbed - solver.absorptance(), 2);
    }
    const double off = std::sqrt(squares);
    EXPECT_LT(off, 0.5 * before) << side;
    before = off;
  }
  EXPECT_LT(before, 0.004);
}
