#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

#include "scattering/double_gauss.hpp"

namespace sunfleck {

// Directions for means over the sphere of what is alike on both sides of the principal plane: every cosine with every
// azimuth.
struct SphereRule {
  std::vector<double> mus, weights;  // cosines of both hemispheres, by Gauss's rule in each; the weights' sum is 1
  std::vector<double> phis;          // midpoints of the half circle, of equal weight [rad]
  std::size_t directions() const { return mus.size() * phis.size(); }
};

//   cosines   of each hemisphere, 1 or more
//   azimuths  of the half circle, 1 or more
inline SphereRule sphereRule(int cosines, int azimuths) {
  SphereRule sphere;
  const DoubleGauss gauss = doubleGauss(2 * cosines);
  for (std::size_t i = 0; i < gauss.mu.size(); ++i)
    for (const double half : {1., -1.}) {
      sphere.mus.push_back(half * gauss.mu[i]);
      sphere.weights.push_back(0.5 * gauss.weight[i]);
    }
  for (int j = 0; j < azimuths; ++j) sphere.phis.push_back((j + 0.5) * std::numbers::pi / azimuths);
  return sphere;
}

}  // namespace sunfleck
