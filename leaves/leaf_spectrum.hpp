#pragma once

#include <vector>

#include "leaves/leaf_sides.hpp"

namespace sunfleck {

inline constexpr int kFirstWavelength = 400, kLastWavelength = 2500;  // [nm], of PROSPECT's table

// What a leaf does to light of each wavelength.
struct LeafSpectrum {
  std::vector<LeafSides> sides;  // at 400, 401 .. 2500 nm; linear between
};

// A band of light: all wavelengths from `low` to `high` with equal weight, or one if they are the same [nm], 400 ..
// 2500.
struct WavelengthBand {
  double low = 550., high = 550.;
  bool operator==(const WavelengthBand&) const = default;
};

// Throws InvalidInput, with `where` before its message, on a band out of order or outside of 400 .. 2500 nm.
void validate(const WavelengthBand& band, const char* where = "band");

// (L4) Mean of reflectance and transmittance over the band, whose limits need not be whole. Throws as validate() does.
LeafSides meanIn(const LeafSpectrum& spectrum, const WavelengthBand& band);

}  // namespace sunfleck
