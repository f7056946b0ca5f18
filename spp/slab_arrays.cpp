#include "spp/slab_arrays.hpp"

#include <algorithm>
#include <cassert>

#include "core/require.hpp"
#include "spp/detail/array_kernel.hpp"
#include "spp/mode_numbers.hpp"

namespace sunfleck::spp {
namespace {

detail::Places places(std::span<const float> depth, std::span<const float> thickness) {
  assert(depth.size() == thickness.size());
  return {.count = depth.size(), .depth = depth.data(), .thickness = thickness.data()};
}

}  // namespace

void sppPowers(std::span<const float> depth, std::span<const float> thickness, float mu0, float albedo,
               float forward_share, std::span<float> down, std::span<float> up) {
  assert(down.size() == depth.size() && up.size() == depth.size());
  detail::arrayKernel().sppPowers(places(depth, thickness), mu0, albedo, forward_share, down.data(), up.data());
}

void sppRadiance(std::span<const float> depth, std::span<const float> thickness, float mu0, float albedo,
                 float forward_share, std::span<float> down, std::span<float> up) {
  assert(down.size() == depth.size() && up.size() == depth.size());
  detail::arrayKernel().sppRadiance(places(depth, thickness), mu0, albedo, forward_share, down.data(), up.data());
}

StreamArrays::StreamArrays(const StreamConstants& constants)
    : streams_(constants.streams()),
      orders_(static_cast<int>(constants.orders.size())),
      depth_scale_(static_cast<float>(constants.depth_scale)),
      beam_rate_(static_cast<float>(constants.beam_rate)),
      modes_(modeNumbers<float>(constants)) {
  require(std::ranges::find(kStreams, streams_) != kStreams.end(), "streams", streams_, "1, 2, 3, 4 or 8");
  const PowerWeights weights = powerWeights(constants);
  power_sum_.assign(weights.power_sum.begin(), weights.power_sum.end());
  power_difference_.assign(weights.power_difference.begin(), weights.power_difference.end());
}

detail::StreamNumbers StreamArrays::numbers() const {
  return {.streams = streams_,
          .orders = orders_,
          .depth_scale = depth_scale_,
          .beam_rate = beam_rate_,
          .modes = modes_.data()};
}

void StreamArrays::powers(std::span<const float> depth, std::span<const float> thickness, std::span<float> down,
                          std::span<float> up) const {
  assert(down.size() == depth.size() && up.size() == depth.size());
  detail::arrayKernel().streamPowers(places(depth, thickness), numbers(), {power_sum_.data(), power_difference_.data()},
                                     down.data(), up.data());
}

void StreamArrays::refinedRadiance(std::span<const float> depth, std::span<const float> thickness,
                                   const StreamView<float>& view, std::span<float> radiance) const {
  assert(radiance.size() == depth.size());
  detail::arrayKernel().refinedRadiance(places(depth, thickness), numbers(),
                                        {.downward = view.cosine > 0.f,
                                         .rate = view.rate,
                                         .beam_source = view.beam_source,
                                         .seen = {view.seen_sum.data(), view.seen_difference.data()}},
                                        radiance.data());
}

}  // namespace sunfleck::spp
