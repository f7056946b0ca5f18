// Check that emission by layers, ground and skies obeys Kirchhoff's law, and that which is linear in depth its
// integral.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "pp_solver_problems.hpp"

namespace {

using namespace sunfleck;
using test::hgLayer;
using test::kInfinity;
constexpr double pi = std::numbers::pi;

pp::Layer leafLayer(double area_index, double reflectance, double transmittance) {
  return {.thickness = area_index,
          .medium = LeafScattering{
              .angles = LeafAngles::planophile(), .reflectance = reflectance, .transmittance = transmittance}};
}

// The same layer in `count` parts of one temperature each.
pp::Problem inParts(const pp::Layer& layer, int count) {
  pp::Problem problem{.layers = std::vector<pp::Layer>(count, layer)};
  for (int i = 0; i < count; ++i) {
    pp::Layer& part = problem.layers[i];
    part.thickness = layer.thickness / count;
    part.emission_top = part.emission_bottom =
        layer.emission_top + (i + 0.5) / count * (layer.emission_bottom - layer.emission_top);
  }
  return problem;
}

// A closed cavity of one temperature, where radiance is B everywhere whatever scatters.
TEST(P14_Emission, OfAnIsothermalCavityIsBlackbodyRadiance) {
  constexpr double B = 2.5;
  for (const bool collocation : {false, true})
    for (const double albedo : {0., 0.6, 1. - 1e-10, 1.})
      for (const double ground_albedo : {0., 0.7, 1.}) {
        SCOPED_TRACE(testing::Message() << "omega " << albedo << " ground " << ground_albedo << " " << collocation);
        pp::Solver solver({.streams = 16, .collocation = collocation});
        pp::Problem problem{.above = B};
        problem.layers = {hgLayer(0.8, albedo, 0.5), hgLayer(0.8, albedo), hgLayer(0.8, albedo, -0.8),
                          leafLayer(0.8, 0.7 * albedo, albedo - 0.7 * albedo)};
        for (pp::Layer& layer : problem.layers) layer.emission_top = layer.emission_bottom = B;
        problem.ground.albedo = ground_albedo;
        problem.ground.emission = B;
        solver.solve(problem);
        for (const double depth : {0., 0.5, 0.8, 2.4, 3.}) {
          const pp::Fluxes fluxes = solver.fluxes(depth);
          EXPECT_NEAR(fluxes.up, pi * B, 1e-12) << depth;
          EXPECT_NEAR(fluxes.down, pi * B, 1e-12) << depth;
          EXPECT_NEAR(fluxes.mean_intensity, B, 1e-12) << depth;
          for (const double mu : {-1., -0.37, -0.01, 0.01, 0.37, 1.})
            EXPECT_NEAR(solver.radiance(depth, mu, 1.), B, 1e-12) << depth << " mu " << mu;
        }
      }
}

// Without scattering: I(0, -mu) = B0 + B' mu (1 - e^(-w / mu)) - B0 e^(-w / mu) - ... in closed form, and the ground
// behind it. Leaves all alike in every direction are particles of half the thickness.
TEST(P14_Emission, LinearInDepthIsIntegrated) {
  pp::Layer leaves{.thickness = 3., .medium = LeafScattering{.reflectance = 0., .transmittance = 0.}};
  for (const bool collocation : {false, true})
    for (pp::Layer layer : {hgLayer(1.5, 0.), leaves}) {
      pp::Solver solver({.streams = 16, .collocation = collocation});
      layer.emission_top = 1.;
      layer.emission_bottom = 4.;
      pp::Problem problem{.layers = {layer}};
      problem.ground.emission = 5.;
      solver.solve(problem);
      const double slope = 2.;
      for (const double mu : {1., 0.5, 0.05}) {
        const double left = std::exp(-1.5 / mu);
        EXPECT_NEAR(solver.radiance(0., -mu, 0.), 1. + slope * mu - (4. + slope * mu) * left + 5. * left, 1e-12) << mu;
        EXPECT_NEAR(solver.radiance(layer.thickness, mu, 0.), 4. - slope * mu - (1. - slope * mu) * left, 1e-12) << mu;
      }
    }
}

// Parts of one temperature each: what they leave out falls with the square of their number, and after Richardson's step
// with the fourth power, below 1e-2 of it. The particles have no moment N - 1: views would receive mu by it, by 7e-3
// otherwise than in truth, which the slope's own solution does not.
TEST(P14_Emission, LinearInDepthIsTheLimitOfManyLayers) {
  constexpr std::array mus{-0.9, -0.3, 0.3, 0.9};
  const pp::Layer particles{.thickness = 2., .medium = Particles{0.9, PhaseFunction::fromMoments({1., 0.5, 0.2})}};
  for (const bool collocation : {false, true})
    for (pp::Layer layer : {particles, leafLayer(3., 0.5, 0.4)}) {
      layer.emission_top = 3.;
      layer.emission_bottom = 1.;
      pp::Solver solver({.streams = 4, .collocation = collocation});
      const auto light = [&](const pp::Problem& problem) {
        solver.solve(problem);
        std::vector<double> result(mus.size());
        solver.radiances(std::array{0.25 * layer.thickness}, mus, std::array{0.}, result);
        result.push_back(solver.fluxes(0.).up);
        result.push_back(solver.fluxes(layer.thickness).down);
        result.push_back(solver.fluxes(0.25 * layer.thickness).mean_intensity);
        return result;
      };
      const std::vector<double> whole = light({.layers = {layer}}), few = light(inParts(layer, 16)),
                                more = light(inParts(layer, 32));
      for (std::size_t i = 0; i < whole.size(); ++i) {
        const double difference = few[i] - more[i];
        EXPECT_GT(std::abs(difference), 1e-6) << i;
        EXPECT_NEAR(more[i] - difference / 3., whole[i], 1e-2 * std::abs(difference)) << i << " " << collocation;
      }
    }
}

// All of it put back into the equation at the nodes: rounding, ten times that of the beam alone (3e-12 at N = 32).
TEST(P14_Emission, LinearInDepthLeavesNoResidual) {
  for (const bool collocation : {false, true})
    for (const int streams : {4, 16, 32}) {
      pp::Solver solver({.streams = streams, .collocation = collocation});
      pp::Problem problem{.layers = {hgLayer(0.7, 0.9, 0.7), leafLayer(1.5, 0.5, 0.45), leafLayer(0.3, 0.1, 0.)},
                          .beam = pp::Beam{.mu0 = 0.6}};
      for (std::size_t p = 0; p < 3; ++p) {
        problem.layers[p].emission_top = 3. - static_cast<double>(p);
        problem.layers[p].emission_bottom = 2. - static_cast<double>(p);
      }
      solver.solve(problem);
      EXPECT_LE(solver.residual(), 1e-11) << streams << " " << collocation;
    }
}

// Two discretizations of one problem: both within 1e-9 of the limit at 64 directions, and apart at 8.
TEST(P14_Emission, OfBothDiscretizationsHasOneLimit) {
  pp::Layer layer = hgLayer(1., 0.8, 0.7);
  layer.emission_top = 1.;
  layer.emission_bottom = 4.;
  const auto apart = [&](int streams) {
    double largest = 0.;
    std::array<double, 2> radiances{};
    for (const double mu : {-0.9, -0.2, 0.2, 0.9}) {
      for (const bool collocation : {false, true}) {
        pp::Solver solver({.streams = streams, .collocation = collocation});
        solver.solve({.layers = {layer}});
        radiances[collocation] = solver.radiance(0.4, mu, 0.);
      }
      largest = std::max(largest, std::abs(radiances[0] - radiances[1]));
    }
    return largest;
  };
  EXPECT_GT(apart(8), 1e-6);
  EXPECT_LT(apart(64), 1e-9);
}

// Of a layer too thin for its ends to differ the mean is emitted, 4 pi w upward by one of mean 2 that does not scatter;
// 1e-3 is more than what is absorbed again, w log w, and what 128 directions miss of it. Rounding is that of B where
// the mean is taken, and that of h = 2 mu / w where it just is not.
TEST(P14_Emission, OfThinLayersIsOfTheirMean) {
  for (const double thickness : {1e-100, 1e-12, 9e-7, 1.1e-6}) {
    pp::Layer layer = hgLayer(thickness, 0.);
    layer.emission_top = 1.;
    layer.emission_bottom = 3.;
    pp::Solver solver({.streams = 128});
    solver.solve({.layers = {layer}});
    EXPECT_NEAR(solver.fluxes(0.).up, 4. * pi * thickness,
                1e-3 * thickness + (thickness < 1e-6 ? 1e-14 : 3e-15 / thickness))
        << thickness;
    EXPECT_NEAR(solver.radiance(0., -0.5, 0.), 4. * thickness, 1e-5 * thickness) << thickness;
  }
}

// A semi-infinite isothermal slab emits what it does not reflect of a sky: Kirchhoff's law again, open above.
TEST(P14_Emission, OfASemiInfiniteSlabIsOneLessReflectance) {
  pp::Solver solver({.streams = 16});
  for (const double albedo : {0.3, 0.99}) {
    solver.solve({.layers = {hgLayer(kInfinity, albedo, 0.5)}, .above = 1.});
    const double reflectance = solver.reflectance();
    pp::Problem problem{.layers = {hgLayer(kInfinity, albedo, 0.5)}};
    problem.layers[0].emission_top = problem.layers[0].emission_bottom = 1.;
    solver.solve(problem);
    EXPECT_NEAR(solver.fluxes(0.).up, pi * (1. - reflectance), 1e-12) << albedo;
  }
}

}  // namespace
