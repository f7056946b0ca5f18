#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/random.hpp"
#include "pp_solver/slab_batch.hpp"
#include "pp_solver/solver.hpp"

namespace {

using namespace sunfleck;

// The problem that other codes are timed with: g .85, omega .99, tau 10, mu0 .5.
pp::Problem timedProblem() {
  return {.layers = {{.thickness = 10., .medium = Particles{0.99, PhaseFunction::henyeyGreenstein(0.85)}}},
          .beam = pp::Beam{.mu0 = 0.5}};
}

// Its solution, by adding and doubling without delta-M, and how near N directions come.
constexpr double kReflectance = 0.51608139149, kTransmittance = 0.31244231475;
const std::map<std::int64_t, double> kFluxErrors{{4, 3e-3},  {8, 5e-4},  {16, 2e-5},
                                                 {32, 1e-6}, {64, 1e-9}, {128, 1e-10}};

double fluxError(double reflectance, double transmittance) {
  return std::max(std::abs(reflectance - kReflectance), std::abs(transmittance - kTransmittance));
}
bool isRight(double reflectance, double transmittance, std::int64_t streams) {
  return fluxError(reflectance, transmittance) < kFluxErrors.at(streams);
}

// Fluxes of one slab; unit: s for each solve. `error`: the larger one of both, known to 1e-11.
void flux(benchmark::State& state) {
  pp::Solver solver({.streams = static_cast<int>(state.range(0))});
  const pp::Problem problem = timedProblem();
  solver.solve(problem);
  if (!isRight(solver.reflectance(), solver.transmittance(), state.range(0)))
    return state.SkipWithError("wrong answer");
  for (auto _ : state) {
    solver.solve(problem);
    benchmark::DoNotOptimize(solver.reflectance() + solver.transmittance());
  }
  state.counters["error"] = fluxError(solver.reflectance(), solver.transmittance());
}
BENCHMARK(flux)->ArgName("N")->Arg(4)->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Arg(128);

// Fluxes of many slabs, all unlike, on one thread; unit: s for each slab.
void fluxBatch(benchmark::State& state) {
  const int streams = static_cast<int>(state.range(0));
  Random random(1, 0);
  std::vector<pp::SlabCase> cases(4096, {.asymmetry = 0.85, .albedo = 0.99, .thickness = 10., .mu0 = 0.5});
  for (std::size_t i = 1; i < cases.size(); ++i)
    cases[i] = {.asymmetry = 0.9 * random.uniformDouble(),
                .albedo = random.uniformDouble(),
                .thickness = 0.1 + 20. * random.uniformDouble(),
                .mu0 = 0.1 + 0.9 * random.uniformDouble()};
  std::vector<pp::SlabFluxes> fluxes(cases.size());
  tbb::task_arena one_thread(1);
  one_thread.execute([&] { pp::solveSlabs(cases, fluxes, streams); });
  pp::Solver solver({.streams = streams});
  for (std::size_t i = 0; i < cases.size(); i += 97) {
    const auto& [asymmetry, albedo, thickness, mu0] = cases[i];
    solver.solve(
        {.layers = {{.thickness = thickness, .medium = Particles{albedo, PhaseFunction::henyeyGreenstein(asymmetry)}}},
         .beam = pp::Beam{.mu0 = mu0}});
    if (!(std::abs(solver.reflectance() - fluxes[i].reflectance) < 1e-12 &&
          std::abs(solver.transmittance() - fluxes[i].transmittance) < 1e-12))
      return state.SkipWithError("wrong answer");
  }
  if (!isRight(fluxes[0].reflectance, fluxes[0].transmittance, streams)) return state.SkipWithError("wrong answer");
  // A slab is an iteration, so that the time told is that of one.
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(cases.size()))) {
    one_thread.execute([&] { pp::solveSlabs(cases, fluxes, streams); });
    benchmark::DoNotOptimize(fluxes.data());
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(fluxBatch)->Name("flux_batch")->ArgName("N")->Arg(4)->Arg(8)->Arg(16)->Arg(32);

// Its radiances for beam irradiance 1, by adding and doubling with 110 directions in a hemisphere and without delta-M:
// depths 0, 5, 10 by mu -1, -.5, -.1, .1, .5, 1, in the sun's plane.
constexpr std::array<double, 18> kKnownRadiances{
    0.05789150748, 0.1665318303, 0.3324615026,  0, 0, 0, 0.01867000878, 0.04077206691, 0.06834069828,
    0.08924052186, 0.1627098008, 0.08054551002, 0, 0, 0, 0.02461204957, 0.04867333157, 0.06245617718};

// How near N directions come, relative to the radiance.
const std::map<std::int64_t, double> kRadianceErrors{{4, 0.5},   {8, 0.2},   {16, 1e-2},
                                                     {32, 1e-3}, {64, 1e-5}, {128, 1e-7}};

// Radiances: 6 directions, 3 depths, 1 azimuth, corrected; unit: s for each solve. `error`: RMS over that of the
// radiances, which are known to 1e-9.
void radiance(benchmark::State& state) {
  constexpr std::array depths{0., 5., 10.};
  constexpr std::array mus{-1., -0.5, -0.1, 0.1, 0.5, 1.};
  constexpr std::array azimuths{0.};
  pp::Solver solver({.streams = static_cast<int>(state.range(0))});
  const pp::Problem problem = timedProblem();
  std::array<double, kKnownRadiances.size()> radiances{};
  solver.solve(problem);
  solver.radiances(depths, mus, azimuths, radiances);
  for (std::size_t i = 0; i < radiances.size(); ++i) {
    const double error = kRadianceErrors.at(state.range(0));
    if (!(std::abs(radiances[i] - kKnownRadiances[i]) <= error * kKnownRadiances[i] + 1e-13))
      return state.SkipWithError("wrong answer");
  }
  for (auto _ : state) {
    solver.solve(problem);
    solver.radiances(depths, mus, azimuths, radiances);
    benchmark::DoNotOptimize(radiances.data());
  }
  double squares = 0., known_squares = 0.;
  for (std::size_t i = 0; i < radiances.size(); ++i) {
    squares += std::pow(radiances[i] - kKnownRadiances[i], 2);
    known_squares += std::pow(kKnownRadiances[i], 2);
  }
  state.counters["error"] = std::sqrt(squares / known_squares);
}
BENCHMARK(radiance)->ArgName("N")->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Arg(128);

// Fluxes of a stack of unlike layers beside those of one layer; unit: s for each solve.
void layers(benchmark::State& state) {
  const int count = static_cast<int>(state.range(1));
  pp::Problem problem = timedProblem();
  problem.layers.clear();
  for (int i = 0; i < count; ++i)
    problem.layers.push_back({.thickness = 10. / count,
                              .medium = Particles{0.99 - 1e-3 * i, PhaseFunction::henyeyGreenstein(0.85 - 1e-3 * i)}});
  pp::Solver solver({.streams = static_cast<int>(state.range(0))});
  solver.solve(problem);
  if (!(std::abs(solver.reflectance() + solver.transmittance() + solver.absorptance() - 1.) < 1e-12))
    return state.SkipWithError("light is lost");
  for (auto _ : state) {
    solver.solve(problem);
    benchmark::DoNotOptimize(solver.reflectance() + solver.transmittance());
  }
}
BENCHMARK(layers)->ArgNames({"N", "L"})->ArgsProduct({{4, 8, 16, 32, 64, 128}, {1, 50}});

}  // namespace
