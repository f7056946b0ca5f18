#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "grid/density_grid.hpp"

namespace sunfleck {

using FloatTreePtr = openvdb::FloatTree::Ptr;

// In the order of LeafOrientation.
constexpr std::array<const char*, 5> kNormalNames = {"normal_xx", "normal_yy", "normal_xy", "normal_xz", "normal_yz"};
constexpr const char* kDensityName = "density";
constexpr const char* kWoodName = "wood";

// The trees of a density grid; background 0. Every value is finite, no density negative.
struct DensityTrees {
  FloatTreePtr density;                 // [1/m]
  std::array<FloatTreePtr, 5> normals;  // [1], where there is density; all or none of them
  FloatTreePtr wood;                    // [1/m], or none
};

// The OpenVDB trees of a density grid and what is asked of them again and again. Cell (i, j, k) spans
// [corner + i h, corner + (i + 1) h) along x, and so on; OpenVDB's transform maps (i, j, k) to its centre.
struct DensityGrid::Cells : DensityTrees {
  double cell_size = 0.;     // h [m]
  glm::dvec3 corner{0.};     // lower corner of cell (0, 0, 0) [m]
  std::size_t occupied = 0;  // cells whose density is not 0
  double leaf_area = 0.;     // [m^2]
  std::size_t wood_cells = 0;
  double wood_area = 0.;   // projected, mean of all directions [m^2]
  double crown_area = 0.;  // [m^2]; 0 when the density has tiles, as none of ours has
  Bounds box;              // of the occupied cells [m]

  // Counts, sums and bounds the cells of the trees.
  Cells(DensityTrees trees, double side, const glm::dvec3& low);

  LeafOrientation orientation(const openvdb::Coord& cell) const;

  struct Named {
    std::string name, unit, description;
    FloatTreePtr tree;
    std::size_t cells;
  };
  std::vector<Named> named() const;  // in the order in which they are written
};

// openvdb::initialize, once for the process.
void initializeOpenVdb();

// The grids as OpenVDB keeps them, views of the cells' trees, with all metadata.
openvdb::GridCPtrVec describedGrids(const DensityGrid::Cells& cells, const GridSource& source);

// Writes the grids as NanoVDB keeps them. Throws std::exception when it cannot.
void writeNanoVdb(const openvdb::GridCPtrVec& grids, const std::filesystem::path& file);

}  // namespace sunfleck
