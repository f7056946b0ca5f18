// Check that the hot spot has its limits, agrees with discs thrown at random and with traced canopies, and stays
// finite.
#include "pp_solver/hot_spot.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::pp;
using pp::ScatteredOnce;
constexpr double kPi = std::numbers::pi;

TEST(P22_HotSpot, VanishesForSmallLeaves) {
  const pp::SunAndView at{.thickness = 3., .mu0 = 0.8, .mu = 0.5, .azimuth = 1.};
  LeafScattering leaves{.reflectance = 0.4, .transmittance = 0.3};
  EXPECT_EQ(hotSpotExcess(leaves, at).leaves, 0.);
  EXPECT_EQ(hotSpotExcess(leaves, at).gap, 0.);
  // In proportion to the size, where paths part at once: the square adds 1e-6 of it.
  leaves.hot_spot = 1e-6;
  const ScatteredOnce one = hotSpotExcess(leaves, at);
  leaves.hot_spot = 2e-6;
  const ScatteredOnce two = hotSpotExcess(leaves, at);
  EXPECT_GT(one.leaves, 0.);
  EXPECT_NEAR(two.leaves / one.leaves, 2., 1e-5);
  EXPECT_NEAR(two.gap / one.gap, 2., 1e-5);
  leaves.hot_spot = 1e-300;
  EXPECT_LT(hotSpotExcess(leaves, at).leaves, 1e-290);
}

// Looking back at the sun each ray returns by its own gap: e^(-K L) and not its square.
TEST(P22_HotSpot, IsWholeWhereTheViewMeetsTheSun) {
  for (double mu : {1., 0.6, 0.05})
    for (double thickness : {0.01, 3., 400.}) {
      const LeafScattering leaves{.reflectance = 0.4, .transmittance = 0.3, .hot_spot = 0.1};
      const pp::SunAndView at{.thickness = thickness, .mu0 = mu, .mu = mu, .azimuth = kPi};
      const ScatteredOnce turbid = scatteredOnceTurbid(leaves, at), excess = hotSpotExcess(leaves, at);
      const double K = 0.5 / mu, turn = leafScattering(leaves, -mu, mu, kPi);
      EXPECT_NEAR(turbid.gap + excess.gap, std::exp(-K * thickness), 1e-14);
      // cos(pi / 2) is 6e-17 and not 0: the paths part a little.
      EXPECT_NEAR((turbid.leaves + excess.leaves) / (turn * -std::expm1(-K * thickness) / K / mu), 1., 1e-12);
    }
}

// The integral over the layer by an adaptive rule, for paths from nearly one to far apart.
TEST(P22_HotSpot, IntegratesTheLayer) {
  for (double hot_spot : {1e-4, 0.02, 10.})
    for (double thickness : {0.1, 2., 50.})
      for (double mu : {0.1, 0.7})
        for (double azimuth : {2.9, kPi}) {
          const LeafScattering leaves{.reflectance = 0.4, .transmittance = 0.3, .hot_spot = hot_spot};
          const double mu0 = 0.7, K0 = 0.5 / mu0, K = 0.5 / mu;
          const double tan0 = std::sqrt(1. - mu0 * mu0) / mu0, tan = std::sqrt(1. - mu * mu) / mu;
          const double apart =
              std::sqrt(std::max(0., tan * tan + tan0 * tan0 - 2. * tan * tan0 * std::cos(azimuth - kPi)));
          const double a = apart / (4. / (3. * kPi) * hot_spot * thickness);
          const auto integrand = [&](double depth) {
            const double shared =
                a > 1e-6 ? std::sqrt(K * K0) * (1. - std::exp(-a * depth)) / a : std::sqrt(K * K0) * depth;
            return std::exp(-(K + K0) * depth + shared) - std::exp(-(K + K0) * depth);
          };
          double wanted = 0., from = 0.;
          for (double to : {1e-5, 1e-4, 1e-3, 0.01, 0.1, 1., 5., 50.}) {
            to = std::min(to, thickness);
            if (to > from)
              wanted += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, from, to, 12, 1e-12);
            from = to;
          }
          const pp::SunAndView at{thickness, mu0, mu, azimuth};
          // 1e-13 is the cancellation in this test's own integrand.
          const double found = hotSpotExcess(leaves, at).leaves / leafScattering(leaves, -mu, mu0, azimuth) * mu;
          EXPECT_NEAR(found, wanted, 1e-10 * wanted + 1e-13)
              << hot_spot << " " << thickness << " " << mu << " " << azimuth;
        }
}

TEST(P22_HotSpot, IsReciprocal) {
  const LeafScattering leaves{
      .angles = LeafAngles::planophile(), .reflectance = 0.4, .transmittance = 0.3, .hot_spot = 0.1};
  const ScatteredOnce there = hotSpotExcess(leaves, {2., 0.9, 0.4, 2.5}),
                      back = hotSpotExcess(leaves, {2., 0.4, 0.9, 2.5});
  EXPECT_NEAR(there.leaves * 0.4, back.leaves * 0.9, 1e-14);
  EXPECT_NEAR(there.gap, back.gap, 1e-15);
}

