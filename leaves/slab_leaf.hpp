#pragma once

#include <span>
#include <string>
#include <vector>

#include "leaves/leaf_sides.hpp"

namespace sunfleck {

// The inside of a leaf in one band of light: an even slab that scatters isotropically (Ganapol et al. 1998).
struct LeafTissue {
  double absorption = 0.;  // sigma_a [1/mm], 0 .. 1e6
  double scattering = 0.;  // sigma_s [1/mm], 0 .. 1e6
  double thickness = 0.2;  // h [mm], 0 .. 1000

  double opticalThickness() const { return (absorption + scattering) * thickness; }  // Delta [1]
  bool operator==(const LeafTissue&) const = default;
};

// Throws InvalidInput("<where><name> = <value>: must be ...") where one of them is out of its range.
void validate(const LeafTissue& tissue, const std::string& where = "");

// What it does to light that falls upright on it, above black ground.
struct SlabLeaf {
  LeafSides sides;          // rho_d and rho_t, the latter with the direct light
  double direct = 0.;       // e^-Delta, the direct light in rho_t [1]
  double absorptance = 0.;  // from the mean intensity within, not as what is missing [1]
  // A and B of Wang et al. 2005: rho_d = A omega / 2, rho_t = e^-Delta + B omega / 2, omega = sigma_s / sigma_t.
  // Constant there, they depend on Delta and omega. 0 where nothing scatters.
  double a = 0., b = 0.;
};

// (L8) By the exact plane-parallel solution with 32 directions: off by 2e-7 at most (Delta 0.01 to 100);
// sides and absorptance add up to 1 within 1e-10. Throws InvalidInput as validate() does. Some 0.1 ms.
SlabLeaf slabLeaf(const LeafTissue& tissue);

struct TissueFit {
  LeafTissue tissue;
  double residual = 0.;  // the larger difference of reflectance and transmittance from what was measured [1]
};

// (L9) The tissue of leaves of this thickness [mm], above 0 to 1000, that have these reflectances (0 .. 1) and
// transmittances (1e-4 .. 1), at most 1 together: of all places of a map in one call, on all threads. By 16 directions,
// off by 5e-6; the same to the bit for any number of threads. Throws InvalidInput that names the first place out of
// range.
std::vector<TissueFit> tissueOf(std::span<const LeafSides> measured, double thickness);

}  // namespace sunfleck
