#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunfleck::detail {

// Probability of scattering by an angle of this cosine, by Henyey and Greenstein 1941 [1/sr].
inline double henyeyGreenstein(double g, double cosine) {
  const double base = (1. - g) * (1. - g) + 2. * g * (1. - cosine);
  return (1. - g * g) / (4. * std::numbers::pi * base * std::sqrt(base));
}

// Its distribution function inverted, with t = 2 u - 1 in -1 .. 1 and no division by g.
inline double sampledCosine(double g, double t) {
  const double base = 1. + g * t;
  const double cosine = (2. * t + g * (3. + t * t + g * (2. * t + g * (t * t - 1.)))) / (2. * base * base);
  return std::clamp(cosine, -1., 1.);
}

}  // namespace sunfleck::detail
