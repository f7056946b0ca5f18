// Check that the exact solver keeps the identities of radiative transfer: energy, reciprocity, symmetry, splitting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pp_solver/slab_batch.hpp"
#include "pp_solver_problems.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::test;

// Check that nothing is lost at albedo 1. R and T are shares near 1 and are told to 1e-12, thousands of roundings; an
// error of the albedo by one rounding alone would cost sqrt(3e-16) tau, all light, at the thickest.
TEST(Energy, IsConservedAtAlbedoOne) {
  for (const int streams : {2, 4, 6, 8, 16, 32, 64, 128}) {
    pp::Solver solver({.streams = streams});
    for (const double thickness : {1e-8, 1e-3, 1., 100., 1e6, 1e9})
      for (const double asymmetry : {0., 0.85, -0.5})
        for (const double mu0 : {1., 0.3, 1e-3}) {
          solver.solve(slab(thickness, 1., asymmetry, mu0));
          EXPECT_NEAR(solver.reflectance() + solver.transmittance(), 1., 1e-12)
              << "N " << streams << " tau " << thickness << " g " << asymmetry << " mu0 " << mu0;
          EXPECT_NEAR(solver.absorptance(), 0., 1e-12);
        }
  }
}

// Check that a ground of albedo 1 under layers of albedo 1 sends all light back.
TEST(Energy, IsConservedOverAWhiteGround) {
  pp::Solver solver({.streams = 16});
  for (const double thickness : {1e-8, 1., 1e6}) {
    pp::Problem problem = slab(thickness, 1., 0.5, 0.4);
    problem.layers.push_back(hgLayer(2., 1., 0.));
    problem.ground.albedo = 1.;
    solver.solve(problem);
    EXPECT_NEAR(solver.reflectance(), 1., 1e-12) << thickness;
  }
}

// Check R + T + A = 1 with A from the mean intensity, that is by another formula than R and T: roundings.
TEST(Energy, IsReflectedTransmittedOrAbsorbed) {
  for (const int streams : {2, 8, 32, 128}) {
    pp::Solver solver({.streams = streams});
    for (const double albedo : {0., 0.3, 0.9, 0.999999, 1. - 1e-12})
      for (const double thickness : {1e-8, 1., 30., 1e6})
        for (const double asymmetry : {0., 0.85, -0.5}) {
          solver.solve(slab(thickness, albedo, asymmetry, 0.6));
          EXPECT_NEAR(solver.reflectance() + solver.transmittance() + solver.absorptance(), 1., 1e-12)
              << "N " << streams << " tau " << thickness << " omega " << albedo << " g " << asymmetry;
        }
  }
}

// Gauss's rule of 20 points on each of `panels` parts of a layer: mean intensity of 8 directions is a sum of
// exponentials whose rates are at most 1 / mu of the lowest node, 15 (20 with delta-M's shorter depth); over 1/20 of a
// thickness of 3 that rule is exact to rounding.
double absorbedByQuadrature(const pp::Solver& solver, double top, double bottom, double albedo) {
  constexpr int panels = 20;
  double sum = 0.;
  for (int panel = 0; panel < panels; ++panel)
    for (const auto& [x, weight] : gaussNodes<10>()) {
      const double width = (bottom - top) / panels;
      const double depth = top + (panel + x) * width;
      sum += weight * width * (1. - albedo) * 4. * std::numbers::pi * solver.fluxes(depth).mean_intensity;
    }
  return sum;
}

// Check the absorbed flux against the integral of the mean intensity, and the fluxes against both.
TEST(Energy, IsAbsorbedAsTheMeanIntensitySays) {
  pp::Solver solver({.streams = 8});
  for (const double albedo : {0., 0.5, 0.95})
    for (const double asymmetry : {0., 0.85, -0.5}) {
      SCOPED_TRACE(testing::Message() << "omega " << albedo << " g " << asymmetry);
      pp::Problem problem = slab(3., albedo, asymmetry, 0.4);
      problem.ground.albedo = 0.2;
      solver.solve(problem);
      const double expected = absorbedByQuadrature(solver, 0., 3., albedo);
      EXPECT_NEAR(solver.absorptance() * solver.incident(), expected, 1e-12);
      EXPECT_NEAR(solver.absorbed(0., 3.), expected, 1e-12);
      EXPECT_NEAR(solver.absorbed(0.7, 1.9), absorbedByQuadrature(solver, 0.7, 1.9, albedo), 1e-12);
      const pp::Fluxes top = solver.fluxes(0.7), bottom = solver.fluxes(1.9);
      EXPECT_NEAR(top.down + top.direct - top.up - (bottom.down + bottom.direct - bottom.up), solver.absorbed(0.7, 1.9),
                  1e-12);
    }
}

