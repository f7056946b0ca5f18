#pragma once

#include <algorithm>

#include "core/require.hpp"
#include "spp/stream_constants.hpp"

namespace sunfleck::spp::detail {

// The medium with mu0 not below kLeastCosine. Throws InvalidInput on a value out of its range.
inline BeamInMedium checkedMedium(const BeamInMedium& medium) {
  require(medium.asymmetry > -1. && medium.asymmetry < 1., "asymmetry", medium.asymmetry, "in (-1, 1)");
  require(medium.albedo >= 0. && medium.albedo <= 1., "albedo", medium.albedo, "in [0, 1]");
  require(medium.mu0 > 0. && medium.mu0 <= 1., "mu0", medium.mu0, "in (0, 1]");
  return {medium.asymmetry, medium.albedo, std::max(medium.mu0, kLeastCosine)};
}

}  // namespace sunfleck::spp::detail
