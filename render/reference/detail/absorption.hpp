#pragma once

#include "core/random.hpp"

namespace sunfleck::detail {

// Below this weight a path is absorbed whole or not at all.
inline constexpr double kRouletteWeight = 0.5;

// A path of this many scatterings is absorbed where it is: it can only be caught where nothing absorbs.
inline constexpr int kMostScatterings = 1'000'000;

// Light of a path meets a surface of this albedo [1]: takes the absorbed share off `weight`, adds it to `absorbed`, and
// answers whether the path goes on. A heavy path loses its share for certain; a light one loses all of itself with the
// share's probability. Both are unbiased, and in both no light is made or lost: weight + absorbed stay the same.
inline bool scatters(double albedo, double& weight, double& absorbed, Random& random) {
  if (weight >= kRouletteWeight && albedo > 0.) {
    absorbed += weight * (1. - albedo);
    weight *= albedo;
    return true;
  }
  if (random.uniformDouble() < albedo) return true;
  absorbed += weight;
  weight = 0.;
  return false;
}

}  // namespace sunfleck::detail
