// Check that the exact solver meets limits that are known in closed form, and passes smoothly through its special
// cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "pp_solver_problems.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::test;
using std::numbers::inv_pi;
using std::numbers::pi;

// Check leaves that scatter nothing: direct light, and what the ground sends back of it. Error: roundings.
TEST(Limit, BeersLawAtAlbedoZero) {
  pp::Solver solver({.streams = 16});
  for (const double mu0 : {1., 0.3, 1e-3})
    for (const double thickness : {1e-8, 1., 20.}) {
      pp::Problem problem = slab(thickness, 0., 0.5, mu0);
      problem.ground.albedo = 0.4;
      solver.solve(problem);
      const double left = std::exp(-thickness / mu0);
      EXPECT_NEAR(solver.transmittance(), left, 1e-15);
      EXPECT_NEAR(solver.direct(), left, 1e-15);
      EXPECT_EQ(solver.radiance(thickness, 0.7, 0.), 0.);
      for (const double mu : {1., 0.2})
        EXPECT_NEAR(solver.radiance(0., -mu, 1.), 0.4 * mu0 * left * inv_pi * std::exp(-thickness / mu), 1e-15);
      solver.solve(slab(thickness, 0., 0.5, mu0));
      EXPECT_EQ(solver.reflectance(), 0.);
    }
}

// Check that a sky given by direction arrives where nothing scatters, and that a sky of one radiance may be given both
// ways.
TEST(Limit, SkyAtAlbedoZero) {
  const auto sky = [](double mu, double phi) { return 1. + mu + 0.5 * std::sqrt(1. - mu * mu) * std::cos(phi - 1.); };
  pp::Solver solver({.streams = 16});
  solver.solve({.layers = {hgLayer(1.3, 0.)}, .above = sky, .below = sky});
  for (const double mu : {1., 0.4, 0.1})
    for (const double phi : {0., 2.}) {
      EXPECT_NEAR(solver.radiance(1.3, mu, phi), sky(mu, phi) * std::exp(-1.3 / mu), 1e-13) << mu;
      EXPECT_NEAR(solver.radiance(0., -mu, phi), sky(mu, phi) * std::exp(-1.3 / mu), 1e-13) << mu;
    }
  solver.solve({.layers = {hgLayer(1.3, 0.9, 0.5)}, .above = [](double, double) { return 3.; }});
  const double reflectance = solver.reflectance();
  solver.solve({.layers = {hgLayer(1.3, 0.9, 0.5)}, .above = 3.});
  EXPECT_NEAR(solver.reflectance(), reflectance, 1e-13);
}

// Check albedo 1 against the number next below it. In a slab of thickness 10 that costs some tau^2 * 1e-16 of the
// light.
TEST(Limit, AlbedoOneIsApproachedSmoothly) {
  pp::Solver solver({.streams = 16});
  for (const double asymmetry : {0., 0.85, -0.5}) {
    solver.solve(slab(10., 1., asymmetry, 0.5));
    const double reflectance = solver.reflectance(), radiance = solver.radiance(3., -0.4, 1.);
    for (const double missing : {0x1p-53, 1e-15, 1e-14}) {
      solver.solve(slab(10., 1. - missing, asymmetry, 0.5));
      EXPECT_NEAR(solver.reflectance(), reflectance, 1e-12 + 200. * missing) << missing;
      EXPECT_NEAR(solver.radiance(3., -0.4, 1.), radiance, 1e-12 + 200. * missing) << missing;
    }
  }
}

// Values that the beam's angle changes: shares and radiances inside.
std::array<double, 4> valuesAt(pp::Solver& solver, double albedo, double asymmetry, double mu0) {
  solver.solve(slab(2., albedo, asymmetry, mu0));
  return {solver.reflectance(), solver.transmittance(), solver.radiance(0.5, -0.6, 1.) / mu0,
          solver.radiance(1.1, 0.6, 1.) / mu0};
}

// f(mu0 + d) + f(mu0 - d) - 2 f(mu0) is f'' d^2 where f is smooth; f'' is below 100 for mu0 > 0.1. A formula that
// divides by a difference of rates loses 1e-16 / d instead: what is allowed beside d^2 is 1e-12.
void expectSmooth(int streams, double albedo, double asymmetry, double mu0) {
  pp::Solver solver({.streams = streams});
  const auto middle = valuesAt(solver, albedo, asymmetry, mu0);
  for (const double away : {1e-16, 1e-15, 1e-13, 1e-11, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4}) {
    if (mu0 * (1. + away) > 1.) continue;
    const auto above = valuesAt(solver, albedo, asymmetry, mu0 * (1. + away));
    const auto below = valuesAt(solver, albedo, asymmetry, mu0 * (1. - away));
    for (std::size_t i = 0; i < middle.size(); ++i)
      EXPECT_NEAR(0.5 * (above[i] + below[i]), middle[i], 1e-12 + 100. * away * away)
          << "N " << streams << " omega " << albedo << " g " << asymmetry << " mu0 " << mu0 << " +- " << away
          << " value " << i;
  }
}

