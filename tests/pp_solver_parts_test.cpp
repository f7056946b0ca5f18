// Check that each part of the plane-parallel solver does what its equation says.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "pp_solver/discrete_legendre.hpp"
#include "pp_solver/solver.hpp"

namespace sunfleck::pp {
namespace {

Problem slab(double asymmetry, double albedo, double thickness, double mu0) {
  Problem problem;
  problem.layers.push_back(
      {.thickness = thickness, .medium = Particles{albedo, PhaseFunction::henyeyGreenstein(asymmetry)}});
  problem.beam = Beam{.mu0 = mu0};
  return problem;
}

TEST(P1_DoubleGauss, IntegratesPolynomialsOfTwiceItsSize) {
  for (const int streams : {2, 4, 16, 64, 256}) {
    const DoubleGauss gauss = doubleGauss(streams);
    for (int power = 0; power < streams; ++power) {
      double sum = 0.;
      for (size_t i = 0; i < gauss.mu.size(); ++i) sum += gauss.weight[i] * std::pow(gauss.mu[i], power);
      EXPECT_NEAR(sum * (power + 1.), 1., 1e-13) << streams << " " << power;  // rounding of 128 terms and of pow
    }
  }
}

TEST(P2_DiscreteLegendre, IsOrthonormalAndBidiagonal) {
  for (const int streams : {2, 8, 64, 256})
    for (const int mode : {0, 1, 2, streams / 2, streams - 1}) {
      if (mode >= streams) continue;
      const auto ordinates = Ordinates::of(streams);
      const DiscreteLegendre& basis = ordinates->mode(mode);
      const int n = basis.n;
      double orthonormal = 0., bidiagonal = 0.;
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          double even = 0., odd = 0., between = 0.;
          for (int i = 0; i < n; ++i) {
            even += basis.even[j * n + i] * basis.even[k * n + i];
            odd += basis.odd[j * n + i] * basis.odd[k * n + i];
            between += basis.even[j * n + i] * ordinates->mu()[i] * basis.odd[k * n + i];
          }
          const double one = j == k ? 1. : 0.;
          const double expected = j == k ? basis.alpha[k] : j == k + 1 ? basis.beta[k] : 0.;
          orthonormal = std::max({orthonormal, std::abs(even - one), std::abs(odd - one)});
          bidiagonal = std::max(bidiagonal, std::abs(between - expected));
        }
      }
      // Rounding of sums of up to 128 terms, and what was taken for nothing (1e-13) where a direction was replaced.
      EXPECT_LT(orthonormal, 1e-13) << streams << " " << mode;
      EXPECT_LT(bidiagonal, 2e-13) << streams << " " << mode;
    }
}

TEST(P2_DiscreteLegendre, IsTheLegendreFunctionsWhereTheyAreOrthonormal) {
  const auto ordinates = Ordinates::of(16);
  const DiscreteLegendre& basis = ordinates->mode(0);
  for (int i = 0; i < basis.n; ++i) {
    const double mu = ordinates->mu()[i], root = std::sqrt(ordinates->weight()[i]);
    EXPECT_NEAR(basis.even[i], root, 1e-15);                                                        // P_0
    EXPECT_NEAR(basis.odd[i], root * std::sqrt(3.) * mu, 1e-14);                                    // P_1
    EXPECT_NEAR(basis.even[basis.n + i], root * std::sqrt(5.) * 0.5 * (3. * mu * mu - 1.), 1e-14);  // P_2
  }
}

TEST(P3_Eigenmodes, SatisfyTheTransferEquationAtTheNodes) {
  for (const double asymmetry : {0., 0.85, -0.9, 0.999})
    for (const double albedo : {0.5, 0.99, 1. - 1e-7, 1. - 1e-16, 1.})
      for (const double thickness : {0.1, 10., 1e5}) {
        Solver solver({.streams = 32});
        solver.solve(slab(asymmetry, albedo, thickness, 0.6));
        // The demand on the solver. Measured 1e-12 and less: rounding over the step's smallest opacity.
        EXPECT_LT(solver.residual(4), 1e-11) << asymmetry << " " << albedo << " " << thickness;
      }
}

