#include "spp/tier_choice.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "spp/detail/embedded_map.hpp"

namespace sunfleck::spp {
namespace {

constexpr double kFaceDepth = 4.;  // how deep the light of a face reaches, by order of magnitude
constexpr double kInfinite = std::numeric_limits<double>::infinity();

double saturated(double depth) {
  return std::isinf(depth) ? kFaceDepth : depth / (1. + depth / kFaceDepth);
}

std::span<const std::uint8_t> cellOf(const MappedPlace& place) {
  const std::array<double, kMostMapAxes> coordinates = mapCoordinates(place);
  if (std::holds_alternative<MappedLeaves>(place.medium)) {
    static const SlabErrorMap kLeafMap(mapAxes(MapKind::kLeaves), detail::embeddedLeafErrors());
    return kLeafMap.at(coordinates);
  }
  // For sharper backward peaks the exact solver, with the streams that the map was measured by, is not near enough
  // itself.
  constexpr double kLeastMappedAsymmetry = -0.7;
  if (std::get<MappedParticles>(place.medium).asymmetry < kLeastMappedAsymmetry) return {};
  static const SlabErrorMap kParticleMap(mapAxes(MapKind::kParticles), detail::embeddedParticleErrors());
  return kParticleMap.at(coordinates);
}

}  // namespace

Medium mediumOf(const MappedMedium& mapped) {
  if (const auto* leaves = std::get_if<MappedLeaves>(&mapped))
    return LeafScattering{.angles = LeafAngles::named(kMappedAngles[leaves->angles]),
                          .reflectance = leaves->reflectance,
                          .transmittance = leaves->transmittance};
  const auto& particles = std::get<MappedParticles>(mapped);
  return Particles{.albedo = particles.albedo, .phase = PhaseFunction::henyeyGreenstein(particles.asymmetry)};
}

std::optional<MappedMedium> mappedMedium(const Medium& medium) {
  if (const auto* particles = std::get_if<Particles>(&medium)) {
    const std::optional<double> asymmetry = particles->phase.henyeyGreensteinAsymmetry();
    if (!asymmetry) return std::nullopt;
    return MappedParticles{*asymmetry, particles->albedo};
  }
  const auto& leaves = std::get<LeafScattering>(medium);
  if (leaves.hot_spot > 0.) return std::nullopt;
  for (std::size_t i = 0; i < kMappedAngles.size(); ++i)
    if (leaves.angles == LeafAngles::named(kMappedAngles[i]))
      return MappedLeaves{i, leaves.reflectance, leaves.transmittance};
  return std::nullopt;
}

std::vector<MapAxis> mapAxes(MapKind kind) {
  if (kind == MapKind::kLeaves)
    return {{"lost", {0., 0.01, 0.03, 0.07, 0.15, 0.3, 0.6, 1.}, {}},
            {"angles", {kMappedAngles.begin(), kMappedAngles.end()}},
            {"reflected", {0., 0.3, 0.5, 0.6, 0.75, 1.}, {}},
            {"thickness", {0., 0.3, 1., 2., 4., 8., 16., kInfinite}, {kInfinite}},
            {"depth", {0., 0.15, 0.5, 0.85, 1.}, {0., 1.}},
            {"mu0", {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.}, {}}};
  return {{"lost", {0., 1e-4, 1e-3, 3e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.}, {}},
          {"g", {-0.9, -0.7, -0.5, -0.3, -0.1, 0., 0.1, 0.3, 0.5, 0.7, 0.8, 0.9}, {0.}},
          {"thickness", {0., 0.1, 0.3, 1., 2., 4., 8., 16., 64., kInfinite}, {kInfinite}},
          {"depth", {0., 0.15, 0.5, 0.85, 1.}, {0., 1.}},
          {"mu0", {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.}, {1.}}};
}

std::array<double, kMostMapAxes> mapCoordinates(const MappedPlace& place) {
  const double depth = relativeDepth(place.depth, place.thickness);
  if (const auto* leaves = std::get_if<MappedLeaves>(&place.medium)) {
    const double albedo = leaves->reflectance + leaves->transmittance;
    // Rounding of the sum must not lead off the map. Black leaves reflect no share of anything: as well the half.
    return {std::max(0., 1. - albedo),
            static_cast<double>(leaves->angles),
            albedo > 0. ? leaves->reflectance / albedo : 0.5,
            place.thickness,
            depth,
            place.mu0};
  }
  const auto& particles = std::get<MappedParticles>(place.medium);
  return {1. - particles.albedo, particles.asymmetry, place.thickness, depth, place.mu0, 0.};
}

MappedPlace placeAt(MapKind kind, std::span<const double> coordinates) {
  const std::size_t axes = coordinates.size();
  const double albedo = 1. - coordinates[0], thickness = coordinates[axes - 3];
  MappedPlace place{
      .thickness = thickness, .depth = depthAt(coordinates[axes - 2], thickness), .mu0 = coordinates[axes - 1]};
  if (kind == MapKind::kLeaves)
    place.medium = MappedLeaves{static_cast<std::size_t>(coordinates[1]), coordinates[2] * albedo,
                                albedo - coordinates[2] * albedo};
  else
    place.medium = MappedParticles{coordinates[1], albedo};
  return place;
}

double relativeDepth(double depth, double thickness) {
  if (depth <= 0.) return 0.;
  if (depth >= thickness) return std::isinf(thickness) ? 2. : 1.;  // the face that is nowhere is on no map
  const double above = saturated(depth), below = saturated(thickness - depth);
  return above / (above + below);
}

double depthAt(double relative_depth, double thickness) {
  double low = 0., high = std::min(thickness, 1e9);
  if (relative_depth <= 0.) return low;
  if (relative_depth >= 1.) return high;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (relativeDepth(middle, thickness) < relative_depth ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double promisedError(const SlabTier& tier, const MappedPlace& place, SlabQuantity quantity) {
  const std::span<const std::uint8_t> cell = cellOf(place);
  return SlabErrorMap::error(cell.empty() ? SlabErrorMap::kNoPromise : cell[SlabErrorMap::column(tier, quantity)]);
}

const SlabTier* cheapestTier(const MappedPlace& place, std::span<const SlabQuantity> quantities, double max_error) {
  return cheapestTier(cellOf(place), quantities, max_error);
}

const SlabTier* cheapestTier(std::span<const MappedPlace> places, std::span<const SlabQuantity> quantities,
                             double max_error) {
  assert(!places.empty() && !quantities.empty());
  std::array<std::uint8_t, 255> largest{};
  for (const MappedPlace& place : places) {
    const std::span<const std::uint8_t> cell = cellOf(place);
    if (cell.empty()) return nullptr;
    std::ranges::transform(cell, largest, largest.begin(), [](auto a, auto b) { return std::max(a, b); });
  }
  return cheapestTier(std::span(largest).first(SlabErrorMap::columns()), quantities, max_error);
}

}  // namespace sunfleck::spp
