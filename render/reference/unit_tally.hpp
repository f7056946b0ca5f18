#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sunfleck {

// What one unit of a run adds to each bin. Few of many bins may be met: only those are cleared and summed up.
class UnitTally {
 public:
  explicit UnitTally(std::size_t bins) : values_(bins, kUnmet) {}

  void add(std::size_t bin, double value) {
    double& sum = values_[bin];
    if (std::bit_cast<std::uint64_t>(sum) == std::bit_cast<std::uint64_t>(kUnmet))
      met_.push_back(static_cast<std::uint32_t>(bin));
    sum += value + 0.;
  }
  void clear() {
    for (const std::uint32_t bin : met_) values_[bin] = kUnmet;
    met_.clear();
  }

  std::span<const std::uint32_t> met() const { return met_; }
  double value(std::size_t bin) const { return values_[bin]; }

 private:
  // No sum that was added to is ever -0: x + 0 is not, and sums that cancel are +0.
  static constexpr double kUnmet = -0.;

  std::vector<double> values_;
  std::vector<std::uint32_t> met_;
};

}  // namespace sunfleck
