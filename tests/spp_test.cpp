#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "spp/forward_share.hpp"
#include "spp/slab.hpp"

namespace {

using namespace sunfleck;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

// (S1) Check Beer and Lambert's law on a slanted path. Error: one rounding of exp.
TEST(S1_DirectPower, FallsAlongTheSlantedPath) {
  EXPECT_FLOAT_EQ(spp::directPower(2.f, 0.5f), std::exp(-4.f));
  EXPECT_EQ(spp::directPower(0.f, 1e-4f), 1.f);
}

// (S2) Check black leaves: nothing but direct light. Error: rounding of an exponent up to 20, 20 ulp.
TEST(S2_SppPowers, IsDirectLightForBlackLeaves) {
  for (float z : {0.f, 1.f, 5.f, 20.f}) {
    const auto p = spp::sppPowers(z, 20.f, 1.f, 0.f, 0.5f);
    EXPECT_NEAR(p.down, spp::directPower(z, 1.f), 2e-6f * spp::directPower(z, 1.f) + 1e-9f);
    EXPECT_EQ(p.up, 0.f);
  }
}

// (S2) Check single against double precision over the corners where other forms overflow or divide by zero, as absolute
// error of F = 1. The bound 4e-6 is the rounding of k^2 near albedo 1 seen through thick slabs.
TEST(S2_SppPowers, SinglePrecisionHoldsInTheCorners) {
  for (float omega : {0.f, 0.5f, 0.95f, 0.9999f, 1.f - 6e-8f, 1.f})
    for (float mu0 : {1e-4f, 0.01f, 0.3f, 1.f})
      for (float w : {1e-8f, 1e-3f, 1.f, 100.f, 1e6f, 1e9f, kInfinite})
        for (float part : {0.f, 0.3f, 1.f}) {
          const float z = part == 0.f ? 0.f : part * std::min(w, 1e9f);
          const auto single = spp::sppPowers(z, w, mu0, omega, 0.5f);
          const auto exact = spp::precise::sppPowers(double{z}, double{w}, double{mu0}, double{omega}, 0.5);
          ASSERT_TRUE(std::isfinite(single.down) && std::isfinite(single.up))
              << "omega " << omega << " mu0 " << mu0 << " w " << w << " z " << z;
          EXPECT_NEAR(single.down, exact.down, 4e-6) << "omega " << omega << " mu0 " << mu0 << " w " << w << " z " << z;
          EXPECT_NEAR(single.up, exact.up, 4e-6) << "omega " << omega << " mu0 " << mu0 << " w " << w << " z " << z;
        }
}

// (S3) Check that the diffuse radiance, integrated over each half, is the power again less the direct light.
TEST(S3_SppDiffuseRadiance, IntegratesToThePowers) {
  const auto p = spp::sppPowers(1.f, 4.f, 1.f, 0.95f, 0.5f);
  const float direct = spp::directPower(1.f, 1.f);
  const auto radiance = spp::sppDiffuseRadiance(p, direct);
  const float half_sphere = 2.f * std::numbers::pi_v<float>;
  EXPECT_NEAR(radiance.down * half_sphere, p.down - direct, 1e-6f);
  EXPECT_NEAR(radiance.up * half_sphere, p.up, 1e-6f);
}

// (S4) Check a leaf in a furnace: radiance 1/2pi from all around, so powers 1 and 1, gives irradiance pi/2pi on each
// of two sides, 1 together; and direct light alone counts by projection.
TEST(S4_LeafIrradiance, OfUniformAndOfDirectLight) {
  EXPECT_FLOAT_EQ(spp::leafIrradiance(0.7f, 0.f, {.down = 1.f, .up = 1.f}), 1.f);
  EXPECT_FLOAT_EQ(spp::leafIrradiance(0.7f, 0.3f, {.down = 0.3f, .up = 0.f}), 0.21f);
}

// (S5) Check G_s against its definition, by Simpson's rule in double with 4,000 steps (error below 1e-9 for |a| L <=
// 40).
TEST(S5_ShareBeyondEdge, IsTheQuotientOfItsIntegrals) {
  const auto integral = [](double a, double x) {
    const int n = 4000;
    double sum = 1. + std::exp(-a * x);
    for (int i = 1; i < n; ++i) sum += (i % 2 ? 4. : 2.) * std::exp(-a * x * i / n);
    return sum * x / (3. * n);
  };
  for (double mu0 : {0.4, 1.})
    for (double c : {-1., -0.6, -0.1, 0.1, 0.399999, 0.4, 0.7, 1.})
      for (double depth : {0.2, 2.})
        for (double h : {0., 1e-6, 0.3, 1.7, 9.}) {
          const double w = 3.;
          const double face = c > 0. ? depth / c : (w - depth) / -c;
          const double a = 1. - c / mu0;
          const double expected = (integral(a, face) - integral(a, std::min(h, face))) / integral(a, face);
          EXPECT_NEAR(spp::precise::shareBeyondEdge(c, h, depth, w, mu0), expected, 1e-8)
              << c << " " << depth << " " << h;
          EXPECT_NEAR(double{spp::shareBeyondEdge(float(c), float(h), float(depth), float(w), float(mu0))}, expected,
                      3e-6)
              << c << " " << depth << " " << h;
        }
}

// (S5) Check the corners: a = 0, horizontal directions, no depth, infinite slabs, huge edges: finite and in [0, 1].
TEST(S5_ShareBeyondEdge, StaysAShareInTheCorners) {
  for (float mu0 : {1e-4f, 0.5f, 1.f})
    for (float c : {-1.f, -1e-9f, 0.f, 1e-9f, 0.5f, 1.f})
      for (float depth : {0.f, 1e-20f, 1.f, 1e6f})
        for (float w : {1e-20f, 1.f, 1e9f, kInfinite})
          for (float h : {0.f, 1e-20f, 1.f, 1e9f, kInfinite}) {
            const float share = spp::shareBeyondEdge(c, h, depth, w, mu0);
            ASSERT_TRUE(share >= 0.f && share <= 1.f + 1e-6f)
                << share << ": " << c << " " << h << " " << depth << " " << w;
          }
}

// (S6) Check both ends of Eq. 28.
TEST(S6_Compensated, IsTheSlabOrDirectLight) {
  const spp::SlabPowers slab{.down = 0.8f, .up = 0.4f};
  EXPECT_FLOAT_EQ(spp::compensated(slab, 0.3f, 1.f).down, 0.8f);
  EXPECT_FLOAT_EQ(spp::compensated(slab, 0.3f, 0.f).down, 0.3f);
  EXPECT_EQ(spp::compensated(slab, 0.3f, 0.f).up, 0.f);
}

// (S7) Check that a leaf sends out, over both sides, albedo times what arrives: pi (L front + L back) = omega E.
TEST(S7_LeafRadiance, SendsOutWhatItDoesNotAbsorb) {
  const spp::SlabPowers diffuse{.down = 0.5f, .up = 0.2f};
  for (float to_light : {-1.f, -0.3f, 0.6f})
    for (float slant : {-0.8f, 0.f, 1.f}) {
      const float front = spp::leafRadiance(to_light, 0.7f, slant, diffuse, 0.5f, 0.4f);
      const float back = spp::leafRadiance(-to_light, 0.7f, -slant, diffuse, 0.5f, 0.4f);
      const spp::SlabPowers total{.down = diffuse.down + 0.7f, .up = diffuse.up};
      const float arriving = spp::leafIrradiance(std::abs(to_light), 0.7f, total);
      EXPECT_NEAR(std::numbers::pi_v<float> * (front + back), 0.9f * arriving, 1e-6f);
    }
}

// T by its definition: the phase function over the cosine c of scattering times the share of azimuths that lead
// forward, all for c >= sin(theta0), none for c <= -sin(theta0). With c = sin(theta0) tanh(u) the integrand's poles are
// pi/2 off the axis, whatever g and mu0: the error of sums with steps of 0.2 is below e^(-5 pi^2).
double shareByQuadrature(double g, double mu0) {
  const double sine = std::sqrt((1. - mu0) * (1. + mu0)), rest = mu0 * mu0 / (1. + sine), step = 0.2;
  // 1 + g^2 - 2 g c, from the distance of c to where it is least
  const auto base = [g](double below_one, double above_minus_one) {
    return std::pow(1. - std::abs(g), 2) + 2. * std::abs(g) * (g > 0. ? below_one : above_minus_one);
  };
  double sum = (1. - g * g) / (2. * g) * (1. / (1. - g) - 1. / std::sqrt(base(rest, 1. + sine)));
  for (double u = -40.; u <= 40.; u += step) {
    const double secant = 1. / std::cosh(u), below = rest + sine * 2. / (1. + std::exp(2. * u));
    const double above = rest + sine * 2. / (1. + std::exp(-2. * u));
    const double density = 0.5 * (1. - g * g) / std::pow(base(below, above), 1.5);
    sum += step * density * std::atan2(secant, -mu0 * std::tanh(u)) / std::numbers::pi * sine * secant * secant;
  }
  return sum;
}

// (S8) Check the elliptic integrals and the series against the definition, over all g and cosines and across the switch
// at 0.25. Error: the rounding of g near 1 and of the quadrature's first term, which for small g is a difference of
// numbers as large as 1 / g.
TEST(S8_ForwardShare, IsItsIntegral) {
  for (double g : {0.01, 0.1, 0.2499999, 0.25, 0.2500001, 0.5, 0.85, 0.95, 0.999})
    for (double sign : {-1., 1.})
      for (double mu0 : {1e-7, 1e-5, 1e-3, 0.05, 0.3, 0.7, 0.99, 1. - 1e-9, 1.})
        EXPECT_NEAR(spp::forwardShare(sign * g, mu0), shareByQuadrature(sign * g, mu0), 1e-12)
            << sign * g << " " << mu0;
}

// (S8) Check known values: isotropic 1/2; normal incidence (1-g^2)/2g (1/(1-g) - 1/sqrt(1+g^2)); grazing 1/2 by
// symmetry; and reversal of g swaps the halves. Error: a few roundings, over g.
TEST(S8_ForwardShare, MeetsItsClosedForms) {
  for (double mu0 : {1e-4, 0.3, 1.}) EXPECT_EQ(spp::forwardShare(0., mu0), 0.5);
  for (double g : {-0.999, -0.99, -0.5, 0.3, 0.85, 0.99, 0.999}) {
    const double normal = (1. - g * g) / (2. * g) * (1. / (1. - g) - 1. / std::sqrt(1. + g * g));
    EXPECT_NEAR(spp::forwardShare(g, 1.), normal, 2e-13);  // 1 / (1 - g) magnifies the rounding of g
    for (double mu0 : {1e-9, 0.01, 0.4, 0.99})
      EXPECT_NEAR(spp::forwardShare(g, mu0) + spp::forwardShare(-g, mu0), 1., 1e-15) << g << " " << mu0;
    EXPECT_NEAR(spp::forwardShare(g, 1e-12), 0.5, 1e-9) << g;  // the slope there is below 1 / (1 - |g|)
  }
}

// (S8) Check T between the closed forms against the integral over the forward half itself, by the midpoint rule in mu
// and azimuth. With 400 x 400 points of a function this smooth (|g| <= 0.6) its error is below 1e-5.
TEST(S8_ForwardShare, IsTheIntegralOverTheForwardHalf) {
  constexpr int n = 400;
  for (double g : {-0.6, 0.2, 0.5})
    for (double mu0 : {0.1, 0.3, 0.7}) {
      double sum = 0.;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const double mu = (i + 0.5) / n, azimuth = 2. * std::numbers::pi * (j + 0.5) / n;
          const double cosine = mu * mu0 + std::sqrt((1. - mu * mu) * (1. - mu0 * mu0)) * std::cos(azimuth);
          sum += (1. - g * g) / std::pow(1. + g * g - 2. * g * cosine, 1.5) / (4. * std::numbers::pi);
        }
      EXPECT_NEAR(spp::forwardShare(g, mu0), sum * 2. * std::numbers::pi / (n * n), 1e-5) << g << " " << mu0;
    }
}

}  // namespace
