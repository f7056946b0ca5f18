#include "grid/detail/block_visits.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <utility>

namespace sunfleck {
namespace {

// A list in parts, each worth a task.
class Parts {
 public:
  explicit Parts(std::size_t size) : size_(size), count_(std::clamp<std::size_t>(size / 16384, 1, 64)) {}
  std::size_t count() const { return count_; }
  std::size_t begin(std::size_t part) const { return size_ * part / count_; }

  // `work(part, begin, end)` of each, in parallel.
  template <typename Work>
  void each(const Work& work) const {
    tbb::parallel_for(std::size_t{0}, count_, [&](std::size_t part) { work(part, begin(part), begin(part + 1)); });
  }

 private:
  std::size_t size_, count_;
};

// Keys of blocks without the bits that are the same in all, in the same order.
class ShortKeys {
 public:
  explicit ShortKeys(const std::vector<Visit>& visits) {
    const std::uint64_t one = visits[0].block;
    const std::uint64_t differing = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, visits.size(), 16384), std::uint64_t{0},
        [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t bits) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) bits |= visits[i].block ^ one;
          return bits;
        },
        std::bit_or<>());
    const glm::ivec3 along = blockOf(differing);
    for (int axis = 0; axis < 3; ++axis) bits_[axis] = std::bit_width(static_cast<unsigned>(along[axis]));
  }
  int bits() const { return bits_.x + bits_.y + bits_.z; }
  std::uint64_t operator()(std::uint64_t key) const {
    const auto low = [](std::uint64_t of, int bits) { return of & ((std::uint64_t{1} << bits) - 1); };
    return (((low(key >> 42, bits_.x) << bits_.y) | low(key >> 21, bits_.y)) << bits_.z) | low(key, bits_.z);
  }

 private:
  glm::ivec3 bits_;  // of x, y and z
};

// Sorts by the digits of the short keys, the last one first, each time keeping the order of equal ones.
void sortByBlock(std::vector<Visit>& visits) {
  constexpr int kMostBits = 11;  // of a digit, so that the places of all its values fit in the cache
  const ShortKeys short_key(visits);
  const int digits = (short_key.bits() + kMostBits - 1) / kMostBits;
  if (digits == 0) return;
  const int bits = (short_key.bits() + digits - 1) / digits;
  const std::size_t values = std::size_t{1} << bits;
  const Parts parts(visits.size());
  std::vector<Visit> sorted(visits.size());
  std::vector<std::size_t> places(parts.count() * values);  // where the next visit of a part goes, for each value
  for (int digit = 0; digit < digits; ++digit) {
    const auto valueOf = [&](const Visit& visit) { return short_key(visit.block) >> digit * bits & (values - 1); };
    parts.each([&](std::size_t part, std::size_t begin, std::size_t end) {
      std::size_t* const counts = &places[part * values];
      std::fill_n(counts, values, 0u);
      for (std::size_t i = begin; i < end; ++i) ++counts[valueOf(visits[i])];
    });
    std::size_t place = 0;
    for (std::size_t value = 0; value < values; ++value)
      for (std::size_t part = 0; part < parts.count(); ++part)
        place += std::exchange(places[part * values + value], place);
    parts.each([&](std::size_t part, std::size_t begin, std::size_t end) {
      std::size_t* const next = &places[part * values];
      for (std::size_t i = begin; i < end; ++i) sorted[next[valueOf(visits[i])]++] = visits[i];
    });
    visits.swap(sorted);
  }
}

}  // namespace

SortedVisits::SortedVisits(std::vector<Visit> visits) : all_(std::move(visits)) {
  if (!all_.empty()) sortByBlock(all_);
  const auto isFirst = [&](std::size_t i) { return i == 0 || all_[i].block != all_[i - 1].block; };
  const Parts parts(all_.size());
  std::vector<std::size_t> blocks_before(parts.count() + 1);
  parts.each([&](std::size_t part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) blocks_before[part + 1] += isFirst(i);
  });
  std::partial_sum(blocks_before.begin(), blocks_before.end(), blocks_before.begin());
  first_.resize(blocks_before.back() + 1, all_.size());
  parts.each([&](std::size_t part, std::size_t begin, std::size_t end) {
    std::size_t block = blocks_before[part];
    for (std::size_t i = begin; i < end; ++i)
      if (isFirst(i)) first_[block++] = i;
  });
}

}  // namespace sunfleck
