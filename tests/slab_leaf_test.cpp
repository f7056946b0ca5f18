// The leaf as a slab of tissue, and the tissue behind what a leaf reflects and lets through.
#include "leaves/slab_leaf.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/require.hpp"
#include "render/reference/slab_trace.hpp"

namespace sunfleck {
namespace {

LeafTissue tissueBy(double albedo, double optical_thickness) {
  const double thickness = 0.2;
  return {.absorption = (1. - albedo) * optical_thickness / thickness,
          .scattering = albedo * optical_thickness / thickness,
          .thickness = thickness};
}

struct Known {
  double albedo, thickness, reflectance, transmittance;
};
// Three codes agree on these to 1e-12: slab_reference.csv of the shared references.
constexpr Known kKnown[] = {
    {0.5, 0.1, 0.0217329876768162, 0.926465099890762}, {0.5, 5., 0.11521778938071, 0.0129190943039746},
    {0.9, 1., 0.267410335069157, 0.591625089581466},   {0.95, 10., 0.53529778334737, 0.0190813803489164},
    {1., 1., 0.341328759800089, 0.658671240197475},    {1., 10., 0.853004619206793, 0.146995380795806}};

// Check the slab against what three other codes agree on.
TEST(L8_SlabLeaf, MeetsTheReference) {
  for (const Known& known : kKnown) {
    const SlabLeaf leaf = slabLeaf(tissueBy(known.albedo, known.thickness));
    // 32 directions, black ground: 2e-7 at most, measured against 128 directions.
    EXPECT_NEAR(leaf.sides.reflectance, known.reflectance, 2e-7) << known.albedo << " " << known.thickness;
    EXPECT_NEAR(leaf.sides.transmittance, known.transmittance, 2e-7) << known.albedo << " " << known.thickness;
    // The paper's form, with its A and B.
    EXPECT_NEAR(leaf.sides.reflectance, 0.5 * leaf.a * known.albedo, 1e-14);
    EXPECT_NEAR(leaf.sides.transmittance, std::exp(-known.thickness) + 0.5 * leaf.b * known.albedo, 1e-14);
  }
}

// Check that reflectance, transmittance and what is absorbed by the mean intensity within are all the light.
TEST(L8_SlabLeaf, ConservesEnergy) {
  for (const double albedo : {0., 1e-6, 0.3, 0.9, 0.999999, 1.})
    for (const double thickness : {0., 1e-13, 1e-6, 0.01, 1., 10., 1e3, 1e5}) {
      const SlabLeaf leaf = slabLeaf(tissueBy(albedo, thickness));
      EXPECT_NEAR(leaf.sides.reflectance + leaf.sides.transmittance + leaf.absorptance, 1., 1e-10)
          << albedo << " " << thickness;
      EXPECT_GE(leaf.sides.reflectance, 0.);
      EXPECT_GE(leaf.sides.transmittance, leaf.direct - 1e-12);
    }
}

// Check against Monte Carlo inside the slab, which shares no code with it.
TEST(L8_SlabLeaf, AgreesWithMonteCarlo) {
  for (const auto& [albedo, thickness] : {std::pair{0.97, 3.}, {0.995, 12.}, {0.4, 0.7}}) {
    const SlabLeaf leaf = slabLeaf(tissueBy(albedo, thickness));
    const SlabTraceResult traced =
        traceSlab({.asymmetry = 0., .albedo = albedo, .thickness = thickness, .mu0 = 1.}, {}, {.paths = 100'000});
    // Six z-tests at a fixed seed.
    EXPECT_NEAR(leaf.sides.reflectance, traced.reflectance.value, 4. * traced.reflectance.standard_error);
    EXPECT_NEAR(leaf.sides.transmittance, traced.transmittance.value, 4. * traced.transmittance.standard_error);
  }
}

// Check what the paper's figure 7 shows: a thicker leaf reflects more and lets less through, and more absorption does
// less of both; A and B change with each, where the paper keeps them.
TEST(L8_SlabLeaf, FollowsThicknessAndAbsorption) {
  const LeafTissue tissue = tissueBy(0.97, 3.);
  LeafTissue thicker = tissue, darker = tissue;
  thicker.thickness *= 2.;
  darker.absorption *= 3.;
  const SlabLeaf leaf = slabLeaf(tissue), thick = slabLeaf(thicker), dark = slabLeaf(darker);
  EXPECT_GT(thick.sides.reflectance, leaf.sides.reflectance);
  EXPECT_LT(thick.sides.transmittance, leaf.sides.transmittance);
  EXPECT_LT(dark.sides.reflectance, leaf.sides.reflectance);
  EXPECT_LT(dark.sides.transmittance, leaf.sides.transmittance);
  EXPECT_GT(std::abs(thick.a - leaf.a), 0.01);
  EXPECT_GT(std::abs(dark.b - leaf.b), 0.01);
}

// Check that the tissue is found again over all that leaves can be, and that it has what was measured.
TEST(L9_TissueOf, FindsTheTissue) {
  std::vector<LeafTissue> truths;
  std::vector<LeafSides> measured;
  for (const double albedo : {0.05, 0.3, 0.7, 0.9, 0.97, 0.99, 0.999})
    for (const double thickness : {0.02, 0.1, 0.5, 1., 3., 8.}) {
      const SlabLeaf leaf = slabLeaf(tissueBy(albedo, thickness));
      if (leaf.sides.transmittance < 1e-3) continue;
      truths.push_back(tissueBy(albedo, thickness));
      measured.push_back(leaf.sides);
    }
  const std::vector<TissueFit> fits = tissueOf(measured, 0.2);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    EXPECT_LT(fits[i].residual, 1e-9) << i;
    // 16 directions here and 32 there differ by 5e-6 of the light; in thin leaves that is 1e-3 of what they scatter.
    const double all = truths[i].absorption + truths[i].scattering;
    EXPECT_NEAR(fits[i].tissue.absorption, truths[i].absorption, 2e-3 * all) << i;
    EXPECT_NEAR(fits[i].tissue.scattering, truths[i].scattering, 2e-3 * all) << i;
    const SlabLeaf again = slabLeaf(fits[i].tissue);
    EXPECT_NEAR(again.sides.reflectance, measured[i].reflectance, 1e-5) << i;
    EXPECT_NEAR(again.sides.transmittance, measured[i].transmittance, 1e-5) << i;
  }
}

// Check every pair that a leaf can have, at random and at the edges: nothing absorbed, nothing reflected, all passed.
TEST(L9_TissueOf, ReachesAllThatLeavesCanBe) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0., 1.);
  std::vector<LeafSides> measured{{0., 1.},       {0., 0.5},   {0., 1e-4},  {0.5, 0.5},       {0.999, 1e-3},
                                  {0.9999, 1e-4}, {1e-9, 0.3}, {0.3, 1e-4}, {1e-6, 1. - 1e-6}};
  for (int i = 0; i < 2000; ++i) {
    const double reflectance = share(random);
    measured.push_back({.reflectance = reflectance, .transmittance = std::max(share(random) * (1. - reflectance), 0.)});
  }
  std::erase_if(measured, [](const LeafSides& sides) { return sides.transmittance < 1e-4; });
  const std::vector<TissueFit> fits = tissueOf(measured, 1.);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    EXPECT_LT(fits[i].residual, 1e-8) << i << ": " << measured[i].reflectance << " " << measured[i].transmittance;
    EXPECT_TRUE(fits[i].tissue.absorption >= 0. && fits[i].tissue.scattering >= 0.) << i;
  }
}

