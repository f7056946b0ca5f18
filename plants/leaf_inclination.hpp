#pragma once

#include <array>

#include "core/tree_mesh.hpp"

namespace sunfleck {

// How leaves lean.
struct LeafInclination {
  std::array<double, 9> shares{};  // of the leaf area [1], by the angle between its normal and the vertical: 0 to 10,
                                   // 10 to 20 ... 80 to 90 degrees
  double mean_angle = 0.;          // over the area [rad], 0 .. pi/2
};

// Of all leaf triangles, each whole and by its two sides alike: 0 is a level leaf, pi/2 an upright one.
LeafInclination leafInclination(const TreeMesh& mesh);

// Shares of the same classes for leaves whose normals point everywhere alike: cos low - cos high.
std::array<double, 9> sphericalShares();

}  // namespace sunfleck
