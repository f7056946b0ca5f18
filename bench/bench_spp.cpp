#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/instruction_set.hpp"
#include "core/random.hpp"
#include "spp/compensation.hpp"
#include "spp/slab.hpp"
#include "spp/slab_arrays.hpp"
#include "spp/stream_slab.hpp"

namespace sunfleck::spp {

using SumExponentials = void (*)(std::size_t count, const float* x, int exponentials, float* out);
namespace baseline {
extern const SumExponentials sumExponentials;
}
#ifdef SUNFLECK_X86
namespace avx2 {
extern const SumExponentials sumExponentials;
}
namespace avx512 {
extern const SumExponentials sumExponentials;
}
#endif

}  // namespace sunfleck::spp

// The closed forms on one core. Each checks its answer against double precision before it is timed.
namespace {

using namespace sunfleck;

constexpr float kAlbedo = 0.95f, kForwardShare = 0.5f, kMu0 = 1.f;
constexpr double kTolerance = 5e-6;  // what slab_arrays.hpp promises

// Leaves as trees have them, up to 16 deep: few enough to stay in the cache, so that not the memory is timed.
struct Leaves {
  static constexpr std::size_t kCount = 4096;
  std::vector<float> depth, thickness, compensation, down, up;

  Leaves() : down(kCount), up(kCount) {
    Random random(1, 0);
    for (std::size_t i = 0; i < kCount; ++i) {
      thickness.push_back(1.f + 15.f * random.uniform());
      depth.push_back(thickness.back() * random.uniform());
      compensation.push_back(random.uniform());
    }
  }

  // Whether `down` and `up` are near what `exact(depth, thickness)` says: a pair of numbers.
  template <typename Exact>
  bool areNear(const Exact& exact) const {
    for (std::size_t i = 0; i < kCount; i += 7) {
      const auto [exact_down, exact_up] = exact(double{depth[i]}, double{thickness[i]});
      if (!(std::abs(double{down[i]} - exact_down) < kTolerance && std::abs(double{up[i]} - exact_up) < kTolerance))
        return false;
    }
    return true;
  }

