// Check that the exact solver refuses every value that is out of its range, by the field's name.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "pp_solver_problems.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One line "... field = value: must be rule".
template <typename F>
void expectRefused(const std::string& field, F&& f) {
  try {
    f();
    ADD_FAILURE() << "accepted: wrong " << field;
  } catch (const InvalidInput& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find(field), std::string::npos) << message;
    EXPECT_NE(message.find("must be"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

void expectProblemRefused(const std::string& field, const std::function<void(pp::Problem&)>& spoil) {
  pp::Problem problem = threeLayers(0.6);
  ASSERT_NO_THROW(pp::requireSolvable(problem));
  spoil(problem);
  expectRefused(field, [&] { pp::requireSolvable(problem); });
  pp::Solver solver;
  expectRefused(field, [&] { solver.solve(problem); });
  // A refusal leaves the object fit for use.
  solver.solve(slab(1., 1., 0., 0.5));
  EXPECT_NEAR(solver.reflectance() + solver.transmittance(), 1., 1e-12);
}

Particles& particles(pp::Problem& problem) {
  return std::get<Particles>(problem.layers[1].medium);
}

TEST(Input, Layers) {
  expectProblemRefused("layers", [](pp::Problem& p) { p.layers.clear(); });
  for (const double thickness : {0., -1., kNan, -kInfinity})
    expectProblemRefused("thickness", [=](pp::Problem& p) { p.layers[1].thickness = thickness; });
  expectProblemRefused("thickness", [](pp::Problem& p) { p.layers[1].thickness = kInfinity; });  // not the last
  for (const double albedo : {-1e-9, 1. + 1e-9, kNan, kInfinity})
    expectProblemRefused("albedo", [=](pp::Problem& p) { particles(p).albedo = albedo; });
  for (const double emission : {-1., kNan, kInfinity}) {
    expectProblemRefused("emission_top", [=](pp::Problem& p) { p.layers[1].emission_top = emission; });
    expectProblemRefused("emission_bottom", [=](pp::Problem& p) { p.layers[1].emission_bottom = emission; });
  }
}

// Check that the message tells which layer is meant, and by which number.
TEST(Input, LayersAreNumbered) {
  pp::Problem first = threeLayers(0.6), second = threeLayers(0.6);
  first.layers[0].thickness = second.layers[1].thickness = -1.;
  std::string messages[2];
  for (int i = 0; i < 2; ++i) try {
      pp::requireSolvable(i == 0 ? first : second);
    } catch (const InvalidInput& e) {
      messages[i] = e.what();
    }
  EXPECT_FALSE(messages[0].empty());
  EXPECT_NE(messages[0], messages[1]);
}

TEST(Input, Light) {
  for (const double mu0 : {0., -0.5, 1. + 1e-12, kNan})
    expectProblemRefused("mu0", [=](pp::Problem& p) { p.beam->mu0 = mu0; });
  for (const double azimuth : {kNan, kInfinity})
    expectProblemRefused("azimuth", [=](pp::Problem& p) { p.beam->azimuth = azimuth; });
  for (const double irradiance : {-1., kNan, kInfinity})
    expectProblemRefused("irradiance", [=](pp::Problem& p) { p.beam->irradiance = irradiance; });
  for (const double radiance : {-1., kNan, kInfinity}) {
    expectProblemRefused("above", [=](pp::Problem& p) { p.above = radiance; });
    expectProblemRefused("below", [=](pp::Problem& p) { p.below = radiance; });
  }
  expectProblemRefused("below", [](pp::Problem& p) {
    p.layers.back().thickness = kInfinity;
    p.below = 1.;
  });
}

// Check that a function which gives no radiance is found, at the latest when it is asked.
TEST(Input, SkyFunctions) {
  for (const double radiance : {-1., kNan, kInfinity}) {
    pp::Problem problem = threeLayers(0.6);
    problem.above = [=](double, double) { return radiance; };
    pp::Solver solver;
    expectRefused("above", [&] { solver.solve(problem); });
  }
}

TEST(Input, Ground) {
  for (const double albedo : {-0.1, 1.1, kNan})
    expectProblemRefused("ground", [=](pp::Problem& p) { p.ground.albedo = albedo; });
  for (const double emission : {-1., kNan, kInfinity})
    expectProblemRefused("ground", [=](pp::Problem& p) { p.ground.emission = emission; });
  const auto shape = [](auto function, int modes) {
    return [=](pp::Problem& p) { p.ground = {.brdf = function, .brdf_modes = modes}; };
  };
  const auto lambert = [](int m, double, double) { return m == 0 ? 0.1 : 0.; };
  expectProblemRefused("brdf_modes", shape(lambert, 0));
  expectProblemRefused("albedo", [&](pp::Problem& p) {
    shape(lambert, 1)(p);
    p.ground.albedo = 0.2;
  });
  // What only the solver can see
  const auto expectSolverRefuses = [&](const std::string& field, auto function) {
    pp::Problem problem = threeLayers(0.6);
    shape(function, 1)(problem);
    pp::Solver solver;
    expectRefused(field, [&] { solver.solve(problem); });
    expectRefused("solved", [&] { solver.reflectance(); });
  };
  expectSolverRefuses("BRDF", [](int, double, double) { return kNan; });
  expectSolverRefuses("BRDF", [](int, double, double) { return -0.1; });
  expectSolverRefuses("exchanged", [](int, double mu, double) { return 0.1 * mu; });
  expectSolverRefuses("albedo", [](int, double, double) { return 1.; });
}

TEST(Input, Settings) {
  for (const int streams : {-2, 0, 1, 3, 17, 258})
    expectRefused("streams", [=] { pp::Solver solver({.streams = streams}); });
  for (const double tolerance : {-1., kNan, kInfinity})
    expectRefused("azimuth_tolerance", [=] { pp::Solver solver({.azimuth_tolerance = tolerance}); });
}

TEST(Input, PhaseFunctions) {
  for (const double asymmetry : {-1., 1., 2., kNan})
    expectRefused("g =", [=] { (void)PhaseFunction::henyeyGreenstein(asymmetry); });
  for (const std::vector<double>& moments : {std::vector<double>{0.5},
                                             {1., 1.1},
                                             {1., -1.1},
                                             {1., kNan},
                                             {1., 0., 0., 0.9}})  // the last is negative somewhere
    expectRefused("moment", [&] { (void)PhaseFunction::fromMoments(moments); });
  for (const std::vector<double>& cosines :
       {std::vector<double>{}, {-1.}, {-1., 0.5}, {-0.9, 1.}, {-1., 0.2, 0.1, 1.}, {-1., 0., 0., 1.}, {-1., kNan, 1.}})
    expectRefused("cosine", [&] { (void)PhaseFunction::sampled(cosines, std::vector<double>(cosines.size(), 1.)); });
  for (const std::vector<double>& values : {std::vector<double>{1., -1., 1.}, {1., kNan, 1.}, {0., 0., 0.}, {1., 1.}})
    expectRefused("phase function", [&] { (void)PhaseFunction::sampled({-1., 0., 1.}, values); });
}

// Check the places and directions of a question about a solution.
TEST(Input, Questions) {
  pp::Solver solver;
  solver.solve(threeLayers(0.6));  // 2.5 thick
  for (const double depth : {-1e-9, 2.6, kNan, kInfinity}) {
    expectRefused("depth", [&] { (void)solver.fluxes(depth); });
    expectRefused("depth", [&] { (void)solver.radiance(depth, 0.5, 0.); });
    expectRefused("depth", [&] { (void)solver.absorbed(0., depth); });
  }
  for (const double mu : {0., 1.1, -1.1, kNan}) expectRefused("mu", [&] { (void)solver.radiance(0., mu, 0.); });
  for (const double phi : {kNan, kInfinity}) expectRefused("phi", [&] { (void)solver.radiance(0., 0.5, phi); });
}

}  // namespace
