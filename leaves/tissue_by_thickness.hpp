#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "core/leaf_optics.hpp"
#include "leaves/leaf_sides.hpp"

namespace sunfleck {

// What tissue does to light that falls upright on it, in each band.
struct TissueBands {
  std::array<double, kBands> reflectance{};    // R [1], 0 .. 1
  std::array<double, kBands> transmittance{};  // T [1], 0 .. 1; R + T <= 1
};

// (L10) Reflectance and transmittance (L8) of one tissue as functions of its thickness, for many places of a leaf: from
// a table of exact solutions, between which cubics run. Off by 2e-6 at most, mostly by less than 1e-7.
class TissueByThickness {
 public:
  //   absorption, scattering  per band [1/mm], 0 .. 1e6
  //   thinnest, thickest      between which it will be asked [mm], 0 .. 2000
  // Throws InvalidInput on numbers out of these ranges. Some 1 ms for leaves; 30 ms for all ranges at once.
  TissueByThickness(const glm::dvec3& absorption, const glm::dvec3& scattering, double thinnest, double thickest);

  // Of that thickness [mm], which is moved into what was told above.
  TissueBands at(double thickness) const;

 private:
  static constexpr std::size_t kValues = 2 * kBands;
  double scale_ = 1.;              // [1/mm]
  double first_ = 0., last_ = 0.;  // log(1 + scale thickness) where the table begins, and of the thickest
  std::vector<std::array<double, kValues>> rows_;
};

}  // namespace sunfleck
