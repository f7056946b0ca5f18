#pragma once

#include <cstddef>
#include <cstdint>

namespace sunfleck {

// An optical depth in leaf crossings as a whole number of 1/512: 0 .. 128. Half a step, 1/1024, is the largest error,
// and changes e^-depth by less than 0.1 %; 128 or more lets nothing through. Whole numbers add up to the same sum in
// any order, and what was added can be taken away again.
using FixedDepth = std::uint16_t;
inline constexpr float kDepthSteps = 512.f;            // per leaf crossing
inline constexpr std::uint32_t kDeepest = UINT16_MAX;  // a sum this deep or deeper

// So many depths, and one more, add up to less than 2^31 steps.
inline constexpr std::size_t kMostSummed = 32'767;

constexpr FixedDepth fixedDepth(std::uint32_t steps) {
  return static_cast<FixedDepth>(steps < kDeepest ? steps : kDeepest);
}
// depth >= 0 [1]
constexpr std::uint32_t depthSteps(float depth) {
  return depth < 128.f ? static_cast<std::uint32_t>(depth * kDepthSteps + 0.5f) : kDeepest;
}
constexpr float depthOf(FixedDepth steps) {
  return static_cast<float>(steps) / kDepthSteps;
}

}  // namespace sunfleck