  // Times `evaluate`, which is known to be right; unit: leaves/s.
  template <typename Evaluate>
  void time(benchmark::State& state, const Evaluate& evaluate) {
    for (auto _ : state) {
      evaluate();
      benchmark::DoNotOptimize(down.data());
      benchmark::DoNotOptimize(up.data());
      benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
  }
};

struct Pair {
  double down, up;
};

Pair exactSpp(double depth, double thickness) {
  const auto powers = spp::precise::sppPowers(depth, thickness, 1., double{kAlbedo}, 0.5);
  return {powers.down, powers.up};
}

// P+ and P- of SPP.
void sppForLeaves(benchmark::State& state) {
  Leaves leaves;
  const auto evaluate = [&] {
    spp::sppPowers(leaves.depth, leaves.thickness, kMu0, kAlbedo, kForwardShare, leaves.down, leaves.up);
  };
  evaluate();
  if (!leaves.areNear(exactSpp)) return state.SkipWithError("wrong answer");
  leaves.time(state, evaluate);
}
BENCHMARK(sppForLeaves)->Name("spp");

// The same, one leaf after another by the scalar formula.
void sppOneByOne(benchmark::State& state) {
  Leaves leaves;
  const auto evaluate = [&] {
    for (std::size_t i = 0; i < Leaves::kCount; ++i) {
      const auto powers = spp::sppPowers(leaves.depth[i], leaves.thickness[i], kMu0, kAlbedo, kForwardShare);
      leaves.down[i] = powers.down;
      leaves.up[i] = powers.up;
    }
  };
  evaluate();
  if (!leaves.areNear(exactSpp)) return state.SkipWithError("wrong answer");
  leaves.time(state, evaluate);
}
BENCHMARK(sppOneByOne)->Name("spp_scalar");

const spp::BeamInMedium kMedium{0.3, 0.95, 0.8};

void streamPowers(benchmark::State& state, const spp::StreamConstants& constants) {
  Leaves leaves;
  const spp::StreamArrays arrays(constants);
  const auto evaluate = [&] { arrays.powers(leaves.depth, leaves.thickness, leaves.down, leaves.up); };
  evaluate();
  const auto exact = [&](double depth, double thickness) {
    const auto light = spp::StreamSlab<double>(constants, thickness).light(depth);
    return Pair{light.power_down, light.power_up};
  };
  if (!leaves.areNear(exact)) return state.SkipWithError("wrong answer");
  leaves.time(state, evaluate);
}
void twoStream(benchmark::State& state) {
  streamPowers(state, spp::twoStreamConstants(kMedium));
}
BENCHMARK(twoStream)->Name("twostream");
void nStream(benchmark::State& state) {
  streamPowers(state, spp::nStreamConstants(kMedium, static_cast<int>(state.range(0)), 1));
}
BENCHMARK(nStream)->Name("nstream")->ArgName("n")->Arg(1)->Arg(2)->Arg(3)->Arg(4)->Arg(8);

// Refined radiance of the azimuth's mean towards one direction, mu 0.6 (downward) or -0.6.
void refinedRadiance(benchmark::State& state, const spp::StreamConstants& constants, double mu) {
  Leaves leaves;
  const spp::StreamArrays arrays(constants);
  const auto view = spp::streamView<float>(constants, mu, 1.);
  const auto evaluate = [&] { arrays.refinedRadiance(leaves.depth, leaves.thickness, view, leaves.down); };
  evaluate();
  const auto exact = [&](double depth, double thickness) {
    const spp::StreamSlab<double> slab(constants, thickness);
    return Pair{slab.refinedRadiance(depth, slab.view(mu, 1.)), 0.};
  };
  if (!leaves.areNear(exact)) return state.SkipWithError("wrong answer");
  leaves.time(state, evaluate);
}
void sppRadiance(benchmark::State& state) {
  refinedRadiance(state, spp::sppConstants(kMedium), state.range(0) != 0 ? 0.6 : -0.6);
}
BENCHMARK(sppRadiance)->Name("sppr")->ArgName("down")->Arg(1)->Arg(0);
void nStreamRadiance(benchmark::State& state) {
  refinedRadiance(state, spp::nStreamConstants(kMedium, static_cast<int>(state.range(0)), 1),
                  state.range(1) != 0 ? 0.6 : -0.6);
}
BENCHMARK(nStreamRadiance)->Name("nstreamr")->ArgNames({"n", "down"})->ArgsProduct({{1, 2, 3, 4, 8}, {1, 0}});

// Irradiance of one leaf by SPPG, G given; unit: leaves/s.
void sppg(benchmark::State& state) {
  Leaves leaves;
  for (auto _ : state)
    for (std::size_t i = 0; i < Leaves::kCount; ++i) {
      const float direct = spp::directPower(leaves.depth[i], kMu0);
      const auto slab = spp::sppPowers(leaves.depth[i], leaves.thickness[i], kMu0, kAlbedo, kForwardShare);
      benchmark::DoNotOptimize(
          spp::leafIrradiance(0.5f, direct, spp::compensated(slab, direct, leaves.compensation[i])));
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(Leaves::kCount));
}
BENCHMARK(sppg);

// G of one place from 22 directions; unit: places/s.
void compensation(benchmark::State& state) {
  const Leaves leaves;
  constexpr int kDirections = 22;
  std::vector<float> cosines, none_near, edges(kDirections, 0.f);
  for (int j = 0; j < kDirections; ++j) {
    cosines.push_back(1.f - (2.f * static_cast<float>(j) + 1.f) / kDirections);
    none_near.push_back(1e6f);
  }
  // Without an edge in any direction nothing is lost, and at the edge everything is.
  if (std::abs(spp::compensation(cosines, none_near, 1.f, 3.f, 1.f) - 1.f) > 1e-6f ||
      spp::compensation(cosines, edges, 1.f, 3.f, 1.f) > 1e-6f)
    return state.SkipWithError("wrong answer");
  for (auto _ : state)
    for (std::size_t i = 0; i < Leaves::kCount; ++i) {
      std::ranges::fill(edges, leaves.compensation[i] * leaves.depth[i]);
      benchmark::DoNotOptimize(spp::compensation(cosines, edges, leaves.depth[i], leaves.thickness[i], kMu0));
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(Leaves::kCount));
}
BENCHMARK(compensation);

// What no evaluation can be faster than: reading both arrays and writing two.
void copy(benchmark::State& state) {
  Leaves leaves;
  leaves.time(state, [&] {
    std::ranges::copy(leaves.depth, leaves.down.begin());
    std::ranges::copy(leaves.thickness, leaves.up.begin());
  });
}
BENCHMARK(copy);

// And the exponentials that it takes: 1 for direct light, 3 for SPP, 2 n + 2 for n streams, 2 n + 3 for their radiance.
void exponentials(benchmark::State& state) {
#ifdef SUNFLECK_X86
  const auto sum =
      bestOf({&spp::baseline::sumExponentials, &spp::avx2::sumExponentials, &spp::avx512::sumExponentials});
#else
  const auto sum = spp::baseline::sumExponentials;
#endif
  Leaves leaves;
  const int count = static_cast<int>(state.range(0));
  const auto evaluate = [&] { sum(Leaves::kCount, leaves.depth.data(), count, leaves.down.data()); };
  evaluate();
  const bool right = leaves.areNear([&](double depth, double) {
    double exact = 0.;
    for (int j = 1; j <= count; ++j) exact += std::exp(-j * depth);
    return Pair{exact, 0.};
  });
  if (!right) return state.SkipWithError("wrong answer");
  leaves.time(state, evaluate);
}
BENCHMARK(exponentials)->ArgName("count")->Arg(1)->Arg(3)->Arg(6)->Arg(7);

}  // namespace
