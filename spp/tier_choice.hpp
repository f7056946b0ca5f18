#pragma once

#include <array>
#include <span>

#include "spp/slab_error_map.hpp"

// (S14) The cheapest closed form that is near enough at a place in a slab, by the map of measured errors.
namespace sunfleck::spp {

// A depth in a homogeneous slab of Henyey-Greenstein particles on black ground under a beam.
struct SlabPlace {
  double asymmetry = 0.;  // g [1]
  double albedo = 0.;     // omega [1]
  double thickness = 1.;  // w [1], may be infinite
  double depth = 0.;      // z [1], 0 .. w
  double mu0 = 1.;        // |cos| of the beam to the slab's normal [1]
};

// The map's axes, and a place on them: 1 - omega, g, w, relative depth, mu0.
std::vector<MapAxis> particleAxes();
std::array<double, 5> particleCoordinates(const SlabPlace& place);

// t = A / (A + B), A = z / (1 + z / 4), B = (w - z) / (1 + (w - z) / 4): near z / w in a thin slab, and in a thick one
// fine at both faces; 1/2 in the middle and deep in a half space. depthAt is the inverse; t < 1/2 if w is infinite.
double relativeDepth(double depth, double thickness);
double depthAt(double relative_depth, double thickness);

// The error that a closed form keeps; infinite where the map promises nothing.
double promisedError(const SlabTier& tier, const SlabPlace& place, SlabQuantity quantity);

// The cheapest closed form that keeps max_error of all `quantities` at a place, or at every one of several; nullptr
// where none is known to. The first call unpacks the map; the others allocate nothing and take a tenth of a
// microsecond a place.
const SlabTier* cheapestTier(const SlabPlace& place, std::span<const SlabQuantity> quantities, double max_error);
const SlabTier* cheapestTier(std::span<const SlabPlace> places, std::span<const SlabQuantity> quantities,
                             double max_error);

}  // namespace sunfleck::spp
