#pragma once

#include <cmath>

namespace sunfleck::pp::detail {

// (P9) Moments as N directions can carry them (delta-M, Wiscombe 1977): the share f of the scattering that goes nearly
// straight on counts as not scattered; of a backward peak too sharp for N moments, the unresolved part is spread, its
// l-th moment falling as e^-3(l/N)^2, so that the kernel stays above 0 where the peak's own moments would make it swing.
// Writes the scaled omega chi_l to scatter[l * stride] and returns the ratio of scaled to true depth, 1 - omega f.
//   chi  moments 0 .. streams of the phase function
inline double scaleMoments(double albedo, const double* chi, int streams, bool delta_m, double* scatter, int stride) {
  const double last = chi[streams], before = chi[streams - 1];
  const bool sharp = delta_m && last > 0.;
  const double peak = sharp && before >= last ? last : 0., spread = sharp && before < 0. ? last : 0.;
  const double scale = 1. - albedo * peak, share = albedo / scale;
  for (int l = 0; l < streams; ++l) {
    double moment = chi[l] - peak;
    if (spread > 0.) {
      const double part = static_cast<double>(l) / streams;
      moment += (l % 2 == 0 ? spread : -spread) * std::expm1(-3. * part * part);
    }
    scatter[l * stride] = share * moment;
  }
  return scale;
}

}  // namespace sunfleck::pp::detail
