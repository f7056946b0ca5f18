#pragma once

#include <algorithm>

#include "core/require.hpp"
#include "spp/stream_constants.hpp"

namespace sunfleck::spp::detail {

// The beam with mu0 not below kLeastCosine. Throws InvalidInput on a value out of its range.
inline BeamInMedium checkedBeam(BeamInMedium beam) {
  if (const auto* leaves = std::get_if<LeafScattering>(&beam.medium)) {
    require(leaves->reflectance >= 0. && leaves->reflectance <= 1., "reflectance", leaves->reflectance, "in [0, 1]");
    require(leaves->transmittance >= 0. && leaves->transmittance <= 1., "transmittance", leaves->transmittance,
            "in [0, 1]");
    const double albedo = leaves->reflectance + leaves->transmittance;
    require(albedo <= 1., "reflectance + transmittance", albedo, "at most 1");
    require(leaves->hot_spot == 0., "hot_spot", leaves->hot_spot, "0: closed forms have no hot spot");
  } else {
    const double albedo = std::get<Particles>(beam.medium).albedo;
    require(albedo >= 0. && albedo <= 1., "albedo", albedo, "in [0, 1]");
  }
  require(beam.mu0 > 0. && beam.mu0 <= 1., "mu0", beam.mu0, "in (0, 1]");
  beam.mu0 = std::max(beam.mu0, kLeastCosine);
  return beam;
}

}  // namespace sunfleck::spp::detail