// Check that a conservative slab shares the light of a uniform sky, and of one below, into reflected and transmitted.
TEST(Energy, OfASkyIsConservedAtAlbedoOne) {
  pp::Solver solver({.streams = 16});
  for (const double thickness : {1e-6, 1., 1e6}) {
    solver.solve({.layers = {hgLayer(thickness, 1., 0.5)}, .above = 2.});
    EXPECT_NEAR(solver.incident(), 2. * std::numbers::pi, 1e-13);
    EXPECT_NEAR(solver.reflectance() + solver.transmittance(), 1., 1e-12) << thickness;
    const double reflectance = solver.reflectance();
    solver.solve({.layers = {hgLayer(thickness, 1., 0.5)}, .below = 1.});
    // From below the same slab reflects as much; `reflectance` is then what goes up at the top, the transmitted part.
    EXPECT_NEAR(solver.fluxes(0.).up / std::numbers::pi, 1. - reflectance, 1e-12) << thickness;
    EXPECT_NEAR(solver.fluxes(thickness).down / std::numbers::pi, reflectance, 1e-12) << thickness;
  }
}

// Check that exchanging beam and line of sight changes nothing but for the beam's irradiance, mu0: reciprocity holds
// for the discrete problem too, so up to roundings.
TEST(Reciprocity, OfReflectedRadiance) {
  pp::Solver solver({.streams = 32});
  const std::vector<double> mus{1., 0.83, 0.5, 0.12};
  for (const double azimuth : {0., 0.9, std::numbers::pi})
    for (const double mu : mus)
      for (const double mu0 : mus) {
        solver.solve(threeLayers(mu0));
        const double forth = solver.radiance(0., -mu, azimuth) / mu0;
        solver.solve(threeLayers(mu));
        const double back = solver.radiance(0., -mu0, azimuth) / mu;
        EXPECT_NEAR(forth, back, 1e-10) << mu << " " << mu0 << " " << azimuth;
      }
}

TEST(Reciprocity, OfTransmittedRadiance) {
  pp::Solver solver({.streams = 32});
  for (const double azimuth : {0., 0.9, 3.})
    for (const double mu : {1., 0.5, 0.12}) {
      solver.solve(slab(2., 0.9, 0.5, 0.7));
      const double forth = solver.radiance(2., mu, azimuth) / 0.7;
      solver.solve(slab(2., 0.9, 0.5, mu));
      const double back = solver.radiance(2., 0.7, azimuth) / mu;
      EXPECT_NEAR(forth, back, 1e-10) << mu << " " << azimuth;
    }
}

// Check that a layer is the sum of its parts, equal or not, in fluxes and radiances at every depth.
TEST(Splitting, ChangesNothing) {
  for (const double asymmetry : {0., 0.85})
    for (const double albedo : {0.8, 1.}) {
      pp::Solver whole({.streams = 16}), parts({.streams = 16});
      whole.solve(slab(4., albedo, asymmetry, 0.5));
      for (const std::vector<double>& shares :
           {std::vector<double>{0.5, 0.5}, {1e-9, 1. - 1e-9}, {0.1, 0.2, 0.05, 0.05, 0.3, 0.2, 0.1}}) {
        pp::Problem problem{.beam = pp::Beam{.mu0 = 0.5}};
        double bottom = 0.;
        for (const double share : shares) {
          problem.layers.push_back(hgLayer(4. * share, albedo, asymmetry));
          bottom += 4. * share;
        }
        parts.solve(problem);
        EXPECT_NEAR(parts.reflectance(), whole.reflectance(), 1e-10);
        EXPECT_NEAR(parts.transmittance(), whole.transmittance(), 1e-10);
        for (const double depth : {0., 0.4, 1.7, std::min(bottom, 4.)}) {
          EXPECT_NEAR(parts.fluxes(depth).mean_intensity, whole.fluxes(depth).mean_intensity, 1e-10);
          for (const double mu : {-0.9, -0.2, 0.3, 1.})
            EXPECT_NEAR(parts.radiance(depth, mu, 0.7), whole.radiance(depth, mu, 0.7), 1e-10)
                << "g " << asymmetry << " omega " << albedo << " parts " << shares.size() << " depth " << depth
                << " mu " << mu;
        }
      }
    }
}

