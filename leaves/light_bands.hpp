#pragma once

#include <array>
#include <optional>

#include "core/leaf_optics.hpp"
#include "leaves/leaf_spectrum.hpp"

namespace sunfleck {

// (L5) Reflectance and transmittance in red, green and blue: the colour of white paper (CIE standard illuminant D65, 2
// degree observer of 1931) seen by the light that the leaf reflects or lets through, linear, with the primaries of
// sRGB. A leaf that reflects all is 1, 1, 1. A colour that no display has is cut to 0 .. 1, and where reflectance and
// transmittance are more than 1 together, both shrink to 1. Below 400 nm the leaf is as at 400 nm.
std::array<LeafSides, kBands> rgbOf(const LeafSpectrum& spectrum);

// What the three bands of a picture or a trace stand for; none: red, green and blue.
using LightBands = std::optional<std::array<WavelengthBand, kBands>>;

// Without gloss, rounded so that reflectance + transmittance is at most 1 in single precision, too.
LeafOptics leafOptics(const LeafSides& sides);

// The leaf in each of the bands, by (L4) or (L5). Throws InvalidInput as meanIn() does.
BandOptics bandOptics(const LeafSpectrum& spectrum, const LightBands& bands = std::nullopt);

}  // namespace sunfleck
