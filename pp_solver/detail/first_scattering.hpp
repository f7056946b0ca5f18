#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "pp_solver/problem.hpp"

namespace sunfleck::pp::detail {

// Light of the beam scattered once, of a source 1, after a depth z in a slab of thickness w, which may be infinite:
// beam's extinction over its cosine k0, the view's m. Safe for k0 = m, for 0 and for large exponents.
template <typename Number>
Number onceDown(Number k0, Number m, Number z) {
  const Number apart = std::abs(m - k0), low = m < k0 ? m : k0;
  return std::exp(-low * z) *
         (apart * z < std::numeric_limits<Number>::epsilon() ? z : -std::expm1(-apart * z) / apart);
}
template <typename Number>
Number onceUp(Number k0, Number m, Number z, Number w) {
  const Number sum = m + k0, y = w - z;
  return std::exp(-k0 * z) * (sum * y < std::numeric_limits<Number>::epsilon() ? y : -std::expm1(-sum * y) / sum);
}

// The same as fast, in single precision: Henyey and Greenstein's function by its formula, others by splines (P12).
struct FirstScattering {
  enum class Kind : int { henyeyGreenstein, angle, leaves };
  static constexpr int kAngles = 1025, kDirections = 25, kProjections = 129, kModes = 16;

  Kind kind = Kind::henyeyGreenstein;
  float albedo = 0.f, asymmetry = 0.f;
  std::vector<float> phase;       // omega p over the angle of scattering: kAngles + 2
  std::vector<float> kernel;      // Gamma [half][mu0][mu][mode]: 2 (kDirections + 2)^2 kModes
  std::vector<float> projection;  // G over |cos|: kProjections + 2

  static FirstScattering of(const Medium& medium);
  float into(float mu, float mu0, float cos_azimuth) const;
  float extinction(float mu) const;  // of |cos| mu
};

// Sum over m of c[m] cos(m azimuth).
inline float cosineSeries(const float* c, int modes, float cosine) {
  float next = 0.f, after = 0.f;  // Clenshaw
  for (int m = modes - 1; m > 0; --m) {
    const float now = c[m] + 2.f * cosine * next - after;
    after = next;
    next = now;
  }
  return c[0] + cosine * next - after;
}

}  // namespace sunfleck::pp::detail
