#pragma once

#include <array>
#include <span>
#include <vector>

#include "spp/stream_constants.hpp"
#include "spp/stream_view.hpp"

// The closed forms at many places at once, in single precision, as many places in a step as a vector of the machine
// holds. Each place has a depth and a slab's thickness of its own, both true optical depths [1]: thickness >= 0, may be
// infinite; what lies outside the slab counts as its face. All spans of a call have one size, the number of places; no
// output may overlap another. Results are finite, not negative, and within 5e-6 of those in double precision: absolute
// for light of power 1, relative for radiance above 1 (bench/stress_spp.cpp; radiance of 3 streams and more for
// g < -0.99: 1e-5). Each place's result is the same whatever places are beside it.
namespace sunfleck::spp {

namespace detail {
struct StreamNumbers;
}

// (S2) P+ and P- [F] of SPP. mu0 (0, 1], albedo and forward_share 0 .. 1, as in spp_formulas.glsl.
void sppPowers(std::span<const float> depth, std::span<const float> thickness, float mu0, float albedo,
               float forward_share, std::span<float> down, std::span<float> up);

// (S3) Diffuse radiance of SPP, downward and upward, alike in all directions of a half [1/sr].
void sppRadiance(std::span<const float> depth, std::span<const float> thickness, float mu0, float albedo,
                 float forward_share, std::span<float> down, std::span<float> up);

// A closed form of 1, 2, 3, 4 or 8 streams in slabs of one medium under one beam.
class StreamArrays {
 public:
  static constexpr std::array kStreams{1, 2, 3, 4, 8};

  // Throws InvalidInput for another number of streams.
  explicit StreamArrays(const StreamConstants& constants);

  // (S9) P+ with the direct light, and P- [F]: as StreamSlab::light.
  void powers(std::span<const float> depth, std::span<const float> thickness, std::span<float> down,
              std::span<float> up) const;

  // (S10) Diffuse radiance along one direction, a view of the same constants [1/sr]: as StreamSlab::refinedRadiance.
  void refinedRadiance(std::span<const float> depth, std::span<const float> thickness, const StreamView<float>& view,
                       std::span<float> radiance) const;

 private:
  detail::StreamNumbers numbers() const;

  int streams_, orders_;
  float depth_scale_, beam_rate_;
  std::vector<float> modes_;  // as modeNumbers() lays them out
  std::vector<float> power_sum_, power_difference_;
};

}  // namespace sunfleck::spp