TEST(P3_Eigenmodes, DecayAsDiffusionWhereLittleIsAbsorbed) {
  // k^2 -> 3 (1 - omega)(1 - omega g): within 1 - omega of it, relatively (Chandrasekhar 1960)
  for (const double loss : {1e-6, 1e-9, 1e-13}) {
    const double g = 0.5;
    Solver solver({.streams = 16});
    const double k = std::sqrt(3. * loss * (1. - (1. - loss) * g)), depth = 1. / k;
    solver.solve(slab(g, 1. - loss, std::numeric_limits<double>::infinity(), 0.5));
    const double ratio = solver.fluxes(2. * depth).mean_intensity / solver.fluxes(depth).mean_intensity;
    const double true_loss = 1. - (1. - loss);  // what 1 - loss rounds to
    EXPECT_NEAR(-std::log(ratio) / depth / std::sqrt(3. * true_loss * (1. - (1. - loss) * g)), 1., 2e-6 + loss);
  }
}

TEST(P4_Directions, ScatterAsTheyReceive) {
  // Reciprocity: mu0 I(mu; mu0) = mu I(mu0; mu) of reflected light under beams of the same irradiance across them...
  for (const double asymmetry : {0., 0.85, -0.7})
    for (const int streams : {4, 16}) {
      Solver a({.streams = streams}), b({.streams = streams});
      a.solve(slab(asymmetry, 0.95, 3., 0.83));
      b.solve(slab(asymmetry, 0.95, 3., 0.27));
      const double forth = a.radiance(0., -0.27, 2.1) / 0.83, back = b.radiance(0., -0.83, 2.1) / 0.27;
      EXPECT_NEAR(forth, back, 1e-13 * forth);  // rounding: exact for every N
    }
}

TEST(P5_Beam, IsSmoothThroughResonanceAndNodes) {
  // N = 2: one mode, k known. mu0 through 1 / k and through the node: as smooth as anywhere.
  const double albedo = 0.5;
  const double k = 2. * std::sqrt(1. - albedo);
  for (const double centre : {1. / k, 0.5}) {
    std::vector<double> values;
    Solver solver({.streams = 2});
    for (const double step : {-2e-5, -1e-5, 0., 1e-5, 2e-5}) {
      solver.solve(slab(0., albedo, 2., centre + step));
      values.push_back(solver.transmittance());
    }
    // The fourth difference of a smooth function is h^4 = 1e-20 times its fourth derivative: rounding is left.
    EXPECT_NEAR(values[0] - 4. * values[1] + 6. * values[2] - 4. * values[3] + values[4], 0., 1e-14);
    solver.solve(slab(0., albedo, 2., std::nextafter(centre, 1.)));
    EXPECT_NEAR(solver.transmittance(), values[2], 1e-15);
  }
}

TEST(P6_OneLayer, AgreesWithTheEliminationOfP7) {
  // The same slab in two pieces goes by (P7)
  for (const double albedo : {0.3, 0.99, 1.})
    for (const double thickness : {1e-3, 1., 30.}) {
      Solver one({.streams = 16}), two({.streams = 16});
      Problem problem = slab(0.7, albedo, thickness, 0.4);
      one.solve(problem);
      problem.layers.push_back(problem.layers[0]);
      problem.layers[0].thickness = 0.3 * thickness;
      problem.layers[1].thickness = 0.7 * thickness;
      two.solve(problem);
      EXPECT_NEAR(one.reflectance(), two.reflectance(), 2e-14);  // rounding
      EXPECT_NEAR(one.transmittance(), two.transmittance(), 2e-14);
    }
}