// Flat discs at random, seen straight from the sun and from 60 degrees: paths that part farther than a disc. There the
// formula is exact, so that the z-test judges it; the turbid gap is 7 sigma away. False alarm at 4 sigma: 6e-5.
TEST(P22_HotSpot, AgreesWithRandomDiscs) {
  const double lai = 1.5, radius = 0.1, apart = std::sqrt(3.);
  const double width = apart + 2. * radius, depth = 2. * radius, mean = lai / (kPi * radius * radius) * width * depth;
  Random random(11, 0);
  constexpr int kCount = 200000;
  int open = 0;
  for (int k = 0; k < kCount; ++k) {
    bool blocked = false;
    for (double left = -std::log(1. - random.uniformDouble()); left < mean;
         left -= std::log(1. - random.uniformDouble())) {
      const double height = random.uniformDouble();
      const double x = width * random.uniformDouble() - radius, y = depth * random.uniformDouble() - radius;
      const double view = x - apart * height;
      blocked = blocked || x * x + y * y < radius * radius || view * view + y * y < radius * radius;
    }
    open += blocked ? 0 : 1;
  }
  const double found = double(open) / kCount, error = std::sqrt(found * (1. - found) / kCount);
  const LeafScattering leaves{
      .angles = LeafAngles::table({0., 1e-6}, {1., 1.}), .reflectance = 0.5, .transmittance = 0., .hot_spot = 0.2};
  const pp::SunAndView at{.thickness = lai, .mu0 = 1., .mu = 0.5, .azimuth = 0.};
  const double turbid = scatteredOnceTurbid(leaves, at).gap;
  EXPECT_NEAR(found, turbid + hotSpotExcess(leaves, at).gap, 4. * error);
  EXPECT_GT(found, turbid + 5. * error);
}

// A periodic canopy of 59,683 leaves, discs of radius 0.1 of its height thrown at random, spherical, leaf area index 3,
// traced by Monte Carlo with 400,000 paths for each view; the sun at 20 degrees. Reflectance factors by one leaf (to
// 2e-3 of it), and by the soil alone (standard error at most 1e-4).
struct TracedView {
  double view;  // zenith angle [degree], above 0 on the sun's side
  double leaf, soil;
};
struct TracedCanopy {
  double reflectance, transmittance, soil_albedo;
  std::array<TracedView, 7> views;
};
constexpr std::array kTraced{TracedCanopy{0.4957,
                                          0.4409,
                                          0.159,
                                          {{{-60., 0.1487061, 0.0016166},
                                            {-30., 0.1492958, 0.0060102},
                                            {0., 0.1901970, 0.0089191},
                                            {20., 0.2810301, 0.0322671},
                                            {25., 0.2549918, 0.0160884},
                                            {45., 0.2165750, 0.0045534},
                                            {70., 0.2189932, 0.0004190}}}},
                             TracedCanopy{0.0546,
                                          0.0149,
                                          0.127,
                                          {{{-60., 0.0127449, 0.0012970},
                                            {-30., 0.0156388, 0.0047876},
                                            {0., 0.0209941, 0.0071749},
                                            {20., 0.0309995, 0.0256997},
                                            {25., 0.0280984, 0.0129165},
                                            {45., 0.0237381, 0.0036481},
                                            {70., 0.0228472, 0.0003270}}}}};

// Exponentials in place of the discs' own overlap leave 1.8 % rms of the leaves' light and 0.0037 of the soil's;
// without a hot spot it is 23 % and 0.066.
TEST(P22_HotSpot, IsNearTracedDiscs) {
  double with = 0., without = 0., soil_with = 0., soil_without = 0.;
  int count = 0;
  for (const TracedCanopy& canopy : kTraced)
    for (const auto& [view, leaf, soil] : canopy.views) {
      const double mu0 = std::cos(20. * kPi / 180.), mu = std::cos(view * kPi / 180.);
      const LeafScattering leaves{
          .reflectance = canopy.reflectance, .transmittance = canopy.transmittance, .hot_spot = 0.2};
      const pp::SunAndView at{.thickness = 3., .mu0 = mu0, .mu = mu, .azimuth = view > 0. ? kPi : 0.};
      const ScatteredOnce turbid = scatteredOnceTurbid(leaves, at), excess = hotSpotExcess(leaves, at);
      with += std::pow(kPi * (turbid.leaves + excess.leaves) / mu0 / leaf - 1., 2);
      without += std::pow(kPi * turbid.leaves / mu0 / leaf - 1., 2);
      soil_with += std::pow(turbid.gap + excess.gap - soil / canopy.soil_albedo, 2);
      soil_without += std::pow(turbid.gap - soil / canopy.soil_albedo, 2);
      ++count;
    }
  EXPECT_LT(std::sqrt(with / count), 0.025);
  EXPECT_GT(std::sqrt(without / count), 0.2);
  EXPECT_LT(std::sqrt(soil_with / count), 0.005);
  EXPECT_GT(std::sqrt(soil_without / count), 0.06);
}

