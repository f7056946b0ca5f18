#pragma once

#include <algorithm>
#include <cmath>

namespace sunfleck::pp::detail {

// (P9) Moments as N directions can carry them (delta-M, Wiscombe 1977): the share f of the scattering that goes nearly
// straight on counts as not scattered. A backward peak too sharp for N moments is spread: the l-th moment of the
// unresolved part f falls as e^-3(l/N)^2 while f is small, which is close, and as Cesaro's (1 - l / N)(1 - l / (N + 1))
// where it is most of the peak, which lets no flux become negative (measured: the former fails from f = 0.65 on).
// Writes the scaled omega chi_l to scatter[l * stride] and returns the ratio of scaled to true depth, 1 - omega f.
//   chi  moments 0 .. streams of the phase function
inline double scaleMoments(double albedo, const double* chi, int streams, bool delta_m, double* scatter, int stride) {
  const double last = chi[streams], before = chi[streams - 1];
  const bool sharp = delta_m && last > 0.;
  const double peak = sharp && before >= last ? last : 0., spread = sharp && before < 0. ? last : 0.;
  const double cusp = std::clamp((spread - 0.3) / 0.3, 0., 1.);
  const double scale = 1. - albedo * peak, share = albedo / scale;
  for (int l = 0; l < streams; ++l) {
    double moment = chi[l] - peak;
    if (spread > 0.) {
      const double part = static_cast<double>(l) / streams;
      const double fallen =
          (1. - cusp) * std::expm1(-3. * part * part) + cusp * ((1. - part) * (1. - l / (streams + 1.)) - 1.);
      moment += (l % 2 == 0 ? spread : -spread) * fallen;
    }
    scatter[l * stride] = share * moment;
  }
  return scale;
}

}  // namespace sunfleck::pp::detail