TEST(P7_Layers, OnAPerfectMirrorLoseNothing) {
  Problem problem = slab(0.8, 1., 2., 0.3);
  problem.layers.push_back({.thickness = 1e6, .medium = Particles{1., PhaseFunction()}});
  problem.layers.push_back({.thickness = 1e-9, .medium = Particles{1., PhaseFunction::henyeyGreenstein(-0.5)}});
  problem.ground.albedo = 1.;
  Solver solver({.streams = 32});
  solver.solve(problem);
  EXPECT_NEAR(solver.reflectance(), 1., 1e-12);  // the demand on energy
}

TEST(P7_Layers, OnALambertianGroundOrItsFourierModesAreTheSame) {
  Problem flat = slab(0.8, 0.9, 2., 0.3);
  flat.ground.albedo = 0.4;
  Problem shaped = flat;
  shaped.ground = {};
  shaped.ground.brdf = [](int mode, double, double) { return mode == 0 ? 0.4 / std::numbers::pi : 0.; };
  shaped.ground.brdf_modes = 1;
  Solver a({.streams = 16}), b({.streams = 16});
  a.solve(flat);
  b.solve(shaped);
  EXPECT_NEAR(a.reflectance(), b.reflectance(), 1e-14);
  EXPECT_NEAR(a.radiance(0., -0.6, 1.), b.radiance(0., -0.6, 1.), 1e-14);
}

TEST(P8_Radiance, HasTheFluxesOfTheSolution) {
  // The radiance's own hemispherical integrals, by Gauss's rule of more directions than were solved for. Without the
  // corrections, which leave fluxes to the solver.
  Solver solver({.streams = 16, .corrections = false});
  Problem problem = slab(0.6, 0.95, 4., 0.7);
  problem.ground.albedo = 0.3;
  solver.solve(problem);
  const DoubleGauss gauss = doubleGauss(64);
  for (const double depth : {0., 1.3, 4.}) {
    double up = 0., down = 0.;
    for (size_t i = 0; i < gauss.mu.size(); ++i) {
      // the mean over azimuth, by places enough for 16 modes
      for (int k = 0; k < 32; ++k) {
        const double phi = 2. * std::numbers::pi * k / 32.,
                     weight = 2. * std::numbers::pi * gauss.weight[i] * gauss.mu[i] / 32.;
        up += weight * solver.radiance(depth, -gauss.mu[i], phi);
        down += weight * solver.radiance(depth, gauss.mu[i], phi);
      }
    }
    const Fluxes fluxes = solver.fluxes(depth);
    // Delta-M's peak counts as diffuse light in the fluxes and has no direction in the radiance.
    const double peak = 0.7 * (std::exp(-(1. - 0.95 * std::pow(0.6, 16)) * depth / 0.7) - std::exp(-depth / 0.7));
    // N = 16 sees its own field by 16 directions, the sum here by 64: measured 2e-5 apart.
    EXPECT_NEAR(up, fluxes.up, 5e-5);
    EXPECT_NEAR(down, fluxes.down - peak, 5e-5);
  }
}

TEST(P8_Radiance, LosesNoModeOfGroundOrSky) {
  // A ground whose only azimuth mode beside the mean is the fourth, under isotropic scattering; seen through a thin
  // layer it is the BRDF itself times the light that arrives.
  Problem problem = slab(0., 0.5, 1e-6, 0.6);
  problem.ground.brdf = [](int mode, double, double) { return mode == 0 ? 0.2 : mode == 4 ? 0.1 : 0.; };
  problem.ground.brdf_modes = 5;
  Solver solver({.streams = 16});
  solver.solve(problem);
  for (const double phi : {0., 0.4, 2.})
    EXPECT_NEAR(solver.radiance(0., -0.5, phi), 0.6 * (0.2 + 0.1 * std::cos(4. * phi)), 1e-5);  // a few thicknesses
  // A sky with one mode far up, scattered back by a layer that scatters it: the same turned by a period of it.
  Problem lit = slab(0.9, 0.9, 1., 1.);
  lit.beam.reset();
  lit.above = [](double, double phi) { return 1. + std::cos(9. * phi + 0.3); };
  solver.solve(lit);
  const double there = solver.radiance(1., 0.5, 0.2),
               turned = solver.radiance(1., 0.5, 0.2 + 2. * std::numbers::pi / 9.);
  EXPECT_NEAR(there, turned, 1e-13);
  const double half = solver.radiance(1., 0.5, 0.2 + std::numbers::pi / 9.);
  const double unscattered = std::exp(-1. / 0.5) * 2. * std::cos(9. * 0.2 + 0.3);
  EXPECT_GT(std::abs(there - half - unscattered), 1e-3);  // scattered light has the mode too
}

