#pragma once

#include "leaves/leaf_sides.hpp"

namespace sunfleck {

// (L1) Share of diffuse light that an absorbing plate lets through, its faces left out: 2 E3(k) =
// (1 - k) e^-k + k^2 E1(k) [1], falling from 1 at k = 0 to 0. `absorption` k: optical thickness along the normal
// [1], >= 0, infinity included. Right to 1e-14 of 1.
double plateTransmittance(double absorption);

// (L2) Share of unpolarised light that a smooth face of refractive index n [1], above 1, lets in, by Fresnel, averaged
// by projected solid angle over all directions within `half_angle` [rad], above 0 to pi / 2, of its normal (Stern 1964,
// Allen 1973). Right to 1e-10 for n in [1.05, 3].
double faceTransmittance(double refractive_index, double half_angle);

// The faces of a leaf's plates at one wavelength.
struct PlateFaces {
  double inner = 0.;    // n [1], > 1
  double lit = 0.;      // face transmittance for the light that arrives within 40 degrees [1]
  double diffuse = 0.;  // and for diffuse light [1]
};
PlateFaces plateFaces(double refractive_index);

// (L3) Reflectance and transmittance of a pile of `plates` N [1], >= 1, not whole in general, of which the first is lit
// within 40 degrees and the others by diffuse light; each takes `transmittance` tau [1], 0 .. 1, of diffuse light
// through its inside. The shares are 0 .. 1 and their sum is 1 at tau = 1, below otherwise, both to rounding; there is
// no N and no tau at which the formulas divide by 0.
LeafSides plates(const PlateFaces& faces, double transmittance, double plates);

}  // namespace sunfleck
