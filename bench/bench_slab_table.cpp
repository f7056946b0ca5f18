#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.hpp"
#include "pp_solver/slab_table.hpp"
#include "pp_solver/solver.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::pp;

constexpr float kThickness = 16.f;

Particles medium() {
  return {0.95, PhaseFunction::henyeyGreenstein(0.3)};
}

// Coarse enough to be made in a few seconds; the size, which decides what the processor's caches hold, is that of use.
const SlabTable& table() {
  static const SlabTable made = *SlabTable::build(medium(), {.max_thickness = double{kThickness}, .max_error = 0.05});
  return made;
}

struct Place {
  float thickness, depth, mu0, mu, azimuth;
};

// `one_sun`: all places under the same beam, as in a picture; else as far apart in the table as can be.
std::vector<Place> places(bool one_sun) {
  Random random(1, 0);
  std::vector<Place> made(4096);
  for (Place& place : made) {
    place.thickness = kThickness * (0.01f + 0.99f * random.uniform());
    place.depth = place.thickness * random.uniform();
    place.mu0 = one_sun ? 0.7f : 0.01f + 0.99f * random.uniform();
    place.mu = (random.uniform() < 0.5f ? -1.f : 1.f) * (0.01f + 0.99f * random.uniform());
    place.azimuth = 3.14159f * random.uniform();
  }
  return made;
}

void solve(Solver& solver, const Place& place) {
  Problem problem;
  problem.layers.push_back({.thickness = double{place.thickness}, .medium = medium()});
  problem.beam = Beam{.mu0 = double{place.mu0}};
  solver.solve(problem);
}

double exactRadiance(Solver& solver, const Place& place) {
  solve(solver, place);
  return solver.radiance(double{place.depth}, double{place.mu}, double{place.azimuth});
}

bool withinBound(const std::vector<Place>& all) {
  Solver solver({.streams = 32});
  for (std::size_t i = 0; i < all.size(); i += 256) {
    const Place& p = all[i];
    const auto found = static_cast<double>(table().radiance(p.thickness, p.depth, p.mu0, p.mu, p.azimuth));
    const double error = 4. * std::numbers::pi * std::abs(found - exactRadiance(solver, p));
    if (!(error <= table().errors().bound())) return false;
  }
  return true;
}

// Radiance from the table; unit: look-ups/s.
void radiance(benchmark::State& state) {
  const std::vector<Place> all = places(state.range(0) != 0);
  if (!withinBound(all)) return state.SkipWithError("wrong answer");
  for (auto _ : state)
    for (const Place& p : all) benchmark::DoNotOptimize(table().radiance(p.thickness, p.depth, p.mu0, p.mu, p.azimuth));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(radiance)->Name("table_radiance")->ArgName("one_sun")->Arg(0)->Arg(1);

// P+ and P- from the table; unit: look-ups/s.
void powers(benchmark::State& state) {
  const std::vector<Place> all = places(state.range(0) != 0);
  if (!withinBound(all)) return state.SkipWithError("wrong answer");
  for (auto _ : state)
    for (const Place& p : all) benchmark::DoNotOptimize(table().powers(p.thickness, p.depth, p.mu0));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(powers)->Name("table_powers")->ArgName("one_sun")->Arg(0)->Arg(1);

// The same radiance from the solver: each place is a slab of its own; unit: radiances/s.
void solved(benchmark::State& state) {
  const std::vector<Place> all = places(false);
  Solver solver({.streams = static_cast<int>(state.range(0)), .azimuth_tolerance = 1e-4});
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(exactRadiance(solver, all[i++ % all.size()]));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(solved)->Name("solver_radiance")->ArgName("N")->Arg(8)->Arg(16)->Arg(32);

}  // namespace