TEST(P8_Radiance, MayBeAskedOfParticlesAndLeavesInTurn) {
  Solver solver({.streams = 8});
  Problem particles = slab(0.5, 0.9, 1., 0.6), leaves = particles;
  leaves.layers[0].medium = LeafScattering{.reflectance = 0.4, .transmittance = 0.4};
  std::vector<double> values;
  for (int turn = 0; turn < 2; ++turn)
    for (const Problem& problem : {particles, leaves}) {
      solver.solve(problem);
      values.push_back(solver.radiance(0.5, -0.4, 1.));
    }
  EXPECT_EQ(values[0], values[2]);
  EXPECT_EQ(values[1], values[3]);
  EXPECT_NE(values[0], values[1]);
}

TEST(P9_Moments, KeepEnergyAndLeaveNoFluxNegative) {
  for (const double asymmetry : {-0.999, -0.95, 0.95, 0.999})
    for (const int streams : {2, 4, 8, 32})
      for (const double mu0 : {0.01, 0.15, 0.2, 0.6, 1.})
        for (const double thickness : {0.1, 1.4, 30.}) {
          Solver solver({.streams = streams});
          solver.solve(slab(asymmetry, 0.44, thickness, mu0));
          EXPECT_GE(solver.reflectance(), -1e-15) << asymmetry << " " << streams << " " << mu0 << " " << thickness;
          EXPECT_GE(solver.transmittance(), -1e-15) << asymmetry << " " << streams << " " << mu0 << " " << thickness;
          EXPECT_NEAR(solver.reflectance() + solver.transmittance() + solver.absorptance(), 1., 1e-12);
        }
}

TEST(P13_FirstScattering, IsExactInThinSlabs) {
  // All but the first order is a thickness smaller: radiance over thickness -> omega p(Theta) / mu, whatever N
  const double g = 0.9, thickness = 1e-7, mu0 = 0.5, mu = 0.3;
  for (const int streams : {2, 8}) {
    Solver solver({.streams = streams});
    solver.solve(slab(g, 0.8, thickness, mu0));
    for (const double phi : {0., 0.4, 3.}) {
      const double cosine = std::sqrt((1. - mu * mu) * (1. - mu0 * mu0)) * std::cos(phi) + mu * mu0;
      const double expected = 0.8 * PhaseFunction::henyeyGreenstein(g)(cosine) * thickness / mu;
      EXPECT_NEAR(solver.radiance(thickness, mu, phi) / expected, 1., 2e-5);  // some thicknesses over mu mu0
    }
  }
}

TEST(P13_Aureole, IsNearTheConvergedOneAtFewStreams) {
  // Near the beam, at the bottom of a slab of peaked scattering: 16 directions with the corrections against 128.
  const double mu0 = 0.8;
  Solver few({.streams = 16}), plain({.streams = 16, .corrections = false}), many({.streams = 128});
  for (Solver* solver : {&few, &plain, &many}) solver->solve(slab(0.85, 0.99, 1., mu0));
  for (const double mu : {0.75, 0.8, 0.85}) {
    const double exact = many.radiance(1., mu, 0.05);
    // Measured: within 1.5 % against up to 9 % without.
    EXPECT_NEAR(few.radiance(1., mu, 0.05) / exact, 1., 0.03) << mu;
    EXPECT_LT(std::abs(few.radiance(1., mu, 0.05) - exact), std::abs(plain.radiance(1., mu, 0.05) - exact)) << mu;
  }
}

