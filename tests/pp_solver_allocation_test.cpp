// Check that solving another problem of the same size, of particles on a Lambertian ground, allocates nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#include "pp_solver_problems.hpp"

namespace {

std::size_t allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment, size) != 0) throw std::bad_alloc();
  return memory;
}

}  // namespace

// What this program allocates goes through these; the arrays of new[] and of the standard library through them in turn.
void* operator new(std::size_t size) {
  return counted(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  free(memory);
}
// The solver's rows.
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return counted(size, alignment);
}

namespace {

using namespace sunfleck;
using test::hgLayer;

// All that a solve and its fluxes give, in one number, so that none of it can be left out.
double allOf(pp::Solver& solver, const pp::Problem& problem) {
  solver.solve(problem);
  const pp::Fluxes fluxes = solver.fluxes(0.5 * problem.layers[0].thickness);
  return solver.reflectance() + solver.transmittance() + solver.direct() + solver.absorptance() + fluxes.up +
         fluxes.down + fluxes.mean_intensity;
}

// The problems of a pair differ in every value and have the same size.
TEST(Allocation, IsDoneByTheFirstSolveAlone) {
  const auto sampled = [](double albedo, double backward) {
    return pp::Layer{.thickness = 0.5 + albedo,
                     .medium = Particles{albedo, PhaseFunction::sampled({-1., 0., 0.4, 1.}, {backward, 0.5, 1., 3.})}};
  };
  const auto series = [](double albedo, double first) {
    return pp::Layer{.thickness = 3. * albedo,
                     .medium = Particles{albedo, PhaseFunction::fromMoments({1., first, 0.1})}};
  };
  const auto lit = [](std::vector<pp::Layer> layers, double mu0, double albedo, double emission = 0.) {
    pp::Problem problem{.layers = std::move(layers), .beam = pp::Beam{.mu0 = mu0}, .above = 0.1 * mu0};
    problem.ground = {.albedo = albedo, .emission = emission};
    problem.layers[0].emission_top = emission;
    return problem;
  };
  const std::vector<std::pair<pp::Problem, pp::Problem>> pairs{
      {lit({hgLayer(1., 0.9, 0.7)}, 0.5, 0.), lit({hgLayer(40., 0.999, 0.2)}, 0.8, 0.)},
      {lit({hgLayer(1., 0.9, 0.7)}, 0.5, 0.3), lit({hgLayer(40., 0.999, 0.2)}, 0.8, 0.6)},
      {lit({hgLayer(0.3, 0.9, 0.5), hgLayer(2., 1., 0.8), hgLayer(0.01, 0.2, -0.5)}, 0.5, 0.2, 1.),
       lit({hgLayer(3., 0.99, -0.3), hgLayer(0.1, 0.5, 0.), hgLayer(7., 0.7, 0.4)}, 0.9, 0.7, 2.)},
      {lit({series(0.9, 0.4), sampled(0.8, 0.7)}, 0.5, 0.2), lit({series(0.6, -0.2), sampled(0.3, 2.)}, 0.4, 0.1)}};
  for (const int streams : {4, 16, 64})
    for (const auto& [problem, other] : pairs) {
      pp::Solver solver({.streams = streams});
      const std::size_t before = allocations;
      const double first = allOf(solver, problem);
      EXPECT_GT(allocations, before) << "nothing is counted";
      const std::size_t held = allocations;
      const double second = allOf(solver, other), again = allOf(solver, problem);
      EXPECT_EQ(allocations - held, 0U) << streams << " streams, " << problem.layers.size() << " layers";
      EXPECT_EQ(again, first);
      EXPECT_TRUE(std::isfinite(second) && second != first);
    }
}

}  // namespace
