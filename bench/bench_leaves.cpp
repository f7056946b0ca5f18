// Optics of leaves: spectra of PROSPECT, what bands see of them, and the contents behind a measured spectrum.
#include <benchmark/benchmark.h>

#include <cmath>

#include "leaves/light_bands.hpp"
#include "leaves/prospect.hpp"

namespace {

using namespace sunfleck;

// 2101 wavelengths. The answer is checked at 550 nm against leaf_optics.json of the shared references.
void spectrum(benchmark::State& state) {
  LeafSpectrum leaf = prospect({});  // reads the table
  for (auto _ : state) {
    leaf = prospect({});
    benchmark::DoNotOptimize(leaf.sides.data());
  }
  if (!(std::abs(leaf.sides[150].reflectance - 0.151167) < 1e-4)) state.SkipWithError("reflectance at 550 nm is wrong");
}
BENCHMARK(spectrum)->Unit(benchmark::kMicrosecond);

void rgb(benchmark::State& state) {
  const LeafSpectrum leaf = prospect({});
  std::array<LeafSides, kBands> bands = rgbOf(leaf);  // reads the table
  for (auto _ : state) benchmark::DoNotOptimize(bands = rgbOf(leaf));
  if (!(bands[1].reflectance > bands[2].reflectance)) state.SkipWithError("a green leaf is not green");
}
BENCHMARK(rgb)->Unit(benchmark::kMicrosecond);

}  // namespace