// Check a noisy map: what is found scatters about the truth as first-order errors say, without a bias beyond them.
TEST(L9_TissueOf, FollowsNoise) {
  const LeafTissue truth = tissueBy(0.95, 3.);
  const SlabLeaf leaf = slabLeaf(truth);
  constexpr double kNoise = 1e-3;
  // Slopes of the tissue by what is measured, by differences.
  const auto at = [&](double dr, double dt) {
    return tissueOf(std::vector{LeafSides{leaf.sides.reflectance + dr, leaf.sides.transmittance + dt}}, 0.2)[0].tissue;
  };
  const double by_r = (at(1e-4, 0.).absorption - at(-1e-4, 0.).absorption) / 2e-4,
               by_t = (at(0., 1e-4).absorption - at(0., -1e-4).absorption) / 2e-4;
  const double stated = kNoise * std::hypot(by_r, by_t);
  std::mt19937 random(9);
  std::normal_distribution<double> error(0., kNoise);
  constexpr int kPlaces = 2000;
  std::vector<LeafSides> measured;
  for (int i = 0; i < kPlaces; ++i)
    measured.push_back({leaf.sides.reflectance + error(random), leaf.sides.transmittance + error(random)});
  double sum = 0., squares = 0.;
  for (const TissueFit& fit : tissueOf(measured, 0.2)) {
    sum += fit.tissue.absorption - truth.absorption;
    squares += std::pow(fit.tissue.absorption - truth.absorption, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kPlaces), stated, 0.07 * stated);  // four deviations of a deviation of 2000: 6.3 %
  EXPECT_NEAR(sum / kPlaces, 0., 0.12 * stated);                     // four of a mean: 9 %, and second order
}

// Check that threads change nothing, to the bit.
TEST(L9_TissueOf, IsTheSameForAnyThreads) {
  std::vector<LeafSides> measured;
  for (int i = 0; i < 500; ++i) measured.push_back({0.001 * i, 0.4});
  const auto all = tissueOf(measured, 0.2);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto alone = tissueOf(measured, 0.2);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].tissue, alone[i].tissue) << i;
    EXPECT_EQ(all[i].residual, alone[i].residual) << i;
  }
}

// Check that what no leaf can be is refused, with the place.
TEST(L9_TissueOf, RefusesWhatIsNoLeaf) {
  const auto message = [](std::vector<LeafSides> measured, double thickness) -> std::string {
    try {
      tissueOf(measured, thickness);
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "";
  };
  const double nan = std::nan("");
  EXPECT_EQ(message({{0.5, 0.75}}, 0.2), "reflectance + transmittance = 1.25: must be at most 1");
  EXPECT_EQ(message({{0.5, 0.25}, {-0.5, 0.25}}, 0.2), "reflectance at 1 = -0.5: must be in [0, 1]");
  EXPECT_EQ(message({{0.5, 0.}}, 0.2), "transmittance = 0: must be in [1e-4, 1]");
  EXPECT_EQ(message({{nan, 0.5}}, 0.2), "reflectance = nan: must be in [0, 1]");
  EXPECT_EQ(message({{0.5, 0.25}}, 0.), "thickness = 0: must be above 0, at most 1000 mm");
  EXPECT_EQ(message({}, 0.2), "");
  EXPECT_THROW(slabLeaf({.absorption = -1.}), InvalidInput);
  EXPECT_THROW(slabLeaf({.scattering = nan}), InvalidInput);
  EXPECT_THROW(slabLeaf({.thickness = std::numeric_limits<double>::infinity()}), InvalidInput);
}

}  // namespace
}  // namespace sunfleck
