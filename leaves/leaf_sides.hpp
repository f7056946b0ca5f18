#pragma once

namespace sunfleck {

// What a leaf does to light of one wavelength, in double precision.
struct LeafSides {
  double reflectance = 0.;    // R [1], 0 .. 1
  double transmittance = 0.;  // T [1], 0 .. 1; R + T <= 1
};

}  // namespace sunfleck
