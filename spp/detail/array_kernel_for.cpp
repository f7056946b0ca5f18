// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include "spp/detail/array_kernel.hpp"
#include "spp/detail/lanes.hpp"

namespace sunfleck::spp::SUNFLECK_ISA {
namespace {

using detail::Edges;
using detail::Places;
using detail::StreamNumbers;
using detail::ViewNumbers;
using detail::Weights;

Lanes loaded(const float* from, std::size_t lanes) {
  Floats result{};
  if (lanes == kLanes)
    __builtin_memcpy(&result, from, sizeof result);
  else
    for (std::size_t i = 0; i < lanes; ++i) result[i] = from[i];
  return result;
}

void store(Lanes value, float* to, std::size_t lanes) {
  if (lanes == kLanes)
    __builtin_memcpy(to, &value.of, sizeof value.of);
  else
    for (std::size_t i = 0; i < lanes; ++i) to[i] = value.of[i];
}

// Calls f(depth, thickness, first place, number of places) for as many places as a vector has lanes, at last for fewer.
template <typename F>
[[gnu::always_inline]] inline void forBlocks(const Places& places, F&& f) {
  for (std::size_t first = 0; first < places.count; first += kLanes) {
    const std::size_t lanes = places.count - first < kLanes ? places.count - first : kLanes;
    f(loaded(places.depth + first, lanes), loaded(places.thickness + first, lanes), first, lanes);
  }
}

// A struct of Lanes, each alike in all lanes, from as many numbers.
template <typename T>
T everywhere(const float* from) {
  constexpr std::size_t kNumbers = sizeof(T) / sizeof(Lanes);
  Lanes lanes[kNumbers];
  for (std::size_t i = 0; i < kNumbers; ++i) lanes[i] = from[i];
  T result;
  __builtin_memcpy(&result, lanes, sizeof result);
  return result;
}

template <int kStreams>
typename StreamFormulas<Lanes, kStreams>::ModeWeights weightsOf(const Weights& weights, int order) {
  typename StreamFormulas<Lanes, kStreams>::ModeWeights result;
  for (int j = 0; j < kStreams; ++j) {
    result.sum[j] = weights.sum[order * kStreams + j];
    result.difference[j] = weights.difference[order * kStreams + j];
  }
  return result;
}

void sppPowers(const Places& places, float mu0, float albedo, float forward_share, float* down, float* up) {
  forBlocks(places, [&](Lanes depth, Lanes thickness, std::size_t first, std::size_t lanes) {
    const auto powers = StreamFormulas<Lanes>::sppPowers(depth, thickness, mu0, albedo, forward_share);
    store(powers.down, down + first, lanes);
    store(powers.up, up + first, lanes);
  });
}

void sppRadiance(const Places& places, float mu0, float albedo, float forward_share, float* down, float* up) {
  using Formulas = StreamFormulas<Lanes>;
  forBlocks(places, [&](Lanes depth, Lanes thickness, std::size_t first, std::size_t lanes) {
    const auto powers = Formulas::sppPowers(depth, thickness, mu0, albedo, forward_share);
    const Lanes direct = Formulas::directPower(min(max(depth, 0.f), thickness), mu0);
    const auto radiance = Formulas::sppDiffuseRadiance(powers, direct);
    store(radiance.down, down + first, lanes);
    store(radiance.up, up + first, lanes);
  });
}

void compensation(const Places& places, const Edges& edges, float mu0, float* compensation) {
  forBlocks(places, [&](Lanes depth, Lanes thickness, std::size_t first, std::size_t lanes) {
    Lanes lost = 0.f;
    for (std::size_t j = 0; j < edges.count; ++j)
      lost += StreamFormulas<Lanes>::shareBeyondEdge(
          edges.cosines[j], loaded(edges.distances + j * places.count + first, lanes), depth, thickness, mu0);
    store(min(max(1.f - lost / static_cast<float>(edges.count), 0.f), 1.f), compensation + first, lanes);
  });
}

template <int kStreams>
void streamPowersOf(const Places& places, const StreamNumbers& numbers, const Weights& weights, float* down,
                    float* up) {
  using Formulas = StreamFormulas<Lanes, kStreams>;
  const auto modes = everywhere<typename Formulas::StreamModes>(numbers.modes);
  const auto weight = weightsOf<kStreams>(weights, 0);
  const Lanes depth_scale = numbers.depth_scale, beam_rate = numbers.beam_rate;
  forBlocks(places, [&](Lanes depth, Lanes thickness, std::size_t first, std::size_t lanes) {
    const auto at = Formulas::slabPlace(depth, thickness, depth_scale, beam_rate);
    const auto powers = Formulas::streamPowers(modes, weight, at);
    store(powers.down, down + first, lanes);
    store(powers.up, up + first, lanes);
  });
}

// The direct light scattered once, and what the modes of the first order send; further orders are added.
template <int kStreams, bool kDownward>
void refinedRadianceAlong(const Places& places, const StreamNumbers& numbers, const ViewNumbers& view,
                          float* radiance) {
  using Formulas = StreamFormulas<Lanes, kStreams>;
  constexpr std::size_t kModes = sizeof(typename Formulas::StreamModes) / sizeof(Lanes);
  const Lanes depth_scale = numbers.depth_scale, beam_rate = numbers.beam_rate, rate = view.rate;
  for (int order = 0; order < numbers.orders; ++order) {
    const auto modes = everywhere<typename Formulas::StreamModes>(numbers.modes + order * kModes);
    const auto seen = weightsOf<kStreams>(view.seen, order);
    const Lanes beam_source = order == 0 ? view.beam_source : 0.f;
    const bool last = order == numbers.orders - 1;
    forBlocks(places, [&](Lanes depth, Lanes thickness, std::size_t first, std::size_t lanes) {
      const auto at = Formulas::slabPlace(depth, thickness, depth_scale, beam_rate);
      const Lanes fade = exp(-rate * (kDownward ? at.depth : at.rest));
      const Lanes beam =
          kDownward ? Formulas::beamAlongDownward(at, rate, fade) : Formulas::beamAlongUpward(at, rate, fade);
      Lanes sum = beam_source * beam + Formulas::streamRadiance(modes, seen, at, kDownward, rate, fade, beam);
      if (order > 0) sum += loaded(radiance + first, lanes);
      if (last) sum = max(sum, 0.f);
      store(sum, radiance + first, lanes);
    });
  }
}

template <int kStreams>
void refinedRadianceOf(const Places& places, const StreamNumbers& numbers, const ViewNumbers& view, float* radiance) {
  return view.downward ? refinedRadianceAlong<kStreams, true>(places, numbers, view, radiance)
                       : refinedRadianceAlong<kStreams, false>(places, numbers, view, radiance);
}

// Calls the function for the number of streams, one of StreamArrays::kStreams.
#define SUNFLECK_FOR_STREAMS(function, streams, ...) \
  switch (streams) {                                 \
    case 1:                                          \
      return function<1>(__VA_ARGS__);               \
    case 2:                                          \
      return function<2>(__VA_ARGS__);               \
    case 3:                                          \
      return function<3>(__VA_ARGS__);               \
    case 4:                                          \
      return function<4>(__VA_ARGS__);               \
    default:                                         \
      return function<8>(__VA_ARGS__);               \
  }

void streamPowers(const Places& places, const StreamNumbers& numbers, const Weights& weights, float* down, float* up) {
  SUNFLECK_FOR_STREAMS(streamPowersOf, numbers.streams, places, numbers, weights, down, up)
}

void refinedRadiance(const Places& places, const StreamNumbers& numbers, const ViewNumbers& view, float* radiance) {
  SUNFLECK_FOR_STREAMS(refinedRadianceOf, numbers.streams, places, numbers, view, radiance)
}

}  // namespace

extern const detail::ArrayKernel the_kernel;
constinit const detail::ArrayKernel the_kernel{.compensation = compensation,
                                               .sppPowers = sppPowers,
                                               .sppRadiance = sppRadiance,
                                               .streamPowers = streamPowers,
                                               .refinedRadiance = refinedRadiance};

}  // namespace sunfleck::spp::SUNFLECK_ISA
