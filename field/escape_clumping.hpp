#pragma once

#include "core/bounds.hpp"
#include "core/progress.hpp"
#include "field/stand_cells.hpp"

namespace sunfleck {

// (F28) Omega of a kind in cells: with which its leaves, all alike bright, lose as much light to the outside as along
// lines. That is the same as to take as much of even light from there. Above 0, 1 at most.
//   alone   clusters of a tree that stands alone at the origin
//   box     about the tree [m]
//   side    of the cells [m]
//   escape  share of the lines from its sides that leave the tree [1], 0 .. 1
// Throws std::runtime_error("interrupted") when `progress`, asked after each iteration, ends it.
float clumpingByEscape(const TurnedClusters& alone, const Bounds& box, float side, double escape,
                       const Progress& progress = {});

}  // namespace sunfleck
