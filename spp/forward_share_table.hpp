#pragma once

#include <array>

#include "scattering/medium.hpp"

namespace sunfleck::spp {

// (S8) T(mu) of one medium as 65 numbers, for single precision and for shaders, whose views it serves: sppr and
// twostream ask for T in each direction of view. Equidistant in t = mu (1 + bend) / (mu + bend), which is 0 and 1 where
// mu is, with cubics through four neighbours; bend is the power of two for which the error is least. Made in a
// few milliseconds, of leaves in some tens.
class ForwardShareTable {
 public:
  static constexpr int kIntervals = 64;

  explicit ForwardShareTable(const Medium& medium);

  float operator()(float mu) const;  // mu [0, 1]

  // The largest difference from forwardShare() at three places of each interval: 2e-7 for Henyey and Greenstein's |g|
  // <= 0.95 and for leaves, 1e-5 to |g| = 0.999. Straight lines between the values are 5e-5 off.
  double error() const { return error_; }
  float bend() const { return bend_; }
  const std::array<float, kIntervals + 1>& values() const { return values_; }

 private:
  float bend_ = 1.f;
  double error_ = 1.;
  std::array<float, kIntervals + 1> values_{};
};

}  // namespace sunfleck::spp
