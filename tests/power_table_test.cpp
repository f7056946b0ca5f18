// Check tables of powers over depth and thickness: of the exact solution against its own fluxes, of refined SPP where
// it is exact.
#include "spp/power_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "pp_solver/solver.hpp"
#include "render/compare/exact_powers.hpp"

using namespace sunfleck;

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

// Light that leaves meet, without the direct, by the solver's fluxes: (P+ + P-) / 2.
double diffuseIrradiance(const LeafOptics& leaf, double depth, double thickness) {
  pp::Solver solver;
  solver.solve(
      {.layers = {{.thickness = 2. * thickness, .medium = spp::sphericalLeaves(leaf).medium}}, .beam = pp::Beam{}});
  const pp::Fluxes fluxes = solver.fluxes(2. * depth);
  return fluxes.leaf_irradiance - 0.5 * fluxes.direct;
}

}  // namespace

// Check the exact table between its nodes against the solver, as far as crowns are thick. Interpolation was off by
// 0.003 at most and 7e-4 in the root of the mean square, of light of power 1.
TEST(R27_PowerTable, IsTheExactSolution) {
  for (const LeafOptics leaf : {LeafOptics{.reflectance = 0.475f, .transmittance = 0.475f},
                                LeafOptics{.reflectance = 0.7f, .transmittance = 0.3f}}) {
    const spp::PowerTable table = exactPowerTable(leaf);
    Random random(1, 0);
    double squares = 0.;
    constexpr int kPlaces = 300;
    for (int i = 0; i < kPlaces; ++i) {
      const float thickness = std::exp(5.f * random.uniform() - 1.5f), depth = thickness * random.uniform();
      const spp::SlabPowers found = table.at(depth, thickness);
      const double expected = diffuseIrradiance(leaf, double{depth}, double{thickness});
      const double error = 0.5 * double{found.down + found.up} - expected;
      EXPECT_NEAR(error, 0., 4e-3) << depth << " of " << thickness;
      squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / kPlaces), 1e-3);
  }
}

// Check the corners: no slab, one without end, places outside. A black leaf scatters nothing; in a slab without end
// that absorbs, no light is left far down, and at the lit face there is most.
TEST(R27_PowerTable, HoldsAllThicknesses) {
  const spp::PowerTable table = exactPowerTable({.reflectance = 0.4f, .transmittance = 0.4f});
  EXPECT_EQ(table.at(0.f, 0.f).down, 0.f);
  EXPECT_EQ(table.at(0.f, 0.f).up, 0.f);
  EXPECT_EQ(table.at(kInfinite, kInfinite).down, 0.f);
  EXPECT_NEAR(table.at(1e4f, kInfinite).down, 0.f, 1e-3f);
  EXPECT_NEAR(table.at(0.f, kInfinite).up, table.at(0.f, 200.f).up, 1e-3f);
  EXPECT_EQ(table.at(-1.f, 3.f).up, table.at(0.f, 3.f).up);
  EXPECT_EQ(table.at(9.f, 3.f).down, table.at(3.f, 3.f).down);
  EXPECT_EQ(table.at(3.f, 3.f).up, 0.f);  // on black ground
  const spp::PowerTable black = exactPowerTable({.reflectance = 0.f, .transmittance = 0.f});
  EXPECT_TRUE(std::ranges::all_of(black.nodes, [](const spp::SlabPowers& p) { return p.down == 0.f && p.up == 0.f; }));
}

// Check that refined SPP is exact for light that is scattered once, whatever SPP makes of it: with leaves that scatter
// a hundredth, what was scattered twice is no more than a hundredth of that.
TEST(S15_RefinedPowers, AreExactForLightScatteredOnce) {
  const LeafOptics leaf{.reflectance = 0.008f, .transmittance = 0.002f};
  const spp::PowerTable refined = spp::refinedPowerTable(leaf), exact = exactPowerTable(leaf);
  double most = 0.;
  for (const float thickness : {0.3f, 2.f, 10.f})
    for (const float part : {0.1f, 0.5f, 0.9f}) {
      const spp::SlabPowers a = refined.at(part * thickness, thickness), b = exact.at(part * thickness, thickness);
      EXPECT_NEAR(a.down, b.down, 1e-4f);
      EXPECT_NEAR(a.up, b.up, 1e-4f);
      most = std::max(most, double{b.up});
    }
  EXPECT_GT(most, 3e-3);
}
