// Check that leaves scatter as the double integral over directions and leaf angles says, mode by mode, and lose
// nothing.
#include "scattering/leaf_scattering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.hpp"

namespace {

using namespace sunfleck;
constexpr double kPi = std::numbers::pi;

struct Rule {
  std::vector<double> mus, weights;
};

// Gauss's nodes on (0, 1).
template <unsigned Count>
Rule halfRangeRule() {
  using Gauss = boost::math::quadrature::gauss<double, Count>;
  Rule rule;
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i)
    for (double sign : {-1., 1.}) {
      if (sign < 0. && Gauss::abscissa()[i] == 0.) continue;
      rule.mus.push_back(0.5 + sign * 0.5 * Gauss::abscissa()[i]);
      rule.weights.push_back(0.5 * Gauss::weights()[i]);
    }
  return rule;
}

// A_m by quadrature between the places where n . s changes sign. Error of the reference: 1e-14 asked for.
double modeByQuadrature(double inclination, double mu, int m) {
  const double flat = std::cos(inclination) * mu;
  const double round = std::sin(inclination) * std::sqrt((1. - mu) * (1. + mu));
  const auto integrand = [&](double phi) { return std::abs(flat + round * std::cos(phi)) * std::cos(m * phi); };
  const double zero = round > flat ? std::acos(-flat / round) : kPi;
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 61>;
  double sum = Quadrature::integrate(integrand, 0., zero, 10, 1e-13);
  if (zero < kPi) sum += Quadrature::integrate(integrand, zero, kPi, 10, 1e-13);
  return (m == 0 ? 1. : 2.) / kPi * sum;
}

TEST(P21_LeafProjectionModes, AreTheFourierCoefficients) {
  // Inclinations from flat to upright, the ends to 1e-6 by narrow tables; the kink is met at mu = sin(inclination).
  for (const LeafAngles& angles : {LeafAngles::uniform(), LeafAngles::table({0., 1e-6}, {1., 1.}),
                                   LeafAngles::table({0.5 * kPi - 1e-6, 0.5 * kPi}, {1., 1.})})
    for (double mu : {0., 1e-12, 1e-4, 0.3, angles.nodes()[20].sine, 0.9, 1. - 1e-13, 1.})
      for (int m : {0, 1, 2, 3, 4, 17, 64, 255}) {
        std::vector<double> modes(angles.nodes().size());
        leafProjectionModes(angles, m, mu, modes);
        for (std::size_t r = 0; r < modes.size(); r += 9)
          EXPECT_NEAR(modes[r], modeByQuadrature(angles.nodes()[r].inclination, mu, m), 3e-14)
              << "mode " << m << " mu " << mu << " inclination " << angles.nodes()[r].inclination;
      }
}

// Midpoints of the leaf's azimuth; their error at the four kinks is a step squared.
TEST(P21_LeafScattering, IsTheMeanOverTheLeaves) {
  const double rho = 0.45, tau = 0.2;
  for (const char* name : {"planophile", "spherical"})
    for (double mu : {-1., -0.7, 0.02, 0.5, 1.})
      for (double mu_in : {0.35, 1.})
        for (double azimuth : {0., 1., 7.}) {
          const LeafAngles angles = LeafAngles::named(name);
          constexpr int kCount = 2000;
          double sum = 0.;
          for (std::size_t r = 0; r < angles.nodes().size(); ++r) {
            const auto& [inclination, cosine, sine, weight] = angles.nodes()[r];
            double mean = 0.;
            for (int i = 0; i < kCount; ++i) {
              const double phi = 2. * kPi * (i + 0.5) / kCount;
              const double out = cosine * mu + sine * std::sqrt(1. - mu * mu) * std::cos(phi - azimuth);
              const double in = cosine * mu_in + sine * std::sqrt(1. - mu_in * mu_in) * std::cos(phi);
              mean += std::abs(out * in) * (out * in < 0. ? rho : tau) / kCount;
            }
            sum += weight * mean / kPi;
          }
          const LeafScattering leaves{.angles = angles, .reflectance = rho, .transmittance = tau};
          EXPECT_NEAR(leafScattering(leaves, mu, mu_in, azimuth), sum, 2e-6) << name << mu << mu_in << azimuth;
        }
}

