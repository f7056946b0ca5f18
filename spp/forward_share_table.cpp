#include "spp/forward_share_table.hpp"

#include <algorithm>
#include <cmath>

#include "spp/forward_share.hpp"

namespace sunfleck::spp {
namespace {

using Values = std::array<float, ForwardShareTable::kIntervals + 1>;

// Lagrange's cubic through four neighbours, at x intervals from the start.
float cubic(const Values& values, float x) {
  const int first = std::clamp(static_cast<int>(x) - 1, 0, ForwardShareTable::kIntervals - 3);
  const float* v = &values[static_cast<std::size_t>(first)];
  const float a = x - static_cast<float>(first), b = a - 1.f, c = a - 2.f, d = a - 3.f;
  return b * c * (a * v[3] - d * v[0]) / 6.f + a * d * (c * v[1] - b * v[2]) / 2.f;
}

double cosineAt(double x, double bend) {
  const double t = x / ForwardShareTable::kIntervals;
  return std::clamp(bend * t / (1. + bend - t), 1e-12, 1.);
}

}  // namespace

ForwardShareTable::ForwardShareTable(const Medium& medium) {
  for (double bend = 2.; bend > 1e-3; bend *= 0.5) {
    Values values;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(forwardShare(medium, cosineAt(static_cast<double>(i), bend)));
    double error = 0.;
    for (int i = 0; i < 4 * kIntervals && error < error_; ++i) {
      if (i % 4 == 0) continue;
      const double x = 0.25 * i, exact = forwardShare(medium, cosineAt(x, bend));
      error = std::max(error, std::abs(double{cubic(values, static_cast<float>(x))} - exact));
    }
    if (error >= error_) continue;
    error_ = error;
    bend_ = static_cast<float>(bend);
    values_ = values;
  }
}

float ForwardShareTable::operator()(float mu) const {
  return cubic(values_, static_cast<float>(kIntervals) * mu * (1.f + bend_) / (mu + bend_));
}

}  // namespace sunfleck::spp
