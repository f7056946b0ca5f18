#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/progress.hpp"

namespace sunfleck {

// Sparse grids are made block by block: what has a part in a block of 8 x 8 x 8 cells is listed as a visit, the visits
// are sorted by blocks, and each block is then made by one thread from its own visits in their order, which threads
// cannot change.
constexpr int kBlock = 8;

struct Visit {
  std::uint64_t block;    // its key
  std::uint32_t visitor;  // a triangle or a tree
};

// x, y and z of a block, 0 .. 2^21 - 1 each, as one number.
inline std::uint64_t blockKey(const glm::ivec3& block) {
  return (static_cast<std::uint64_t>(block.x) << 42) | (static_cast<std::uint64_t>(block.y) << 21) |
         static_cast<std::uint64_t>(block.z);
}

inline glm::ivec3 blockOf(std::uint64_t key) {
  constexpr std::uint64_t mask = (1u << 21) - 1;
  return {static_cast<int>(key >> 42), static_cast<int>((key >> 21) & mask), static_cast<int>(key & mask)};
}

// Visits block after block, those of a block in the order in which they were listed.
class SortedVisits {
 public:
  explicit SortedVisits(std::vector<Visit> visits);
  std::size_t blocks() const { return first_.size() - 1; }
  std::span<const Visit> ofBlock(std::size_t i) const {
    return std::span(all_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  std::span<const Visit> fromBlock(std::size_t i) const { return std::span(all_).subspan(first_[i]); }  // to the last

 private:
  std::vector<Visit> all_;
  std::vector<std::size_t> first_;  // of each block, and the end
};

// A part of the whole work, of whose own 0 .. 1 progress is told.
struct Stage {
  const Progress& progress;
  double begin, end;

  void report(double done) const {
    if (!goOn(progress, begin + (end - begin) * done)) throw std::runtime_error("interrupted");
  }

  // Runs `work(i)` for all i < count in parallel and tells progress from `from` to `to` between batches.
  template <typename Work>
  void inBatches(std::size_t count, double from, double to, const Work& work) const {
    constexpr std::size_t batches = 64;
    for (std::size_t batch = 0; batch < batches; ++batch) {
      report(from + (to - from) * static_cast<double>(batch) / batches);
      tbb::parallel_for(count * batch / batches, count * (batch + 1) / batches, work);
    }
  }
};

// Throws InvalidInput unless grids of that many bytes fit in 8 GiB and in the memory there is.
void requireMemory(double bytes, double cell_size);

}  // namespace sunfleck