// The azimuth series of the kernels, down from down and up from down, sums to the function that knows no series. The
// series falls as m^-4: 256 modes leave 1e-8 of it; the scaling of mode 0 by the row's own G is 1e-5 of the value.
TEST(P21_LeafKernel, SumsToTheScatteringFunction) {
  const LeafAngles angles = LeafAngles::planophile();
  const double rho = 0.5, tau = 0.1;
  const std::vector<double> mus{0.02, 0.4, 0.77, 1.}, mus_in{0.3, 0.9};
  LeafProjections rows(angles, mus), columns(angles, mus_in);
  LeafKernel kernel;
  const double azimuth = 0.8;
  std::vector<double> down(8, 0.), up(8, 0.), even(8), odd(8);
  for (int m = 0; m < 256; ++m) {
    rows.setMode(m);
    columns.setMode(m);
    fillLeafKernel(rows, columns, kernel);
    kernel.evenOdd(rho, tau, even, odd);
    const double factor = (m == 0 ? 1. : 2.) / (2. * kPi) * std::cos(m * azimuth);
    for (std::size_t k = 0; k < 8; ++k) {
      down[k] += factor * 0.5 * (even[k] + odd[k]);
      up[k] += factor * 0.5 * (even[k] - odd[k]);
    }
  }
  const LeafScattering leaves{.angles = angles, .reflectance = rho, .transmittance = tau};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_NEAR(down[2 * i + j], leafScattering(leaves, mus[i], mus_in[j], azimuth), 1e-6) << mus[i];
      EXPECT_NEAR(up[2 * i + j], leafScattering(leaves, -mus[i], mus_in[j], azimuth), 1e-6) << mus[i];
    }
}

// A radiance f(mu') cos(m phi'), different in both hemispheres, scattered by the double integral over its directions,
// against E and O. Midpoints in azimuth alias modes near 128, of size 1e-8; mode 0 is scaled to 1e-5.
TEST(P21_LeafKernel, ScattersAsTheDoubleIntegral) {
  const LeafAngles angles = LeafAngles::erectophile();
  const double rho = 0.2, tau = 0.55;
  const LeafScattering leaves{.angles = angles, .reflectance = rho, .transmittance = tau};
  const Rule rule = halfRangeRule<7>();
  const std::vector<double> mus{0.25, 0.85};
  LeafProjections rows(angles, mus), columns(angles, rule.mus);
  LeafKernel kernel;
  const auto radiance = [](double mu) { return mu > 0. ? 1. + mu * mu : 0.3 - 0.2 * mu; };
  constexpr int kAzimuths = 128;
  for (int m : {0, 1, 2, 3, 4}) {
    rows.setMode(m);
    columns.setMode(m);
    fillLeafKernel(rows, columns, kernel);
    std::vector<double> even(kernel.modulus.size()), odd(kernel.modulus.size());
    kernel.evenOdd(rho, tau, even, odd);
    for (std::size_t i = 0; i < mus.size(); ++i) {
      double down = 0., up = 0., sum = 0., difference = 0.;
      for (std::size_t j = 0; j < rule.mus.size(); ++j) {
        for (double sign : {1., -1.})
          for (int k = 0; k < kAzimuths; ++k) {
            const double phi = 2. * kPi * (k + 0.5) / kAzimuths;
            const double arriving = rule.weights[j] * 2. * kPi / kAzimuths * radiance(sign * rule.mus[j]) *
                                    std::cos(m * phi);  // scattered to azimuth 0, where cos(m phi) is 1
            down += arriving * leafScattering(leaves, mus[i], sign * rule.mus[j], -phi);
            up += arriving * leafScattering(leaves, -mus[i], sign * rule.mus[j], -phi);
          }
        const std::size_t at = i * rule.mus.size() + j;
        sum += rule.weights[j] * even[at] * (radiance(rule.mus[j]) + radiance(-rule.mus[j]));
        difference += rule.weights[j] * odd[at] * (radiance(rule.mus[j]) - radiance(-rule.mus[j]));
      }
      EXPECT_NEAR(sum, down + up, 1e-5) << "mode " << m << " mu " << mus[i];
      EXPECT_NEAR(difference, down - up, 1e-5) << "mode " << m << " mu " << mus[i];
    }
  }
}

