#pragma once

#include <array>
#include <span>
#include <vector>

#include "spp/tier_choice.hpp"

namespace sunfleck {

// The exact solution's streams, and the directions over which the RMS of radiance is taken.
struct TierErrorSettings {
  int streams = 32;
  int cosines = 8;   // of Gauss's rule in each half; 0: the error of radiance is not measured, but told as 0
  int azimuths = 8;  // midpoints of the half circle
};

// (S14) How far each tier is off at some depths of a slab, by the measures of spp::SlabQuantity, against the exact
// solver: one entry for each tier of spp::slabTiers() and each depth, the tiers of a depth side by side. The slab's own
// depth is not asked for.
using TierErrors = std::array<double, spp::kSlabQuantities>;
std::vector<TierErrors> slabTierErrors(const spp::MappedPlace& slab, std::span<const double> depths,
                                       const TierErrorSettings& settings = {});

}  // namespace sunfleck
