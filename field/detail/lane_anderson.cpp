#include "field/detail/lane_anderson.hpp"

namespace sunfleck::detail {

// (F18) The coefficients that leave the least change: the normal equations by Cholesky, as far as the differences are
// independent.
std::array<double, LaneAnderson::kHistory> LaneAnderson::mixtureOf(std::size_t lane) const {
  std::array<std::array<double, kHistory>, kHistory> factor{};
  std::array<double, kHistory> y{}, mixture{};
  std::array<bool, kHistory> used{};
  for (std::size_t j = 0; j < kept_; ++j) {
    double right = with_change_[j][lane];
    for (std::size_t l = 0; l < j; ++l) {
      double sum = with_steps_[j][l][lane];
      for (std::size_t k = 0; k < l; ++k) sum -= factor[j][k] * factor[l][k];
      factor[j][l] = used[l] ? sum / factor[l][l] : 0.;
      right -= factor[j][l] * y[l];
    }
    double square = with_steps_[j][j][lane];
    for (std::size_t l = 0; l < j; ++l) square -= factor[j][l] * factor[j][l];
    used[j] = square > 1e-10 * with_steps_[j][j][lane] && square > 0.;  // the sums are of single precision
    factor[j][j] = used[j] ? std::sqrt(square) : 1.;
    y[j] = used[j] ? right / factor[j][j] : 0.;
  }
  for (std::size_t j = kept_; j-- > 0;) {
    double sum = y[j];
    for (std::size_t l = j + 1; l < kept_; ++l) sum -= factor[l][j] * mixture[l];
    mixture[j] = used[j] ? sum / factor[j][j] : 0.;
  }
  return mixture;
}

}  // namespace sunfleck::detail
