#pragma once

#include <array>

#include "core/quantities.hpp"

namespace sunfleck {

// Red, green and blue: the bands a picture is made in.
inline constexpr int kBands = 3;

// A leaf that scatters by Lambert's law on both sides, in one band of light; under a gloss, if it has one.
struct LeafOptics {
  Number reflectance = 0.475f;    // rho [1], >= 0: share of the arriving light sent back on the side it came from
  Number transmittance = 0.475f;  // tau [1], >= 0: share sent on through the leaf; rho + tau <= 1
  Number albedo() const { return reflectance + transmittance; }  // omega [1], 0 .. 1
  // (R20) Beneath a gloss, reflectance and transmittance are shares of the light that it has not reflected.
  Number gloss = 0.f;             // rho_s [1], 0 .. 1: intensity of the glossy reflection on both sides
  Number gloss_roughness = 0.3f;  // m [1], kLeastGlossRoughness .. 1: root mean square slope of its facets
  bool operator==(const LeafOptics&) const = default;
};

inline constexpr float kLeastGlossRoughness = 0.05f;

using BandOptics = std::array<LeafOptics, kBands>;

// Throws InvalidInput when a share is negative, not a number, or their sum exceeds 1, and on a gloss out of its range.
void validate(const LeafOptics& optics);

}  // namespace sunfleck
