#pragma once

#include <cmath>

#include "render/reference/forward_trace.hpp"

namespace sunfleck::detail {

// Running mean of equally large batches and the spread about it (Welford 1962). `count` is the caller's, so that the
// thousands of leaves share one.
struct BatchMean {
  double mean = 0.;
  double squares = 0.;  // sum of squared deviations from the mean

  void add(double value, double count_with_this) {
    const double deviation = value - mean;
    mean += deviation / count_with_this;
    squares += deviation * (value - mean);
  }
  Estimate estimate(double count) const {
    if (count < 2.) return {mean, std::abs(mean)};
    return {mean, std::sqrt(squares / (count * (count - 1.)))};
  }
};

}  // namespace sunfleck::detail
