#pragma once

#include <array>
#include <optional>
#include <span>
#include <variant>

#include "scattering/medium.hpp"
#include "spp/slab_error_map.hpp"

// (S14) The cheapest closed form that is near enough at a place in a slab, by maps of measured errors.
namespace sunfleck::spp {

// The media that are mapped: Henyey-Greenstein particles ...
struct MappedParticles {
  double asymmetry = 0.;  // g [1]
  double albedo = 0.;     // omega [1]
};
// ... and leaves without a hot spot, inclined as one of kMappedAngles.
struct MappedLeaves {
  std::size_t angles = 0;  // of kMappedAngles
  double reflectance = 0.5, transmittance = 0.5;
};
using MappedMedium = std::variant<MappedParticles, MappedLeaves>;
inline constexpr std::array<std::string_view, 6> kMappedAngles{"spherical",   "planophile",   "erectophile",
                                                               "plagiophile", "extremophile", "uniform"};

Medium mediumOf(const MappedMedium& mapped);
std::optional<MappedMedium> mappedMedium(const Medium& medium);  // nothing for another

// A depth in a homogeneous slab on black ground under a beam.
struct MappedPlace {
  MappedMedium medium;
  double thickness = 1.;  // w: optical, of leaves leaf area index [1]; may be infinite
  double depth = 0.;      // z, of its kind [1], 0 .. w
  double mu0 = 1.;        // |cos| of the beam to the slab's normal [1]
};

// There is a map for each kind of medium. Its axes are the medium's own, 1 - omega first, then w, relative depth and
// mu0; a place has as many coordinates, and 0 beyond.
enum class MapKind { kParticles, kLeaves };
inline constexpr std::size_t kMostMapAxes = 6;
std::vector<MapAxis> mapAxes(MapKind kind);
std::array<double, kMostMapAxes> mapCoordinates(const MappedPlace& place);
MappedPlace placeAt(MapKind kind, std::span<const double> coordinates);

// t = A / (A + B), A = z / (1 + z / 4), B = (w - z) / (1 + (w - z) / 4): near z / w in a thin slab, and in a thick one
// fine at both faces; 1/2 in the middle and deep in a half space. depthAt is the inverse; t < 1/2 if w is infinite.
double relativeDepth(double depth, double thickness);
double depthAt(double relative_depth, double thickness);

// The error that a closed form keeps; infinite where the map promises nothing.
double promisedError(const SlabTier& tier, const MappedPlace& place, SlabQuantity quantity);

// The cheapest closed form that keeps max_error of all `quantities` at a place, or at every one of several; nullptr
// where none is known to. There must be a place and a quantity. The first call for a kind of medium unpacks its map;
// the others allocate nothing and take a tenth of a microsecond a place.
const SlabTier* cheapestTier(const MappedPlace& place, std::span<const SlabQuantity> quantities, double max_error);
const SlabTier* cheapestTier(std::span<const MappedPlace> places, std::span<const SlabQuantity> quantities,
                             double max_error);

}  // namespace sunfleck::spp
