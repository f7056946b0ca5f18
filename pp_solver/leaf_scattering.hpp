#pragma once

#include <span>

#include "pp_solver/leaf_angles.hpp"

namespace sunfleck::pp {

// Leaves as Ross 1981 has them: flat, small, bi-Lambertian, the same on both sides. Depth is leaf area index.
struct LeafScattering {
  LeafAngles angles = LeafAngles::spherical();
  double reflectance = 0.5, transmittance = 0.5;  // of a leaf [1], each 0 .. 1, their sum omega at most 1
  // Leaf diameter over canopy height [1], >= 0: how far the hot spot reaches (Kuusk 1991); 0 has none.
  double hot_spot = 0.;
};

// G(mu): mean |n . s| over the leaves [1], the extinction per leaf area for light whose |cos| to the vertical is mu.
double leafProjection(const LeafAngles& angles, double mu);

// Fourier modes of |n . s| over the leaf's azimuth, for light s of |cos| mu travelling downward, and each inclination
// node of `angles`:  |n . s|(phi) = sum over m of result[r] cos(m phi).  result.size() = angles.nodes().size().
// Travelling upward at the same |cos| multiplies mode m by (-1)^m.
void leafProjectionModes(const LeafAngles& angles, int mode, double mu, std::span<double> result);

}  // namespace sunfleck::pp
