#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spp/map_axis.hpp"
#include "spp/slab_tiers.hpp"

namespace sunfleck::spp {

// What is wanted of a slab at a depth, and what the error of a closed form is then.
enum class SlabQuantity {
  kFlux,            // the larger error of the fluxes up and down through the horizontal, over the flux that arrives
  kLeafIrradiance,  // error of SlabLight::leaf_irradiance over its own, or over kDimIrradiance where that is less
  kRadiance,        // RMS over all directions of the error of the diffuse radiance [1/sr], for a beam of irradiance 1
};
inline constexpr std::size_t kSlabQuantities = 3;
inline constexpr double kDimIrradiance = 1e-3;  // of 1 that falls on a plane facing the beam

// (S14) How far each closed form may be off: for each tier and quantity and each cell of some axes a byte.
class SlabErrorMap {
 public:
  // A byte b promises an error of at most kLeastError 10^(b / kStepsPerDecade), kNoPromise none.
  static constexpr double kLeastError = 1e-4;
  static constexpr int kStepsPerDecade = 8;
  static constexpr std::uint8_t kNoPromise = 255;
  static std::uint8_t code(double error);  // rounded up
  static double error(std::uint8_t code);  // infinite for kNoPromise

  // A cell's bytes: those of powers for each tier that has powers of its own, then radiance for each.
  static std::size_t columns();
  static std::size_t column(const SlabTier& tier, SlabQuantity quantity);

  // codes: cell after cell, those of the last axis side by side
  SlabErrorMap(std::vector<MapAxis> axes, std::vector<std::uint8_t> codes);
  // What file() wrote. Throws std::runtime_error for another, or one made for other axes or tiers.
  SlabErrorMap(std::vector<MapAxis> axes, std::string_view file);
  std::string file() const;

  const std::vector<MapAxis>& axes() const { return axes_; }
  // The bytes of the cell that holds a point, one coordinate for each axis; empty outside of the map.
  std::span<const std::uint8_t> at(std::span<const double> coordinates) const;

 private:
  std::string header() const;

  std::vector<MapAxis> axes_;
  std::vector<std::uint8_t> codes_;
};

// The cheapest tier whose promised errors of all `quantities` are at most max_error, by the bytes of a cell; nullptr:
// none is. Costs are those of radiance if it is among the quantities, else of powers.
const SlabTier* cheapestTier(std::span<const std::uint8_t> cell, std::span<const SlabQuantity> quantities,
                             double max_error);

}  // namespace sunfleck::spp
