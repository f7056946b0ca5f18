#include "spp/tier_choice.hpp"

#include <algorithm>
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

const SlabErrorMap& map() {
  static const SlabErrorMap kMap(particleAxes(), detail::embeddedParticleErrors());
  return kMap;
}

}  // namespace

std::vector<MapAxis> particleAxes() {
  return {{"lost", {0., 1e-4, 1e-3, 3e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.}, {}},
          {"g", {-0.9, -0.7, -0.5, -0.3, -0.1, 0., 0.1, 0.3, 0.5, 0.7, 0.8, 0.9}, {0.}},
          {"thickness", {0., 0.1, 0.3, 1., 2., 4., 8., 16., 64., kInfinite}, {kInfinite}},
          {"depth", {0., 0.15, 0.5, 0.85, 1.}, {0., 1.}},
          {"mu0", {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.}, {1.}}};
}

std::array<double, 5> particleCoordinates(const SlabPlace& place) {
  return {1. - place.albedo, place.asymmetry, place.thickness, relativeDepth(place.depth, place.thickness), place.mu0};
}

double relativeDepth(double depth, double thickness) {
  if (depth <= 0.) return 0.;
  if (depth >= thickness) return 1.;
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

double promisedError(const SlabTier& tier, const SlabPlace& place, SlabQuantity quantity) {
  const std::span<const std::uint8_t> cell = map().at(particleCoordinates(place));
  return SlabErrorMap::error(cell.empty() ? SlabErrorMap::kNoPromise : cell[SlabErrorMap::column(tier, quantity)]);
}

const SlabTier* cheapestTier(const SlabPlace& place, std::span<const SlabQuantity> quantities, double max_error) {
  return cheapestTier(map().at(particleCoordinates(place)), quantities, max_error);
}

const SlabTier* cheapestTier(std::span<const SlabPlace> places, std::span<const SlabQuantity> quantities,
                             double max_error) {
  std::array<std::uint8_t, 255> largest{};
  for (const SlabPlace& place : places) {
    const std::span<const std::uint8_t> cell = map().at(particleCoordinates(place));
    if (cell.empty()) return nullptr;
    std::ranges::transform(cell, largest, largest.begin(), [](auto a, auto b) { return std::max(a, b); });
  }
  return cheapestTier(std::span(largest).first(SlabErrorMap::columns()), quantities, max_error);
}

}  // namespace sunfleck::spp