// Check that the light is the same on both sides of the sun's plane, and turns with the sun.
TEST(Azimuth, IsCountedFromTheSunsPlane) {
  pp::Solver solver({.streams = 16});
  for (const double mu : {-0.7, 0.4})
    for (const double away : {0.3, 1.5, 3.}) {
      solver.solve(threeLayers(0.6));
      const double expected = solver.radiance(1., mu, away);
      EXPECT_NEAR(solver.radiance(1., mu, -away), expected, 1e-14);
      solver.solve(threeLayers(0.6, 2.2));
      EXPECT_NEAR(solver.radiance(1., mu, 2.2 + away), expected, 1e-13);
      EXPECT_NEAR(solver.radiance(1., mu, 2.2 - away), expected, 1e-13);
    }
  EXPECT_GT(solver.azimuthModes(), 2);
  solver.solve(threeLayers(1.));
  EXPECT_NEAR(solver.radiance(1., 0.4, 0.), solver.radiance(1., 0.4, 2.), 1e-14);
}

// Check that mean intensity is positive everywhere and, under a sky alone, falls with depth where light is absorbed.
TEST(MeanIntensity, IsPositiveAndFallsUnderASky) {
  pp::Solver solver({.streams = 16});
  for (const double albedo : {0.1, 0.9, 0.999}) {
    solver.solve(slab(20., albedo, 0.85, 0.1));
    for (double depth = 0.; depth <= 20.; depth += 0.25) EXPECT_GT(solver.fluxes(depth).mean_intensity, 0.) << depth;
    solver.solve({.layers = {hgLayer(20., albedo, 0.5)}, .above = 1.});
    for (double depth = 0.; depth < 20.; depth += 0.25)
      EXPECT_GT(solver.fluxes(depth).mean_intensity, solver.fluxes(depth + 0.25).mean_intensity)
          << albedo << " " << depth;
  }
}

// Check that a solution meets its equation: 1e-11 of the largest radiance, at all nodes, by derivatives of its own.
TEST(Residual, IsRounding) {
  for (const int streams : {2, 8, 32, 64}) {
    pp::Solver solver({.streams = streams});
    solver.solve(threeLayers(0.6));
    EXPECT_LE(solver.residual(streams / 2), 1e-11) << streams;
    for (const double albedo : {0., 0.9, 1.}) {
      solver.solve(slab(10., albedo, 0.85, 0.3));
      EXPECT_LE(solver.residual(streams), 1e-11) << streams << " omega " << albedo;
    }
  }
}

// Check that a batch gives what single solves give, in order, corners among them, for a number of cases that fills no
// vector: some roundings apart.
TEST(Batch, IsManySolves) {
  std::vector<pp::SlabCase> cases;
  for (const double asymmetry : {0., 0.999, -0.999, 0.5})
    for (const double albedo : {0., 0.5, 1. - 1e-16, 1.})
      for (const double thickness : {1e-12, 1., 1e9, kInfinity})
        for (const double mu0 : {1., 0.5, 1e-4}) cases.push_back({asymmetry, albedo, thickness, mu0});
  cases.push_back({0.3, 0.7, 2., 0.9});
  for (const int streams : {2, 4, 8, 16, 32}) {
    std::vector<pp::SlabFluxes> fluxes(cases.size());
    solveSlabs(cases, fluxes, streams);
    pp::Solver solver({.streams = streams});
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto [asymmetry, albedo, thickness, mu0] = cases[i];
      SCOPED_TRACE(testing::Message() << "N " << streams << " g " << asymmetry << " omega " << albedo << " tau "
                                      << thickness << " mu0 " << mu0);
      solver.solve(slab(thickness, albedo, asymmetry, mu0));
      EXPECT_NEAR(fluxes[i].reflectance, solver.reflectance(), 1e-12);
      EXPECT_NEAR(fluxes[i].transmittance, solver.transmittance(), 1e-12);
      EXPECT_NEAR(fluxes[i].direct, solver.direct(), 1e-15);
    }
  }
}

}  // namespace
