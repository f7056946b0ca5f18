#pragma once

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <limits>
#include <vector>

#include "pp_solver/solver.hpp"

// Problems that the tests of the exact solver share.
namespace sunfleck::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline pp::Layer hgLayer(double thickness, double albedo, double asymmetry = 0.) {
  return {.thickness = thickness, .medium = Particles{albedo, PhaseFunction::henyeyGreenstein(asymmetry)}};
}

inline pp::Problem slab(double thickness, double albedo, double asymmetry, double mu0) {
  return {.layers = {hgLayer(thickness, albedo, asymmetry)}, .beam = pp::Beam{.mu0 = mu0}};
}

// Forward, sideways and backward scattering layers on a ground of albedo .3.
inline pp::Problem threeLayers(double mu0, double azimuth = 0.) {
  pp::Problem problem{.beam = pp::Beam{.mu0 = mu0, .azimuth = azimuth}};
  problem.layers = {hgLayer(0.3, 0.9, 0.5),
                    {.thickness = 1.5, .medium = Particles{0.99, PhaseFunction::fromMoments({1., 0., 0.1})}},
                    hgLayer(0.7, 0.6, -0.3)};
  problem.ground.albedo = 0.3;
  return problem;
}

// Nodes and weights of Gauss's rule with 2 Half points on (0, 1): the directions of 4 Half streams.
template <unsigned Half>
std::array<std::array<double, 2>, 2 * Half> gaussNodes() {
  using Rule = boost::math::quadrature::gauss<double, 2 * Half>;
  std::array<std::array<double, 2>, 2 * Half> result;
  for (unsigned i = 0; i < Half; ++i) {
    result[2 * i] = {0.5 * (1. - Rule::abscissa()[i]), 0.5 * Rule::weights()[i]};
    result[2 * i + 1] = {0.5 * (1. + Rule::abscissa()[i]), 0.5 * Rule::weights()[i]};
  }
  return result;
}

}  // namespace sunfleck::test
