#pragma once

#include <atomic>
#include <cstdint>

namespace sunfleck {

// The first of so many numbers in a row that nobody had before, in the whole process: what is told by such a number
// never passes for something else, whoever made it. Never 0. Any thread may ask.
inline std::uint64_t newRevisions(std::uint64_t count = 1) {
  static std::atomic<std::uint64_t> next{1};
  return next.fetch_add(count, std::memory_order_relaxed);
}

}  // namespace sunfleck
