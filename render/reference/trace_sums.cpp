#include "render/reference/trace_sums.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sunfleck {
namespace {

__extension__ using Quad = __float128;

}  // namespace

void ExactSum::add(double value) {
  if (!(std::abs(value) < 0x1p40)) throw std::overflow_error("a unit of a trace found a value beyond 2^40");
  whole += static_cast<Whole>(std::nearbyint(value * 0x1p64));
}

double ExactSum::value() const {
  return static_cast<double>(whole) * 0x1p-64;
}

void TraceSums::add(std::uint64_t seed, std::uint64_t unit, const UnitTally& tally) {
  done_[seed].add(unit);
  for (const std::uint32_t i : tally.met()) {
    const double value = tally.value(i);
    bins_[i].sum.add(value);
    bins_[i].squares.add(value * value);
  }
}

void TraceSums::add(const TraceSums& other) {
  if (other.bins() != bins() || other.groups_ != groups_) throw std::logic_error("sums of runs of different kinds");
  for (const auto& [seed, units] : other.done_)
    for (const auto& [first, last] : units.ranges()) done_[seed].add(first, last);
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    bins_[i].sum.whole += other.bins_[i].sum.whole;
    bins_[i].squares.whole += other.bins_[i].squares.whole;
  }
}

Estimate TraceSums::estimate(std::size_t bin, std::uint64_t group) const {
  const auto n = static_cast<double>(units(group));
  if (n == 0.) return {};
  const double mean = bins_[bin].sum.value() / n;
  if (n < 2.) return {mean, std::abs(mean)};
  // The difference of squares keeps all digits of the exact sums.
  const Quad sum = static_cast<Quad>(bins_[bin].sum.whole), squares = static_cast<Quad>(bins_[bin].squares.whole);
  const Quad deviations = squares * 0x1p64 - sum * sum / n;  // squared, of all units, in 2^-128
  return {mean, std::sqrt(std::max(0., static_cast<double>(deviations) * 0x1p-128) / (n * (n - 1.)))};
}

std::uint64_t TraceSums::units(std::uint64_t group) const {
  std::uint64_t result = 0;
  for (const auto& [seed, units] : done_) result += units.countOf(group, groups_);
  return result;
}

std::uint64_t TraceSums::units() const {
  std::uint64_t result = 0;
  for (const auto& [seed, units] : done_) result += units.count();
  return result;
}

const UnitRanges& TraceSums::done(std::uint64_t seed) const {
  static const UnitRanges none;
  const auto found = done_.find(seed);
  return found == done_.end() ? none : found->second;
}

}  // namespace sunfleck