// Check two directions, whose only rate is known, k = 2 sqrt(1 - omega), at mu0 = 1 / k.
TEST(Resonance, OfTwoStreams) {
  for (const double albedo : {0.3, 0.64, 0.7}) expectSmooth(2, albedo, 0., 0.5 / std::sqrt(1. - albedo));
}

// The rates k > 1 of isotropic scattering: roots of 1 = omega sum of w / (1 - mu^2 k^2) over the nodes, one between
// each two neighbouring 1 / mu (Chandrasekhar 1960, section 21).
template <unsigned Half>
std::vector<double> isotropicRates(double albedo) {
  auto nodes = gaussNodes<Half>();
  std::ranges::sort(nodes, std::greater{});
  const auto left_side = [&](double k) {
    double sum = -1.;
    for (const auto& [mu, weight] : nodes) sum += albedo * weight / (1. - mu * mu * k * k);
    return sum;
  };
  std::vector<double> rates;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    double low = 1. / nodes[i][0], high = 1. / nodes[i + 1][0];  // the sum rises from -infinity to infinity
    for (int step = 0; step < 200; ++step) {
      const double middle = 0.5 * (low + high);
      (left_side(middle) < 0. ? low : high) = middle;
    }
    rates.push_back(low);
  }
  return rates;
}

// Check every rate of 8 and of 16 directions that a beam steeper than 0.1 can meet.
TEST(Resonance, OfManyStreams) {
  for (const double albedo : {0.5, 0.95, 1.}) {
    int met = 0;
    for (const double rate : isotropicRates<2>(albedo))
      if (rate < 10.) expectSmooth(8, albedo, 0., 1. / rate), ++met;
    for (const double rate : isotropicRates<4>(albedo))
      if (rate < 10.) expectSmooth(16, albedo, 0., 1. / rate), ++met;
    EXPECT_GE(met, 6);
  }
}

// Check a beam along a node, where scattered light and beam decay alike.
TEST(Resonance, OfABeamAlongANode) {
  for (const double albedo : {0., 0.9, 1.})
    for (const double asymmetry : {0., 0.5})
      for (const auto& [mu, weight] : gaussNodes<4>())
        if (mu > 0.1) expectSmooth(16, albedo, asymmetry, mu);
}

// Check that a line of sight along a node, beside it and along the beam gives what lines around it do: radiance is
// smooth in mu, with a second derivative below 100 here.
TEST(Resonance, OfALineOfSight) {
  pp::Solver solver({.streams = 16});
  std::vector<double> special{0.5};
  for (const auto& [mu, weight] : gaussNodes<4>())
    if (mu > 0.1) special.push_back(mu);
  for (const double asymmetry : {0., 0.5}) {
    solver.solve(slab(2., 0.9, asymmetry, 0.5));
    for (const double mu : special)
      for (const double sign : {-1., 1.}) {
        const double middle = solver.radiance(1., sign * mu, 1.);
        for (const double away : {1e-16, 1e-14, 1e-11, 1e-8, 1e-6, 1e-4}) {
          const double around =
              solver.radiance(1., sign * mu * (1. + away), 1.) + solver.radiance(1., sign * mu * (1. - away), 1.);
          EXPECT_NEAR(0.5 * around, middle, 1e-12 + 100. * away * away) << "mu " << sign * mu << " +- " << away;
        }
      }
  }
}

// Check infinite thickness against 1e9, where only e^(-k 1e9) is left for albedo below 1, and against twice as much.
TEST(Limit, InfiniteThickness) {
  pp::Solver solver({.streams = 16});
  for (const double albedo : {0.5, 0.99, 1. - 1e-12}) {
    solver.solve(slab(kInfinity, albedo, 0.5, 0.7));
    const double reflectance = solver.reflectance(), radiance = solver.radiance(0., -0.3, 2.),
                 inside = solver.radiance(5., -0.3, 2.);
    EXPECT_EQ(solver.transmittance(), 0.);
    solver.solve(slab(1e9, albedo, 0.5, 0.7));
    EXPECT_NEAR(solver.reflectance(), reflectance, 1e-12) << albedo;
    EXPECT_NEAR(solver.radiance(0., -0.3, 2.), radiance, 1e-12) << albedo;
    EXPECT_NEAR(solver.radiance(5., -0.3, 2.), inside, 1e-12) << albedo;
  }
  // At albedo 1, thickness w lets 4/3 (mu0 + q) / (2 w) through or so: 1e-9 is the last digit but three.
  solver.solve(slab(kInfinity, 1., 0., 0.7));
  EXPECT_NEAR(solver.reflectance(), 1., 1e-12);
  const double radiance = solver.radiance(0., -0.3, 2.);
  solver.solve(slab(1e9, 1., 0., 0.7));
  EXPECT_NEAR(solver.radiance(0., -0.3, 2.), radiance, 3e-9);
}

