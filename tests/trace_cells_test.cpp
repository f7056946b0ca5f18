#include "render/reference/trace_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/require.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/trace_run.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

TraceSums traced(const ForwardJob& job, std::uint64_t units) {
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.wanted = {0, units}}, sums);
  return sums;
}

}  // namespace

// Check that a leaf and a plank, each alone in a cell, absorb there what they absorb in all: of one the half of the
// light that meets it, of the other three quarters of the other half; and where those cells are, also far from the
// origin.
TEST(R1_TraceCells, LightIsAbsorbedWhereItsAbsorbersAre) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0.5f, 0.5f, 1}, {.5f, 0, 0}, {0, .5f, 0}));
  addPolygon(mesh, mesh.wood_triangles, rectangle({1.5f, 0.5f, 3}, {.5f, 0, 0}, {0, .5f, 0}));
  finish(mesh, "leaf and plank");
  for (const glm::vec3& place : {glm::vec3(0.f), glm::vec3(8192.f, -512.f, 64.f)}) {
    const RayScene scene(mesh, {.trees = {{.position = place}}}, true);
    const TraceLight light{.leaf = {0.f, 0.f}, .wood_reflectance = 0.25f};
    const TraceCells cells(scene, 1., 1);
    ASSERT_EQ(cells.count(), 4u);
    const ForwardJob job(scene, {light}, 256, {.cells = cells});
    const TraceSums sums = traced(job, 100);
    const ForwardResult whole = job.results(sums).front();
    const std::vector<CellAbsorption> met = job.cells(sums, 0);
    ASSERT_EQ(met.size(), 2u);
    for (const CellAbsorption& cell : met) {
      const bool of_leaf = cells.place(cell.cell) == glm::uvec3(0, 0, 0);
      EXPECT_TRUE(of_leaf || cells.place(cell.cell) == glm::uvec3(1, 0, 1));
      EXPECT_EQ(cell.leaves.value, of_leaf ? whole.absorbed_leaves.value : 0.);
      EXPECT_EQ(cell.wood.value, of_leaf ? 0. : whole.absorbed_wood.value);
      EXPECT_EQ(cell.wood.standard_error, of_leaf ? 0. : whole.absorbed_wood.standard_error);
      EXPECT_NEAR(cell.leaves.value + cell.wood.value, of_leaf ? 0.5 : 0.375,
                  5. * std::hypot(cell.leaves.standard_error, cell.wood.standard_error));
      EXPECT_EQ(cells.size(cell.cell), glm::dvec3(1.));
    }
    EXPECT_EQ(cells.corner(), glm::dvec3(place) + glm::dvec3(0., 0., 1.));
    EXPECT_DOUBLE_EQ(job.incidentFlux(0), 2.);
  }
}

// Check that cells of any size hold together all that is absorbed, of each band, in a periodic stand and in one that is
// not. With one band all weights are whole multiples of 2^-50 and nothing is rounded until they are told and added
// here, each of some hundred times by 1.1e-16 of the sum; with several a path's weight in the darker ones may be small,
// and each sum is rounded, to 1e-16, as often as light is absorbed.
TEST(R1_TraceCells, HoldAllThatIsAbsorbed) {
  TreeMesh mesh = leafBox(80, 3);
  addPolygon(mesh, mesh.wood_triangles, rectangle({0, 0, -0.3f}, {0.4f, 0, 0}, {0, 0.3f, 0.1f}));
  finish(mesh, "leaves and a plank");
  const std::vector<TraceLight> bands{
      {.sun = sunlight(0.6f, 1.f), .leaf = {.reflectance = 0.4f, .transmittance = 0.3f}},
      {.sun = sunlight(0.6f, 1.f), .leaf = {.reflectance = 0.05f, .transmittance = 0.01f}, .wood_reflectance = 0.1f}};
  for (const std::optional<glm::vec2>& period : {std::optional<glm::vec2>(), std::optional(glm::vec2(1.7f, 1.1f))})
    for (const double side : {0.13, 0.5, 3.})
      for (const std::size_t count : {1u, 2u}) {
        const RayScene scene(mesh, {.period = period}, true);
        const ForwardJob job(scene, {bands.begin(), bands.begin() + static_cast<std::ptrdiff_t>(count)}, 128,
                             {.cells = TraceCells(scene, side, count)});
        const TraceSums sums = traced(job, 40);
        for (std::size_t band = 0; band < count; ++band) {
          double leaves = 0., wood = 0.;
          for (const CellAbsorption& cell : job.cells(sums, band)) {
            leaves += cell.leaves.value;
            wood += cell.wood.value;
          }
          const ForwardResult result = job.results(sums)[band];
          const double rounding = count == 1 ? 1e-14 : 1e-13;
          EXPECT_GT(wood, 0.);
          EXPECT_NEAR(leaves, result.absorbed_leaves.value, rounding * leaves);
          EXPECT_NEAR(wood, result.absorbed_wood.value, rounding * wood);
        }
      }
}

// Check that cells fill one period, the last of a row narrower, and that they change nothing else that a trace finds.
TEST(R1_TraceCells, FillThePeriod) {
  const TreeMesh mesh = leafBox(30, 2);
  const RayScene scene(mesh, {.period = glm::vec2(1.7f, 1.1f)}, true);
  const TraceCells cells(scene, 0.5, 1);
  double volume = 0.;
  for (std::size_t cell = 0; cell < cells.count(); ++cell) {
    const glm::dvec3 size = cells.size(cell);
    volume += size.x * size.y * size.z;
  }
  EXPECT_EQ(cells.count() % 12, 0u);                                                     // 4 by 3
  EXPECT_NEAR(volume, 1.7 * 1.1 * 0.5 * static_cast<double>(cells.count() / 12), 1e-6);  // sides of single precision
  const TraceLight light{.sun = sunlight(0.6f, 1.f)};
  const ForwardJob with(scene, {light}, 64, {.cells = cells}), without(scene, {light}, 64);
  EXPECT_EQ(with.results(traced(with, 20)).front().leaf_irradiance,
            without.results(traced(without, 20)).front().leaf_irradiance);
  const ForwardJob bare(scene, {light}, 64, {.leaves = false});
  const ForwardResult result = bare.results(traced(bare, 20)).front();
  EXPECT_TRUE(result.leaf_irradiance.empty());
  EXPECT_EQ(result.absorbed_leaves.value, without.results(traced(without, 20)).front().absorbed_leaves.value);
  EXPECT_EQ(with.identity().at("side of the cells"), "0.5");
  EXPECT_FALSE(without.identity().contains("side of the cells"));
}

TEST(R1_TraceCells, RefuseTooManyAndNone) {
  const TreeMesh mesh = leafBox(5, 1);
  const RayScene scene(mesh, Stand{}, true);
  EXPECT_THROW(TraceCells(scene, 0., 1), InvalidInput);
  EXPECT_THROW(TraceCells(scene, -1., 1), InvalidInput);
  EXPECT_THROW(TraceCells(scene, std::nan(""), 1), InvalidInput);
  EXPECT_THROW(TraceCells(scene, 1e-5, 1), InvalidInput);
  EXPECT_THROW(TraceCells(scene, 0.01, 16), InvalidInput);
}