// What arrives in any direction is scattered or absorbed in full by discrete directions: sum of w_i E_ij = omega G_j.
// Error: roundings of sums of 64 terms.
template <unsigned Count>
void expectEnergy() {
  const Rule rule = halfRangeRule<Count>();
  for (const LeafAngles& angles :
       {LeafAngles::spherical(), LeafAngles::planophile(), LeafAngles::extremophile(), LeafAngles::beta(0.785, 0.7),
        LeafAngles::table({0., 1e-6}, {1., 1.}), LeafAngles::ellipsoidal(1e-3)}) {
    const LeafProjections nodes(angles, rule.mus, rule.weights);
    const std::vector<double> beams{1., 0.5, 1e-3, rule.mus[0]};
    const LeafProjections beam(angles, beams);
    for (const LeafProjections* columns : {&nodes, &beam}) {
      LeafKernel kernel;
      fillLeafKernel(nodes, *columns, kernel);
      std::vector<double> even(kernel.modulus.size()), odd(kernel.modulus.size());
      kernel.evenOdd(0.7, 0.3, even, odd);
      for (std::size_t j = 0; j < columns->size(); ++j) {
        double sum = 0.;
        for (std::size_t i = 0; i < nodes.size(); ++i) sum += rule.weights[i] * even[i * columns->size() + j];
        EXPECT_NEAR(sum, columns->projection(j), 4e-15) << Count << " " << columns->mu(j);
      }
    }
  }
}

TEST(P21_LeafKernel, ConservesEnergy) {
  expectEnergy<1>();
  expectEnergy<2>();
  expectEnergy<8>();
  expectEnergy<33>();
}

// Both scalings leave each direction its G: as near as the ordinates integrate G itself, a smooth function. Measured
// 3e-5, 6e-7 and 1e-8 for 4, 8 and 16 planophile; spherical to rounding.
TEST(P21_LeafProjections, KeepTheExtinctionOfTheirDirections) {
  const auto worst = [](const LeafAngles& angles, const Rule& rule) {
    const LeafProjections nodes(angles, rule.mus, rule.weights);
    double off = 0.;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      off = std::max(off, std::abs(nodes.projection(i) - leafProjection(angles, rule.mus[i])));
    return off;
  };
  EXPECT_LT(worst(LeafAngles::planophile(), halfRangeRule<4>()), 4e-5);
  EXPECT_LT(worst(LeafAngles::planophile(), halfRangeRule<8>()), 8e-7);
  EXPECT_LT(worst(LeafAngles::planophile(), halfRangeRule<16>()), 2e-8);
  EXPECT_LT(worst(LeafAngles::spherical(), halfRangeRule<16>()), 1e-14);
}

TEST(P21_LeafProjections, ReturnToModeZero) {
  const Rule rule = halfRangeRule<4>();
  LeafProjections nodes(LeafAngles::uniform(), rule.mus, rule.weights);
  const std::vector<double> before(nodes.values(2).begin(), nodes.values(2).end());
  nodes.setMode(3);
  EXPECT_NE(before[10], nodes.values(2)[10]);
  nodes.setMode(0);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), nodes.values(2).begin()));
}

// Leaves thrown at random, light sent on by Lambert's law: the share that leaves upward from a beam, z-test. One test
// of 4 sigma: false alarm 6e-5.
TEST(P21_LeafScattering, AgreesWithRandomLeaves) {
  const double rho = 0.6, tau = 0.25, mu0 = 0.6, sine0 = 0.8;
  Random random(7, 0);
  constexpr int kCount = 200000;
  double sum = 0., squares = 0.;
  for (int k = 0; k < kCount; ++k) {
    const double z = random.uniformDouble(), phi = 2. * kPi * random.uniformDouble();
    const double nx = std::sqrt(1. - z * z) * std::cos(phi), nz = z;
    const double hit = mu0 * nz + sine0 * nx;  // z points down, as mu does
    // A direction of Lambert's law about +n; reflected light leaves on the side that the light came from.
    const double cosine = std::sqrt(random.uniformDouble()), turn = 2. * kPi * random.uniformDouble();
    const double side = random.uniformDouble() < rho / (rho + tau) ? (hit < 0. ? 1. : -1.) : (hit < 0. ? -1. : 1.);
    const double down = side * cosine * nz + std::sqrt(1. - cosine * cosine) * std::cos(turn) * std::sqrt(1. - nz * nz);
    const double value = down < 0. ? std::abs(hit) * (rho + tau) : 0.;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kCount, error = std::sqrt((squares / kCount - mean * mean) / kCount);
  const LeafScattering leaves{.reflectance = rho, .transmittance = tau};
  const Rule rule = halfRangeRule<30>();
  double wanted = 0.;
  for (std::size_t i = 0; i < rule.mus.size(); ++i)
    for (int k = 0; k < 64; ++k)
      wanted += rule.weights[i] * 2. * kPi / 64. * leafScattering(leaves, -rule.mus[i], mu0, 2. * kPi * k / 64.);
  EXPECT_NEAR(mean, wanted, 4. * error);
  EXPECT_LT(error, 2e-3);
}

}  // namespace