// Check thin slabs against light scattered once: R = omega tau / (2 mu0) for isotropic scattering, radiance
// omega tau / (4 pi mu). Light scattered twice adds the square, times a logarithm; roundings add 1e-15.
TEST(Limit, SingleScatteringInThinSlabs) {
  pp::Solver solver({.streams = 16});
  for (const double thickness : {1e-12, 1e-9, 1e-6})
    for (const double mu0 : {1., 0.5, 0.1}) {
      const double tolerance = 1e-15 + 20. * thickness * thickness / (mu0 * mu0);
      solver.solve(slab(thickness, 0.8, 0., mu0));
      EXPECT_NEAR(solver.reflectance(), 0.8 * thickness / (2. * mu0), tolerance) << thickness;
      EXPECT_NEAR(1. - solver.transmittance() - solver.reflectance(), 0.2 * thickness / mu0, tolerance) << thickness;
      for (const double mu : {1., 0.3}) {
        EXPECT_NEAR(solver.radiance(0., -mu, 0.), 0.8 * thickness / (4. * pi * mu), tolerance / mu) << thickness;
        EXPECT_NEAR(solver.radiance(thickness, mu, 0.), 0.8 * thickness / (4. * pi * mu), tolerance / mu) << thickness;
      }
    }
}

// Check lines of sight at the ends of their range. Within 1e-4 of the horizon light comes from within an optical path
// of 1e-4, so that radiance inside is the source there, alike from both sides; straight up and down it is the limit.
TEST(Limit, GrazingAndVerticalLinesOfSight) {
  pp::Solver solver({.streams = 16});
  solver.solve(slab(2., 0.9, 0.5, 0.6));
  for (const double phi : {0., 2.}) {
    const double down = solver.radiance(1., 1e-4, phi), up = solver.radiance(1., -1e-4, phi);
    EXPECT_NEAR(down, up, 1e-3 * up);
    EXPECT_NEAR(solver.radiance(1., 1e-4, phi), solver.radiance(1., 2e-4, phi), 1e-3 * up);
    // At mu = 1 the azimuth means nothing; the series' modes fall as sin(theta)^m, 1e-5 for m = 1 at 1 - 5e-11.
    for (const double sign : {-1., 1.})
      EXPECT_NEAR(solver.radiance(1., sign, phi), solver.radiance(1., sign * (1. - 5e-11), phi), 2e-5);
  }
  EXPECT_NEAR(solver.radiance(1., 1., 0.), solver.radiance(1., 1., 2.), 1e-14);
}

// Check that a Lambertian ground may be given as a BRDF.
TEST(Ground, LambertiansBrdfIsItsAlbedoOverPi) {
  pp::Solver solver({.streams = 16});
  pp::Problem problem = threeLayers(0.6);
  solver.solve(problem);
  const double reflectance = solver.reflectance(), radiance = solver.radiance(0., -0.4, 1.);
  problem.ground = {.brdf = [](int mode, double, double) { return mode == 0 ? 0.3 * inv_pi : 0.; }, .brdf_modes = 1};
  solver.solve(problem);
  EXPECT_NEAR(solver.reflectance(), reflectance, 1e-13);
  EXPECT_NEAR(solver.radiance(0., -0.4, 1.), radiance, 1e-13);
  problem.ground = pp::groundOf([](double, double, double) { return 0.3 * inv_pi; }, 4);
  solver.solve(problem);
  EXPECT_NEAR(solver.reflectance(), reflectance, 1e-13);
}

// Check that a directional ground under a thin black layer is seen as it is: radiance f(mu, mu0, phi) mu0, a mirror's
// peak where the azimuth of travel stays.
TEST(Ground, BrdfIsSeenThroughAThinLayer) {
  const auto brdf = [](double mu, double mu_in, double azimuth) {
    return 0.1 * mu * mu_in * (1. + 0.5 * std::cos(azimuth));
  };
  pp::Problem problem = slab(1e-12, 0., 0., 0.7);
  problem.beam->azimuth = 0.3;
  problem.ground = pp::groundOf(brdf, 4);
  pp::Solver solver({.streams = 16});
  solver.solve(problem);
  for (const double mu : {1., 0.4})
    for (const double azimuth : {0., 1., 3.})
      EXPECT_NEAR(solver.radiance(0., -mu, 0.3 + azimuth), brdf(mu, 0.7, azimuth) * 0.7, 1e-11) << mu << " " << azimuth;
}

}  // namespace
