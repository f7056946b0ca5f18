#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sunfleck {

// What one unit of a run adds to each bin. Few of many bins may be met: only those are cleared and summed up.
class UnitTally {
 public:
  explicit UnitTally(std::size_t bins) : values_(bins) {}

  void add(std::size_t bin, double value) {
    double& sum = values_[bin];
    if (sum == 0. && value != 0.) met_.push_back(static_cast<std::uint32_t>(bin));
    sum += value;
  }
  void clear() {
    for (const std::uint32_t bin : met_) values_[bin] = 0.;
    met_.clear();
  }

  std::span<const std::uint32_t> met() const { return met_; }
  double value(std::size_t bin) const { return values_[bin]; }

 private:
  std::vector<double> values_;
  std::vector<std::uint32_t> met_;
};

}  // namespace sunfleck
