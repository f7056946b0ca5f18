#pragma once

#include <span>
#include <vector>

#include "core/tree_mesh.hpp"
#include "field/cell_medium.hpp"

namespace sunfleck {

// How closely clumping is measured: parallel lines along a few axes.
struct ClumpingEffort {
  int axes = 6;
  int resolution = 96;  // lines along the longer side of the tree
};

// (F19) Omega of a tree: how many leaves lines meet in the cells of a medium, by how many they would meet if the leaves
// of a cell stood at random in it. Only the way to the first leaf in each cell counts, so that leaves behind one another
// count as one: the estimate of greatest likelihood for gaps. At most 1: what is above comes of leaves too large for
// the cells, not of order.
//   medium  of this tree alone, which does not repeat
float clumping(const TreeMesh& mesh, const CellMedium& medium, const ClumpingEffort& effort = {});

}  // namespace sunfleck
