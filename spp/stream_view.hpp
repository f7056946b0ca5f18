#pragma once

#include <vector>

#include "spp/stream_constants.hpp"

namespace sunfleck::spp {

// A direction in which light travels, and what of a closed form's modes is scattered into it: the same at all depths of
// slabs of any thickness. Real is float or double.
template <typename Real>
struct StreamView {
  Real cosine = 1;                              // to the downward vertical [1]: above 0 travels down
  Real rate = 1;                                // G(mu) / (depth scale |mu|)
  Real beam_source = 0;                         // omega p(s, s0), of leaves Gamma(s, s0) / G(mu) [1/sr]
  std::vector<Real> seen_sum, seen_difference;  // alpha, beta of every mode of every order, cos(m phi) included
};

// (S10)
//   mu       [-1, 1], not 0
//   azimuth  from that of the beam [rad]
template <typename Real>
StreamView<Real> streamView(const StreamConstants& constants, double mu, double azimuth);

extern template StreamView<float> streamView<float>(const StreamConstants&, double, double);
extern template StreamView<double> streamView<double>(const StreamConstants&, double, double);

}  // namespace sunfleck::spp
