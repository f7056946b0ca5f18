#pragma once

#include <span>
#include <vector>

#include "core/tree_mesh.hpp"
#include "field/cell_medium.hpp"

namespace sunfleck {

// How clumping is measured: along parallel lines.
struct ClumpingEffort {
  int axes = 6;
  int resolution = 96;  // lines along the longer side of the tree
  float depth = 6.f;    // of the stretches that lines are cut into: leaves met on them, in the mean [1]
};

// (F19) Omega of a tree: by what factor its leaves must seem fewer than they are for a medium in cells to let through
// as much light as the tree does. Lines are cut into stretches of a few leaves' depth and it is counted how many of
// them meet a leaf at all; were leaves at random in each cell, all stretches of depth tau together would be met sum (1
// - e^(-Omega tau)) times. Stretches longer than a cell see what is lost between cells as well: leaves stand beside
// leaves, and the cells at the crown's rim are half empty. At most 1.
//   medium  of this tree alone, which does not repeat
float clumping(const TreeMesh& mesh, const CellMedium& medium, const ClumpingEffort& effort = {});

}  // namespace sunfleck
