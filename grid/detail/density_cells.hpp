#pragma once

#include <openvdb/openvdb.h>

#include <glm/vec3.hpp>

#include "grid/density_grid.hpp"

namespace sunfleck {

// The OpenVDB tree of a density grid and what is asked of it again and again. Cell (i, j, k) of the tree spans
// [corner + i h, corner + (i + 1) h) along x, and so on; OpenVDB's transform maps (i, j, k) to its centre.
struct DensityGrid::Cells {
  openvdb::FloatTree::Ptr tree;  // [1/m]; background 0, every value finite and >= 0
  double cell_size = 0.;         // h [m]
  glm::dvec3 corner{0.};         // lower corner of cell (0, 0, 0) [m]
  std::size_t occupied = 0;      // cells whose density is not 0
  double leaf_area = 0.;         // [m^2]
  Bounds box;                    // of the occupied cells [m]

  // Counts, sums and bounds the cells of `tree`, which must hold finite densities >= 0.
  Cells(openvdb::FloatTree::Ptr densities, double side, const glm::dvec3& low);
};

// openvdb::initialize, once for the process.
void initializeOpenVdb();

}  // namespace sunfleck
