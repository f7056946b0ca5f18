// Check that the exact solver agrees with adding and doubling, and with Chandrasekhar's H function.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "adding_doubling.hpp"
#include "chandrasekhar_h.hpp"
#include "pp_solver/solver.hpp"

namespace {

using namespace sunfleck;
using witness::AddingDoubling;
using witness::henyeyGreensteinMoments;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What the witnesses and the solver must agree to. The witnesses' own errors, from runs with more nodes, are below
// 1e-10.
constexpr double kAgreement = 1e-9;

// Nodes by which the witness is converged: g^l has to fall to 1e-13 by the last moments they carry.
int nodesFor(double asymmetry) {
  return std::abs(asymmetry) > 0.6 ? 100 : 40;
}

pp::Layer hgLayer(double thickness, double albedo, double asymmetry) {
  return {.thickness = thickness, .medium = Particles{albedo, PhaseFunction::henyeyGreenstein(asymmetry)}};
}

// Check the witnesses against each other: a slab of thickness 64 is semi-infinite at albedo .9, where light decays by
// e^(-.52 z).
TEST(Witness, DoublingTendsToChandrasekharsH) {
  const witness::ChandrasekharH h(0.9);
  const std::array mus{1., 0.4, 0.05};
  const std::array phis{0.};
  for (const double mu0 : {1., 0.3, 0.05}) {
    const witness::Stack slab{.layers = {{.thickness = 64., .albedo = 0.9, .moments = {1.}}}};
    EXPECT_NEAR(witness::stackFluxes(slab, mu0, 40).reflectance, h.reflectance(mu0), 1e-10);
    const auto radiances = witness::stackRadiances(slab, mu0, mus, phis, 40);
    for (std::size_t i = 0; i < mus.size(); ++i)
      EXPECT_NEAR(radiances.up_at_top[i], h.radiance(mus[i], mu0), 1e-10) << mus[i] << " " << mu0;
  }
}

// Check that doubling loses no light at albedo 1: some 60 doublings of an error of 2e-16 in each scattering, of which
// there are some tau^2 before light leaves the slab.
TEST(Witness, DoublingConservesEnergy) {
  for (const double asymmetry : {0., 0.5, -0.5})
    for (const double thickness : {1e-6, 1., 16.}) {
      const witness::Stack slab{.layers = {{thickness, 1., henyeyGreensteinMoments(asymmetry)}}};
      const auto fluxes = witness::stackFluxes(slab, 0.37, 50);
      EXPECT_NEAR(fluxes.reflectance + fluxes.transmittance, 1., 2e-12) << asymmetry << " " << thickness;
    }
}

// Check three values of H at albedo 1 that Chandrasekhar 1960, Table XI, prints to five decimals.
TEST(Witness, HIsThePrintedOne) {
  const witness::ChandrasekharH h(1.);
  EXPECT_NEAR(h(0.1), 1.24735, 6e-6);
  EXPECT_NEAR(h(0.5), 2.01278, 6e-6);
  EXPECT_NEAR(h(1.), 2.90781, 6e-6);
}

class AgainstDoubling : public testing::TestWithParam<double> {};

// Check reflectance and transmittance of homogeneous slabs under beams and under a uniform sky. By 128 directions: 64
// are off by 4e-9 where a thin slab is lit at mu0 = .1.
TEST_P(AgainstDoubling, FluxesOfSlabs) {
  const double asymmetry = GetParam();
  const std::array mu0s{1., 0.5, 0.1};
  const AddingDoubling method(nodesFor(asymmetry), mu0s);
  pp::Solver solver({.streams = 128});
  for (const double albedo : {0.5, 0.95, 1.})
    for (const double thickness : {0.1, 1., 16.}) {
      SCOPED_TRACE(testing::Message() << "g " << asymmetry << " omega " << albedo << " tau " << thickness);
      const auto slab = method.layer({thickness, albedo, henyeyGreensteinMoments(asymmetry)}, 0);
      for (std::size_t i = 0; i < mu0s.size(); ++i) {
        solver.solve({.layers = {hgLayer(thickness, albedo, asymmetry)}, .beam = pp::Beam{.mu0 = mu0s[i]}});
        const int column = method.extraNode(static_cast<int>(i));
        EXPECT_NEAR(solver.reflectance(), method.flux(slab.reflection, column), kAgreement) << "mu0 " << mu0s[i];
        EXPECT_NEAR(solver.transmittance(), method.flux(slab.transmission, column) + slab.direct[column], kAgreement)
            << "mu0 " << mu0s[i];
      }
      solver.solve({.layers = {hgLayer(thickness, albedo, asymmetry)}, .above = 1.});
      EXPECT_NEAR(solver.reflectance(), method.flux(slab.reflection), kAgreement) << "sky";
    }
}

INSTANTIATE_TEST_SUITE_P(PhaseFunctions, AgainstDoubling, testing::Values(0., 0.5, -0.5, 0.85),
                         [](const testing::TestParamInfo<double>& asymmetry) {
                           return "G" + std::to_string(asymmetry.index);
                         });

// Three unlike layers: scattering forward, by Rayleigh's law, and backward.
struct Layers {
  pp::Problem problem{.beam = pp::Beam{.mu0 = 0.6, .azimuth = 0.4}};
  witness::Stack stack;

