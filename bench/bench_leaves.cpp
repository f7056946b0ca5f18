// Optics of leaves: spectra of PROSPECT, what bands see of them, and the contents behind a measured spectrum.
#include <benchmark/benchmark.h>

#include <cmath>

#include "leaves/light_bands.hpp"
#include "leaves/prospect.hpp"
#include "leaves/prospect_fit.hpp"

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

// Seven contents from reflectance and transmittance at 2101 wavelengths.
void fit(benchmark::State& state) {
  const LeafContents truth{.structure = 1.8, .chlorophyll = 25., .anthocyanins = 3., .brown_pigments = 0.2};
  MeasuredSpectrum measured;
  for (const LeafSides& sides : prospect(truth).sides) {
    measured.wavelengths.push_back(kFirstWavelength + static_cast<double>(measured.wavelengths.size()));
    measured.reflectance.push_back(sides.reflectance);
    measured.transmittance.push_back(sides.transmittance);
  }
  ProspectFit found;
  for (auto _ : state) found = fitProspect(measured);
  if (!(std::abs(found.contents.chlorophyll - truth.chlorophyll) < 1e-3)) state.SkipWithError("chlorophyll is wrong");
}
BENCHMARK(fit)->Unit(benchmark::kMillisecond);

}  // namespace
