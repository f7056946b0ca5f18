#pragma once

#include <vector>

#include "core/progress.hpp"
#include "render/compare/slab_tier_errors.hpp"
#include "spp/tier_choice.hpp"

namespace sunfleck {

// The promise is this times the largest error measured in a cell, rounded up to the map's next step. Radiance is
// measured at fewer places.
inline constexpr double kPowerMargin = 1.5, kRadianceMargin = 2.;

// (S14) Measures a map: in every cell, the errors at all its corners and in its middle, and those of powers also at
// random places and more depths. On all threads. In leaves no error of radiance is measured nor promised: each of
// their views takes tens of microseconds.
spp::SlabErrorMap measuredErrors(spp::MapKind kind, const Progress& progress = {});

// Random places on a map, spread evenly over its cells, and the errors there, by a finer exact solution.
struct CheckedPlace {
  spp::MappedPlace place;
  std::vector<TierErrors> errors;  // of each tier
};
std::vector<CheckedPlace> checkedPlaces(spp::MapKind kind, int count, unsigned seed, const Progress& progress = {});

}  // namespace sunfleck
