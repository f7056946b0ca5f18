#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "spp/slab.hpp"

namespace {

using namespace sunfleck;

constexpr float kAlbedo = 0.95f, kForwardShare = 0.5f, kMu0 = 1.f;

struct Leaf {
  float depth, thickness, compensation;
};

// Leaves as trees have them: up to 16 deep.
std::vector<Leaf> leaves() {
  Random random(1, 0);
  std::vector<Leaf> made(4096);
  for (Leaf& leaf : made) {
    leaf.thickness = 1.f + 15.f * random.uniform();
    leaf.depth = leaf.thickness * random.uniform();
    leaf.compensation = random.uniform();
  }
  return made;
}

bool nearDoublePrecision(const std::vector<Leaf>& all) {
  for (const Leaf& leaf : all) {
    const auto single = spp::sppPowers(leaf.depth, leaf.thickness, kMu0, kAlbedo, kForwardShare);
    const auto exact = spp::precise::sppPowers(double{leaf.depth}, double{leaf.thickness}, 1., double{kAlbedo}, 0.5);
    if (!(std::abs(double{single.down} - exact.down) < 1e-6 && std::abs(double{single.up} - exact.up) < 1e-6))
      return false;
  }
  return true;
}

// P+ and P- of one leaf; unit: leaves/s.
void sppForLeaves(benchmark::State& state) {
  const std::vector<Leaf> all = leaves();
  if (!nearDoublePrecision(all)) return state.SkipWithError("wrong answer");
  for (auto _ : state)
    for (const Leaf& leaf : all)
      benchmark::DoNotOptimize(spp::sppPowers(leaf.depth, leaf.thickness, kMu0, kAlbedo, kForwardShare));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(sppForLeaves)->Name("spp");

// Irradiance of one leaf by SPPG, G given; unit: leaves/s.
void sppg(benchmark::State& state) {
  const std::vector<Leaf> all = leaves();
  if (!nearDoublePrecision(all)) return state.SkipWithError("wrong answer");
  for (auto _ : state)
    for (const Leaf& leaf : all) {
      const float direct = spp::directPower(leaf.depth, kMu0);
      const auto slab = spp::sppPowers(leaf.depth, leaf.thickness, kMu0, kAlbedo, kForwardShare);
      benchmark::DoNotOptimize(spp::leafIrradiance(0.5f, direct, spp::compensated(slab, direct, leaf.compensation)));
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(sppg);

// G of one place from 22 directions; unit: places/s.
void compensation(benchmark::State& state) {
  const std::vector<Leaf> all = leaves();
  // Without an edge in any direction nothing is lost, and at the edge everything is.
  if (spp::shareBeyondEdge(0.5f, 1e6f, 1.f, 3.f, 1.f) != 0.f ||
      std::abs(spp::shareBeyondEdge(0.5f, 0.f, 1.f, 3.f, 1.f) - 1.f) > 1e-6f)
    return state.SkipWithError("wrong answer");
  constexpr int directions = 22;
  for (auto _ : state)
    for (const Leaf& leaf : all) {
      float lost = 0.f;
      for (int j = 0; j < directions; ++j) {
        const float cosine = 1.f - (2.f * static_cast<float>(j) + 1.f) / directions;
        lost += spp::shareBeyondEdge(cosine, leaf.compensation * leaf.depth, leaf.depth, leaf.thickness, kMu0);
      }
      benchmark::DoNotOptimize(1.f - lost / directions);
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(compensation);

}  // namespace
