#pragma once

#include "render/reference/detail/scattering.hpp"

namespace sunfleck::detail {

// Light of one band meets a particle of this albedo [1]: takes the absorbed share off `weight`, adds it to `absorbed`,
// and answers whether the path goes on. A heavy path loses its share for certain; a light one loses all of itself with
// the share's probability. Both are unbiased, and in both no light is made or lost: weight + absorbed stay the same.
inline bool scatters(double albedo, double& weight, double& absorbed, PathRandom& random) {
  if (weight >= double{kRouletteWeight} && albedo > 0.) {
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
