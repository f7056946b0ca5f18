#include "render/reference/unit_ranges.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace sunfleck {

void UnitRanges::add(std::uint64_t first, std::uint64_t last) {
  if (first >= last) return;
  auto after = ranges_.lower_bound(first);
  const bool has_before = after != ranges_.begin();
  const auto before = has_before ? std::prev(after) : after;
  if ((has_before && before->second > first) || (after != ranges_.end() && after->first < last))
    throw std::logic_error("a unit is added twice");
  if (after != ranges_.end() && after->first == last) {
    last = after->second;
    ranges_.erase(after);
  }
  if (has_before && before->second == first)
    before->second = last;
  else
    ranges_.emplace(first, last);
}

bool UnitRanges::contains(std::uint64_t unit) const {
  const auto after = ranges_.upper_bound(unit);
  return after != ranges_.begin() && std::prev(after)->second > unit;
}

UnitRanges::Range UnitRanges::overlap(const UnitRanges& other) const {
  for (const auto& [first, last] : ranges_) {
    auto at = other.ranges_.upper_bound(first);
    if (at != other.ranges_.begin()) --at;
    for (; at != other.ranges_.end() && at->first < last; ++at) {
      const Range common{std::max(first, at->first), std::min(last, at->second)};
      if (common.first < common.second) return common;
    }
  }
  return {0, 0};
}

std::uint64_t UnitRanges::count() const {
  return countOf(0, 1);
}

std::uint64_t UnitRanges::countOf(std::uint64_t remainder, std::uint64_t divisor) const {
  const auto below = [&](std::uint64_t end) {
    return end / divisor + (end % divisor > remainder ? 1 : 0);
  };  // in [0, end)
  std::uint64_t result = 0;
  for (const auto& [first, last] : ranges_) result += below(last) - below(first);
  return result;
}

UnitRanges UnitRanges::without(const UnitRanges& other) const {
  UnitRanges result;
  for (const auto& [start, last] : ranges_) {
    std::uint64_t first = start;
    auto at = other.ranges_.upper_bound(first);
    if (at != other.ranges_.begin()) --at;
    for (; at != other.ranges_.end() && at->first < last; ++at) {
      if (at->second <= first) continue;
      result.add(first, at->first);
      first = at->second;
    }
    result.add(first, last);
  }
  return result;
}

void addMissing(UnitRanges& units, std::uint64_t count, const UnitRanges& done, std::uint64_t remainder,
                std::uint64_t divisor) {
  for (std::uint64_t unit = remainder; count > 0; unit += divisor) {
    if (done.contains(unit)) continue;
    units.add(unit);
    --count;
  }
}

}  // namespace sunfleck
