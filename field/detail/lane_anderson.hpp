#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "field/detail/lanes.hpp"

namespace sunfleck::detail {

// (F18) Anderson's acceleration of up to kLanes fixed points x = g(x) side by side. Unlike `Anderson` it takes each
// entry of g(x) as it is made, so that the memory of large problems is gone through once.
class LaneAnderson {
 public:
  static constexpr std::size_t kHistory = 6;

  // Sums over entries of the weighted products that the mixture follows from.
  struct Products {
    std::array<LaneSums, kHistory> with_change{};  // <step_j, change>
    LaneSums newest_square{};                      // <newest step, newest step>
    void add(const Products& other) {
      for (std::size_t j = 0; j < kHistory; ++j) addTo(with_change[j], other.with_change[j]);
      addTo(newest_square, other.newest_square);
    }
  };
  using Mixture = std::array<Lanes, kHistory>;

  // Before the entries of the next g(x) are taken.
  void begin(std::size_t size) {
    const bool has_former = !passed_.empty();
    passed_.resize(size);
    change_.resize(size);
    has_former_ = has_former;
    if (!has_former) return;
    // The oldest difference makes room.
    if (kept_ == kHistory) {
      std::rotate(change_steps_.begin(), change_steps_.begin() + 1, change_steps_.end());
      std::rotate(passed_steps_.begin(), passed_steps_.begin() + 1, passed_steps_.end());
      for (std::size_t j = 1; j < kHistory; ++j)
        for (std::size_t l = 1; l <= j; ++l) with_steps_[j - 1][l - 1] = with_steps_[j][l];
      std::rotate(with_change_.begin(), with_change_.begin() + 1, with_change_.end());
      --kept_;
    }
    change_steps_[kept_].resize(size);
    passed_steps_[kept_].resize(size);
    ++kept_;
  }

  // An entry of x and of g(x); several threads may take different ones.
  //   weight    of its square
  //   products  what the entry adds to them is added
  void take(std::size_t entry, const Lanes& x, const Lanes& passed, float weight, Products& products) {
    const Lanes change = passed - x;
    if (has_former_) {
      change_steps_[kept_ - 1][entry] = change - change_[entry];
      passed_steps_[kept_ - 1][entry] = passed - passed_[entry];
    }
    change_[entry] = change;
    passed_[entry] = passed;
    if (kept_ == 0) return;
    const Lanes weights = allLanes(weight);
    const Lanes weighted = weights * change, newest = change_steps_[kept_ - 1][entry];
    for (std::size_t j = 0; j < kept_; ++j) addTo(products.with_change[j], weighted * change_steps_[j][entry]);
    addTo(products.newest_square, weights * newest * newest);
  }

  // After all entries are taken.
  //   products  the sums of theirs
  void end(const Products& products) {
    // The newest step leads from the change before to this one.
    for (std::size_t j = 0; j + 1 < kept_; ++j)
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        with_steps_[kept_ - 1][j][lane] = products.with_change[j][lane] - with_change_[j][lane];
    if (kept_ > 0) with_steps_[kept_ - 1][kept_ - 1] = products.newest_square;
    with_change_ = products.with_change;
  }

  const std::vector<Lanes>& passed() const { return passed_; }  // g(x)
  const std::vector<Lanes>& change() const { return change_; }  // g(x) - x

  // The coefficients of the history, of the first lanes, and an entry of the next x by them.
  Mixture mixture(std::size_t lanes) const {
    Mixture mixed{};
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const auto of_lane = mixtureOf(lane);
      for (std::size_t j = 0; j < kept_; ++j) mixed[j][lane] = static_cast<float>(of_lane[j]);
    }
    return mixed;
  }
  Lanes next(std::size_t entry, const Mixture& mixed) const {
    Lanes x = passed_[entry];
    for (std::size_t j = 0; j < kept_; ++j) x -= mixed[j] * passed_steps_[j][entry];
    return x;
  }

 private:
  std::array<double, kHistory> mixtureOf(std::size_t lane) const;

  std::size_t kept_ = 0;  // differences of the history
  bool has_former_ = false;
  std::vector<Lanes> passed_, change_;
  std::array<std::vector<Lanes>, kHistory> change_steps_, passed_steps_;
  std::array<LaneSums, kHistory> with_change_{};
  std::array<std::array<LaneSums, kHistory>, kHistory> with_steps_{};  // <step_j, step_l> at [j][l], l <= j
};

}  // namespace sunfleck::detail