  explicit Layers(double ground_albedo) {
    const std::vector<double> rayleigh{1., 0., 0.1};
    stack = {.layers = {{0.3, 0.9, henyeyGreensteinMoments(0.5)},
                        {1.5, 0.99, rayleigh},
                        {0.7, 0.6, henyeyGreensteinMoments(-0.3)}},
             .ground_albedo = ground_albedo};
    problem.layers = {hgLayer(0.3, 0.9, 0.5),
                      {.thickness = 1.5, .medium = Particles{0.99, PhaseFunction::fromMoments(rayleigh)}},
                      hgLayer(0.7, 0.6, -0.3)};
    problem.ground.albedo = ground_albedo;
  }
};

// Check fluxes of a stack, and those within it, where layers meet.
TEST(StackAgainstDoubling, FluxesOfThreeLayers) {
  for (const double ground_albedo : {0., 0.3, 1.}) {
    SCOPED_TRACE(testing::Message() << "ground " << ground_albedo);
    const Layers layers(ground_albedo);
    const double mu0 = layers.problem.beam->mu0;
    pp::Solver solver({.streams = 64});
    solver.solve(layers.problem);
    const auto expected = witness::stackFluxes(layers.stack, mu0, 40);
    EXPECT_NEAR(solver.reflectance(), expected.reflectance, kAgreement);
    EXPECT_NEAR(solver.transmittance(), expected.transmittance, kAgreement);
    EXPECT_NEAR(solver.incident(), mu0, 1e-15);

    const AddingDoubling method(40, {&mu0, 1});
    std::vector<witness::LayerKernels> kernels;
    for (const auto& layer : layers.stack.layers) kernels.push_back(method.layer(layer, 0));
    const auto above = method.add(kernels[0], kernels[1]);
    const auto below = method.add(kernels[2], method.lambertianGround(ground_albedo, 0));
    const auto light = method.between(above, below);
    const int beam = method.extraNode(0);
    const pp::Fluxes fluxes = solver.fluxes(1.8);
    EXPECT_NEAR(fluxes.down / mu0, method.flux(light.down, beam), kAgreement);
    EXPECT_NEAR(fluxes.up / mu0, method.flux(light.up, beam), kAgreement);
    EXPECT_NEAR(fluxes.direct / mu0, above.direct[beam], 1e-14);
  }
}

// Check radiances out of the stack, all azimuth modes together: grazing and vertical, along the beam, across and back.
TEST(StackAgainstDoubling, RadiancesOfThreeLayers) {
  const std::array mus{1., 0.6, 0.2, 0.05};
  const std::array phis{0., 0.5, 2., std::numbers::pi};
  const Layers layers(0.3);
  const auto expected = witness::stackRadiances(layers.stack, layers.problem.beam->mu0, mus, phis, 48);
  pp::Solver solver({.streams = 64});
  solver.solve(layers.problem);
  for (std::size_t i = 0; i < mus.size(); ++i)
    for (std::size_t j = 0; j < phis.size(); ++j) {
      const double azimuth = phis[j] + layers.problem.beam->azimuth;
      EXPECT_NEAR(solver.radiance(0., -mus[i], azimuth), expected.up_at_top[i * phis.size() + j], kAgreement)
          << mus[i] << " " << phis[j];
      EXPECT_NEAR(solver.radiance(2.5, mus[i], azimuth), expected.down_at_bottom[i * phis.size() + j], kAgreement)
          << mus[i] << " " << phis[j];
    }
}

// Check that delta-M, which moves light from the phase function into the beam, leaves the limit as it is: without it,
// too.
TEST(StackAgainstDoubling, WithoutDeltaM) {
  const Layers layers(0.3);
  const auto expected = witness::stackFluxes(layers.stack, layers.problem.beam->mu0, 40);
  pp::Solver solver({.streams = 64, .delta_m = false, .corrections = false});
  solver.solve(layers.problem);
  EXPECT_NEAR(solver.reflectance(), expected.reflectance, kAgreement);
  EXPECT_NEAR(solver.transmittance(), expected.transmittance, kAgreement);
}

// Check semi-infinite slabs that scatter alike in all directions, to albedo 1.
TEST(AgainstChandrasekharsH, SemiInfiniteSlabs) {
  pp::Solver solver({.streams = 128});
  for (const double albedo : {0.1, 0.5, 0.9, 0.999999, 1.}) {
    const witness::ChandrasekharH h(albedo);
    for (const double mu0 : {1., 0.5, 0.1, 0.01}) {
      SCOPED_TRACE(testing::Message() << "omega " << albedo << " mu0 " << mu0);
      solver.solve({.layers = {hgLayer(kInfinity, albedo, 0.)}, .beam = pp::Beam{.mu0 = mu0}});
      EXPECT_NEAR(solver.reflectance(), h.reflectance(mu0), kAgreement);
      EXPECT_EQ(solver.transmittance(), 0.);
      for (const double mu : {1., 0.7, 0.2, 0.03})
        EXPECT_NEAR(solver.radiance(0., -mu, 1.), h.radiance(mu, mu0), kAgreement) << "mu " << mu;
    }
  }
}

// Check a semi-infinite slab that scatters forward, by a finite one whose far side no light reaches: e^(-.4 * 64).
TEST(StackAgainstDoubling, SemiInfiniteForwardScattering) {
  const witness::Stack slab{.layers = {{64., 0.9, henyeyGreensteinMoments(0.5)}}};
  const std::array mus{0.9, 0.3};
  const std::array phis{0., 1.};
  const auto expected = witness::stackRadiances(slab, 0.4, mus, phis, 48);
  pp::Solver solver({.streams = 64});
  solver.solve({.layers = {hgLayer(kInfinity, 0.9, 0.5)}, .beam = pp::Beam{.mu0 = 0.4}});
  EXPECT_NEAR(solver.reflectance(), witness::stackFluxes(slab, 0.4, 48).reflectance, kAgreement);
  for (std::size_t i = 0; i < mus.size(); ++i)
    for (std::size_t j = 0; j < phis.size(); ++j)
      EXPECT_NEAR(solver.radiance(0., -mus[i], phis[j]), expected.up_at_top[i * phis.size() + j], kAgreement);
}

}  // namespace
