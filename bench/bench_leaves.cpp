// Optics of leaves: spectra of PROSPECT, what bands see of them, the contents behind a measured spectrum; slabs of
// tissue.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "leaves/leaf_map_fit.hpp"
#include "leaves/leaf_textures.hpp"
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

// What each of 720 x 540 places and each side does, as a panel's edit asks for it.
void maps(benchmark::State& state) {
  auto texture = std::make_shared<LeafTexture>();
  texture->width = 720;
  texture->height = 540;
  for (int i = 0; i < 720 * 540; ++i) {
    texture->colour.emplace_back(0.5f + 0.4f * std::sin(0.01f * static_cast<float>(i)));
    texture->alpha.push_back(0.5f + 0.5f * std::sin(0.003f * static_cast<float>(i)));
  }
  auto lower = std::make_shared<LeafTexture>(*texture);
  const LeafDescription leaf =
      LeafByTissue{.absorption = {1.5f, 0.4f, 5.f}, .scattering = glm::vec3(10.f), .thickness = 0.2};
  const BandOptics even = bandOptics(leaf, {}, {});
  const LeafTextures textures{.upper = {.detail = texture, .gloss = lower},
                              .lower = {.detail = lower, .gloss = texture}};
  std::shared_ptr<const LeafMaps> made;
  for (auto _ : state) made = leafMaps(leaf, even, textures);
  if (made->places.size() != 720 * 540) state.SkipWithError("places are missing");
}
BENCHMARK(maps)->Unit(benchmark::kMillisecond)->UseRealTime();

// Tissue, gamma and delta behind 720 x 540 places.
void mapsFit(benchmark::State& state) {
  MeasuredLeafMaps measured;
  for (int i = 0; i < 720 * 540; ++i) {
    const float dark = std::sin(0.01f * static_cast<float>(i)), thin = std::sin(0.003f * static_cast<float>(i));
    measured.reflectance.push_back((1.f + 0.3f * dark) * glm::vec3(0.1f, 0.2f, 0.06f));
    measured.transmittance.push_back((1.f + 0.3f * thin) * glm::vec3(0.08f, 0.2f, 0.03f));
  }
  LeafMapFit found;
  for (auto _ : state) found = fitLeafMaps(measured, 0.2);
  if (!found.converged) state.SkipWithError("the tissue is not found");
}
BENCHMARK(mapsFit)->Unit(benchmark::kMillisecond)->UseRealTime();

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