// The hemisphere by other rules: adaptive in the zenith angle where nothing depends on the azimuth, and midpoints,
// which err by 1e-3 where the peak is as wide as three of them. The flux's own rule is right to 1e-5 here.
TEST(P22_HotSpotFlux, IsTheIntegralOverTheViews) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  for (double hot_spot : {0.02, 0.3}) {
    const LeafScattering leaves{.reflectance = 0.4, .transmittance = 0.3, .hot_spot = hot_spot};
    const ScatteredOnce flux = hotSpotFlux(leaves, 2., 1.);
    const auto once = [&](double zenith) { return hotSpotExcess(leaves, {2., 1., std::cos(zenith), 0.}); };
    const auto solid = [](double zenith) { return 2. * std::cos(zenith) * std::sin(zenith); };
    const double by_leaves =
        Quadrature::integrate([&](double t) { return kPi * solid(t) * once(t).leaves; }, 0., 0.5 * kPi - 1e-6, 8, 1e-8);
    const double by_gap =
        Quadrature::integrate([&](double t) { return solid(t) * once(t).gap; }, 0., 0.5 * kPi - 1e-6, 8, 1e-8);
    EXPECT_NEAR(flux.leaves / by_leaves, 1., 5e-5) << hot_spot;
    EXPECT_NEAR(flux.gap / by_gap, 1., 5e-4) << hot_spot;
  }
  const LeafScattering leaves{.reflectance = 0.4, .transmittance = 0.3, .hot_spot = 0.3};
  const ScatteredOnce flux = hotSpotFlux(leaves, 2., 0.3);
  ScatteredOnce wanted{0., 0.};
  constexpr int kCount = 50;
  for (int i = 0; i < kCount; ++i)
    for (int j = 0; j < kCount; ++j) {
      const double mu = (i + 0.5) / kCount, azimuth = kPi * (j + 0.5) / kCount;
      const ScatteredOnce once = hotSpotExcess(leaves, {2., 0.3, mu, azimuth});
      wanted.leaves += 2. * kPi / (kCount * kCount) * mu * once.leaves;
      wanted.gap += 2. / (kCount * kCount) * mu * 0.3 * once.gap;
    }
  EXPECT_NEAR(flux.leaves / wanted.leaves, 1., 5e-3);
  EXPECT_NEAR(flux.gap / wanted.gap, 1., 5e-3);
  EXPECT_EQ(pp::hotSpotFlux({}, 1., 0.5).leaves, 0.);
}

TEST(P22_HotSpot, IsFiniteEverywhere) {
  for (double hot_spot : {0., 1e-300, 0.1, 1e300})
    for (double thickness : {1e-300, 1., 1e300})
      for (double mu0 : {1e-310, 1e-9, 0.5, 1.})
        for (double mu : {1e-310, 1e-9, 0.5, 1.})
          for (double azimuth : {0., kPi})
            for (const LeafAngles& angles : {LeafAngles::spherical(), LeafAngles::table({0., 1e-6}, {1., 1.}),
                                             LeafAngles::table({0.5 * kPi - 1e-6, 0.5 * kPi}, {1., 1.})}) {
              const LeafScattering leaves{
                  .angles = angles, .reflectance = 0.7, .transmittance = 0.3, .hot_spot = hot_spot};
              const pp::SunAndView at{thickness, mu0, mu, azimuth};
              for (const ScatteredOnce& once : {scatteredOnceTurbid(leaves, at), hotSpotExcess(leaves, at)}) {
                EXPECT_TRUE(std::isfinite(once.leaves) && once.leaves >= 0.)
                    << once.leaves << " " << hot_spot << " " << thickness << " " << mu0 << " " << mu << " " << azimuth;
                EXPECT_TRUE(once.gap >= 0. && once.gap <= 1.) << once.gap;
              }
            }
}

TEST(P22_HotSpot, TellsWrongInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const LeafScattering good{.reflectance = 0.5, .transmittance = 0.4, .hot_spot = 0.1};
  for (double mu : {0., -0.5, 1.1, nan}) {
    EXPECT_THROW(hotSpotExcess(good, {1., mu, 0.5, 0.}), InvalidInput);
    EXPECT_THROW(hotSpotExcess(good, {1., 0.5, mu, 0.}), InvalidInput);
    EXPECT_THROW(hotSpotFlux(good, 1., mu), InvalidInput);
  }
  for (double thickness : {0., -1., nan, infinite}) EXPECT_THROW(hotSpotExcess(good, {thickness}), InvalidInput);
  EXPECT_NO_THROW(scatteredOnceTurbid(good, {infinite}));
  EXPECT_THROW(hotSpotExcess(good, {1., 0.5, 0.5, infinite}), InvalidInput);
  for (double bad : {-0.1, 0.7, nan}) {
    LeafScattering leaves = good;
    leaves.transmittance = bad;
    EXPECT_THROW(hotSpotExcess(leaves, {}), InvalidInput);
  }
  for (double bad : {-0.1, nan, infinite}) {
    LeafScattering leaves = good;
    leaves.hot_spot = bad;
    EXPECT_THROW(hotSpotExcess(leaves, {}), InvalidInput);
  }
}

}  // namespace
