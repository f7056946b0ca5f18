// The plates of PROSPECT: what their inside, their faces and a pile of them let through.
#include "leaves/leaf_plates.hpp"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace sunfleck {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDegree = std::numbers::pi / 180.;

// Check that diffuse light passes a plate as its integral over all directions says.
TEST(L1_PlateTransmittance, IsTheIntegralOverDirections) {
  boost::math::quadrature::tanh_sinh<double> rule;
  for (const double k : {1e-9, 1e-4, 0.01, 0.3, 0.999, 1.001, 3., 20.}) {
    const double expected = rule.integrate([&](double mu) { return 2. * mu * std::exp(-k / mu); }, 0., 1., 1e-14);
    EXPECT_NEAR(plateTransmittance(k), expected, 2e-14) << k;  // the rule's own rounding
  }
}

// Check its limits: nothing absorbs, everything absorbs, and it falls between.
TEST(L1_PlateTransmittance, FallsFromOneToZero) {
  EXPECT_EQ(plateTransmittance(0.), 1.);
  EXPECT_EQ(plateTransmittance(std::numeric_limits<double>::denorm_min()), 1.);
  EXPECT_EQ(plateTransmittance(1e308), 0.);
  EXPECT_EQ(plateTransmittance(kInfinity), 0.);
  double before = 1.;
  for (double k = 1e-6; k < 800.; k *= 1.01) {
    const double now = plateTransmittance(k);
    EXPECT_LE(now, before) << k;
    EXPECT_GE(now, 0.) << k;
    before = now;
  }
}

// Check the closed form of a face against Fresnel's equations, integrated.
TEST(L2_FaceTransmittance, IsFresnelsMean) {
  const auto passes = [](double n, double angle) {
    const double cos_in = std::cos(angle), cos_out = std::sqrt(1. - std::pow(std::sin(angle) / n, 2));
    const double s = (cos_in - n * cos_out) / (cos_in + n * cos_out),
                 p = (n * cos_in - cos_out) / (n * cos_in + cos_out);
    return 1. - 0.5 * (s * s + p * p);
  };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
  for (const double n : {1.05, 1.27, 1.45, 1.5115, 2., 3.})
    for (const double degrees : {1., 20., 40., 60., 89., 90.}) {
      const double half = degrees * kDegree;
      const double expected =
          Rule::integrate([&](double angle) { return passes(n, angle) * std::sin(2. * angle); }, 0., half, 12, 1e-13) /
          (std::sin(half) * std::sin(half));
      // Differences of terms near 1 over (n^2 - 1)^2 and the cone's share: 1e-16 / (0.01 * 3e-4) at the worst.
      EXPECT_NEAR(faceTransmittance(n, half), expected, 1e-10) << n << " " << degrees;
    }
}

// Plates added one by one from the last to the first, by the light that goes back and forth between them.
LeafSides addedUp(const PlateFaces& faces, double tau, int count) {
  const LeafSides lit = plates(faces, tau, 1.);
  const LeafSides one = plates({.inner = faces.inner, .lit = faces.diffuse, .diffuse = faces.diffuse}, tau, 1.);
  LeafSides pile{.reflectance = 0., .transmittance = 1.};
  const auto under = [&](const LeafSides& top) {
    const double between = 1. - one.reflectance * pile.reflectance;
    return LeafSides{
        .reflectance = top.reflectance + top.transmittance * pile.reflectance * one.transmittance / between,
        .transmittance = top.transmittance * pile.transmittance / between};
  };
  for (int i = 1; i < count; ++i) pile = under(one);
  return under(lit);
}

// Check piles against plates added one by one.
TEST(L3_Plates, AddUp) {
  for (const double index : {1.27, 1.5115})
    for (const double tau : {1., 1. - 1e-9, 0.999, 0.7, 0.2, 1e-3, 0.})
      for (const int count : {1, 2, 3, 5, 9}) {
        const PlateFaces faces = plateFaces(index);
        const LeafSides pile = plates(faces, tau, count), expected = addedUp(faces, tau, count);
        EXPECT_NEAR(pile.reflectance, expected.reflectance, 1e-14) << tau << " " << count;  // rounding
        EXPECT_NEAR(pile.transmittance, expected.transmittance, 1e-14) << tau << " " << count;
      }
}

// Check that two piles of parts of plates, one under the other, are the pile of all: N - 1 need not be whole.
TEST(L3_Plates, AreContinuousInTheirNumber) {
  const PlateFaces faces = plateFaces(1.4);
  for (const double tau : {1., 0.9, 0.01})
    for (double n = 1.; n < 4.; n += 0.07) {
      const LeafSides pile = plates(faces, tau, n), next = plates(faces, tau, n + 1e-9);
      EXPECT_NEAR(pile.reflectance, next.reflectance, 1e-8) << tau << " " << n;  // slopes are below 1 per plate
      EXPECT_NEAR(pile.transmittance, next.transmittance, 1e-8) << tau << " " << n;
    }
  EXPECT_DOUBLE_EQ(plates(faces, 0.3, 1.).transmittance, plates(faces, 0.3, std::nextafter(1., 2.)).transmittance);
}

// Check at every corner that shares are shares: nothing is lost where nothing absorbs, nothing is won elsewhere.
TEST(L3_Plates, ConserveEnergy) {
  for (const double index : {1.05, 1.2708, 1.45, 1.5115, 3.})
    for (const double n : {1., 1. + 1e-15, 1.0001, 1.5, 3., 10., 1e6, 1e300})
      for (const double absorption : {0., 1e-300, 1e-17, 1e-12, 1e-6, 0.1, 1., 30., 650., 1e5, kInfinity}) {
        const double tau = plateTransmittance(absorption);
        const LeafSides leaf = plates(plateFaces(index), tau, n);
        const double all = leaf.reflectance + leaf.transmittance;
        EXPECT_TRUE(leaf.reflectance >= 0. && leaf.transmittance >= 0. && all <= 1.)
            << index << " " << n << " " << absorption << ": " << leaf.reflectance << " " << leaf.transmittance;
        if (tau == 1.) {
          EXPECT_NEAR(all, 1., 1e-14) << index << " " << n;  // rounding
        }
      }
}

}  // namespace
}  // namespace sunfleck
