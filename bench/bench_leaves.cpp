// Optics of leaves: spectra of PROSPECT, what bands see of them, the contents behind a measured spectrum; slabs of
// tissue.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "leaves/light_bands.hpp"
#include "leaves/prospect.hpp"
#include "leaves/prospect_fit.hpp"
#include "leaves/slab_leaf.hpp"

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

void slab(benchmark::State& state) {
  const LeafTissue tissue{.absorption = 0.5, .scattering = 10., .thickness = 0.2};
  SlabLeaf leaf;
  for (auto _ : state) benchmark::DoNotOptimize(leaf = slabLeaf(tissue));
  const double all = leaf.sides.reflectance + leaf.sides.transmittance + leaf.absorptance;
  if (!(std::abs(all - 1.) < 1e-10)) state.SkipWithError("energy is lost");
}
BENCHMARK(slab)->Unit(benchmark::kMicrosecond);

// 180 x 135 places, no two alike, on all threads: 16 of these are the map of a leaf of Wang et al.
void tissueMap(benchmark::State& state) {
  constexpr int kWidth = 180, kHeight = 135;
  std::vector<LeafSides> measured;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      measured.push_back({.reflectance = 0.02 + 0.4 * x / kWidth, .transmittance = 0.02 + 0.5 * y / kHeight});
  double worst = 0.;
  for (auto _ : state)
    for (const TissueFit& fit : tissueOf(measured, 0.2)) worst = std::max(worst, fit.residual);
  if (!(worst < 1e-8)) state.SkipWithError("a place was not fitted");
}
BENCHMARK(tissueMap)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
