#pragma once

#include <array>
#include <string>
#include <vector>

#include "pp_solver/detail/first_scattering.hpp"
#include "pp_solver/slab_table.hpp"

namespace sunfleck::pp::detail {

// What a SlabTable holds and its file stores.
struct SlabTableData {
  static constexpr int kMostModes = 32, kFewestNodes = 5, kMostNodes = 512;

  std::string about;
  int streams = 0;
  double max_thickness = 0.;
  std::array<int, 4> nodes{};  // thickness, depth, mu0, |mu|
  int modes = 0;
  SlabTableErrors errors;
  FirstScattering first;
  // Spline coefficients, nodes + 2 along each axis.
  std::vector<float> source;  // [half][thickness][depth][mu0][mu][mode] [1/sr]
  std::vector<float> power;   // [thickness][depth][mu0][down, up] [1]

  std::size_t sourceSize() const { return powerSize() * padded(3) * static_cast<std::size_t>(modes); }
  std::size_t powerSize() const { return 2 * padded(0) * padded(1) * padded(2); }
  std::size_t padded(int axis) const { return static_cast<std::size_t>(nodes[axis]) + 2; }
};

// The least |cos| [1] that a direction is taken to have, and the least share of the thickness above or below a place at
// which the multiply scattered light is asked for: it stands for the limit.
inline constexpr double kLeastCosine = 1e-5, kLeastShare = 1e-6;

}  // namespace sunfleck::pp::detail