TEST(P10_Leaves, ConserveEnergyAndSatisfyTheirEquation) {
  for (const char* angles : {"spherical", "planophile", "erectophile", "extremophile"})
    for (const double reflectance : {0.1, 0.45, 0.5 - 1e-9, 0.5}) {
      Problem problem = slab(0., 0., 1., 0.6);
      problem.layers[0] = {.thickness = 4.,
                           .medium = LeafScattering{.angles = LeafAngles::named(angles), .reflectance = reflectance}};
      problem.ground.albedo = 0.2;
      Solver solver({.streams = 16});
      solver.solve(problem);
      EXPECT_NEAR(solver.reflectance() + solver.absorptance() + 0.8 * solver.transmittance(), 1., 1e-12);
      EXPECT_LT(solver.residual(3), 1e-11) << angles << " " << reflectance;
    }
}

// canopy_flux.csv: a turbid canopy of spherical leaves, leaf area index 3, sun at 20 degrees, by Monte Carlo, as given
// in two bands with standard errors; and the same of discrete leaves of diameter 0.2 times the height.
struct Canopy {
  double reflectance, transmittance, soil;
  std::array<double, 3> turbid, error, discrete;  // reflected, absorbed by leaves, arriving at the soil
};
constexpr std::array<Canopy, 2> kCanopies{{{0.4957,
                                            0.4409,
                                            0.159,
                                            {0.413288, 0.161912, 0.505113},
                                            {0.000266, 0.000116, 0.000333},
                                            {0.423709, 0.159531, 0.495553}},
                                           {0.0546,
                                            0.0149,
                                            0.127,
                                            {0.019678, 0.799225, 0.207443},
                                            {0.000027, 0.000209, 0.000243},
                                            {0.022694, 0.796274, 0.207367}}}};

std::array<double, 3> budget(const Canopy& canopy, double hot_spot) {
  Problem problem;
  problem.layers.push_back(
      {.thickness = 3.,
       .medium = LeafScattering{
           .reflectance = canopy.reflectance, .transmittance = canopy.transmittance, .hot_spot = hot_spot}});
  problem.beam = Beam{.mu0 = std::cos(20. * std::numbers::pi / 180.)};
  problem.ground.albedo = canopy.soil;
  Solver solver({.streams = 32});
  solver.solve(problem);
  return {solver.reflectance(), solver.absorptance(), solver.transmittance()};
}

TEST(P10_Leaves, AreTheTurbidCanopyOfMonteCarlo) {
  for (const Canopy& canopy : kCanopies) {
    const auto ours = budget(canopy, 0.);
    for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(ours[i] - canopy.turbid[i]) / canopy.error[i], 3.) << i;
  }
}

TEST(P11_HotSpot, BringsTheCanopyNearerToDiscreteLeaves) {
  for (const Canopy& canopy : kCanopies) {
    const auto without = budget(canopy, 0.), with = budget(canopy, 0.2);
    EXPECT_NEAR(with[0] + with[1] + (1. - canopy.soil) * with[2], 1., 1e-12);
    EXPECT_LT(std::abs(with[0] - canopy.discrete[0]), 0.15 * std::abs(without[0] - canopy.discrete[0]));
    // What leaves absorb in the near infrared comes out as near as without (0.0023), in the red four times nearer;
    // nowhere further by more than the reference's own error.
    EXPECT_LT(std::abs(with[1] - canopy.discrete[1]), std::abs(without[1] - canopy.discrete[1]) + canopy.error[1]);
    EXPECT_LT(std::abs(with[2] - canopy.discrete[2]), std::abs(without[2] - canopy.discrete[2]) + canopy.error[2]);
  }
}

}  // namespace
}  // namespace sunfleck::pp
