#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>

// Problems of the field that are solved side by side, each in a lane of its own.
namespace sunfleck::detail {

constexpr std::size_t kLanes = 4;
typedef float Lanes __attribute__((vector_size(4 * kLanes)));
using LaneSums = std::array<double, kLanes>;

inline Lanes allLanes(float value) {
  return value - Lanes{};
}

inline void addTo(LaneSums& sums, const Lanes& values) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += double{values[lane]};
}
inline void addTo(LaneSums& sums, const LaneSums& values) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += values[lane];
}

constexpr std::size_t kBlock = 512;  // elements that are worth a task, and whose sums are rounded together

// Calls work(block, begin, end) for blocks of `count` elements, in parallel.
template <typename Work>
void overBlocks(std::size_t count, const Work& work) {
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  tbb::parallel_for(std::size_t{0}, blocks,
                    [&](std::size_t block) { work(block, block * kBlock, std::min(count, (block + 1) * kBlock)); });
}

// What one kind of element does to light, in each problem [1].
struct KindOptics {
  Lanes reflectance{}, transmittance{};
};

}  // namespace sunfleck::detail
