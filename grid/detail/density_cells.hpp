#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/density_grid.hpp"

namespace sunfleck {

using FloatTreePtr = openvdb::FloatTree::Ptr;

// In the order of LeafOrientation.
constexpr std::array<const char*, 5> kNormalNames = {"normal_xx", "normal_yy", "normal_xy", "normal_xz", "normal_yz"};
constexpr std::array<float LeafOrientation::*, 5> kMoments = {
    &LeafOrientation::xx, &LeafOrientation::yy, &LeafOrientation::xy, &LeafOrientation::xz, &LeafOrientation::yz};
// One band after the other.
constexpr std::array<const char*, 2 * kBands> kOpticsNames = {"reflectance_red",     "reflectance_green",
                                                              "reflectance_blue",    "transmittance_red",
                                                              "transmittance_green", "transmittance_blue"};
constexpr std::array<float LeafOptics::*, 2> kShares = {&LeafOptics::reflectance, &LeafOptics::transmittance};
inline float& opticsValue(BandOptics& optics, std::size_t i) {
  return optics[i % kBands].*kShares[i / kBands];
}
inline float opticsValue(const BandOptics& optics, std::size_t i) {
  return optics[i % kBands].*kShares[i / kBands];
}
constexpr const char* kDensityName = "density";
constexpr const char* kWoodName = "wood";

// Values of a block of cells, of which those that are not 0 are active.
struct BlockOfCells {
  std::unique_ptr<openvdb::FloatTree::LeafNodeType> leaf;
  std::vector<LeafOrientation> moments;  // of the active cells of `leaf`, in its order; or none
  std::vector<BandOptics> optics;        // likewise
};
// [byte], without moments: values and mask of 512 cells, and what the allocator adds.
constexpr double kBytesOfBlock = 512. * sizeof(float) + 192.;

// The values of a density grid; background 0. Every value is finite, no density negative. Moments and optics, which are
// but read where there are leaves, are kept for these cells alone: OpenVDB's blocks keep room for all 512, of which
// leaves fill some tenth.
struct DensityTrees {
  FloatTreePtr density = std::make_shared<openvdb::FloatTree>(0.f);  // [1/m]
  // Of each block of `density`, by its transient data: of its active cells, in order. With moments, active cells are
  // those of density, and there are no tiles. Empty when they are not known.
  std::vector<std::vector<LeafOrientation>> moments;
  std::vector<std::vector<BandOptics>> optics;  // likewise
  FloatTreePtr wood;                            // [1/m], or none

  DensityTrees() = default;
  explicit DensityTrees(std::vector<BlockOfCells> leaves);
  void setWood(std::vector<BlockOfCells> blocks);

  LeafOrientation orientation(const openvdb::Coord& cell) const;         // all directions alike where it is not known
  std::optional<BandOptics> opticsOf(const openvdb::Coord& cell) const;  // none where it is not known
  FloatTreePtr momentTree(std::size_t i) const;  // the moment kNormalNames[i] as a tree of its own
  FloatTreePtr opticsTree(std::size_t i) const;  // and kOpticsNames[i]
};

// The OpenVDB trees of a density grid and what is asked of them again and again. Cell (i, j, k) spans
// [corner + i h, corner + (i + 1) h) along x, and so on; OpenVDB's transform maps (i, j, k) to its centre.
struct DensityGrid::Cells : DensityTrees {
  double cell_size = 0.;     // h [m]
  glm::dvec3 corner{0.};     // lower corner of cell (0, 0, 0) [m]
  std::size_t occupied = 0;  // cells whose density is not 0
  double leaf_area = 0.;     // [m^2]
  std::size_t wood_cells = 0;
  double wood_area = 0.;                    // projected, mean of all directions [m^2]
  double crown_area = 0.;                   // [m^2]; 0 when the density has tiles, as none of ours has
  std::optional<BandOptics> mean_optics{};  // over the leaf area; none where it is not known
  Bounds box;                               // of the occupied cells [m]
  std::optional<glm::dvec2> period{};       // of a periodic stand along x and y [m]

  // Along x and y, from the corner of cell (0, 0, 0) [cell].
  struct Rectangle {
    glm::dvec2 low, high;
  };

  // Counts, sums and bounds the cells of the trees. `within`: the one period of a periodic stand, which its last cells
  // may pass.
  Cells(DensityTrees trees, double side, const glm::dvec3& low, const std::optional<Rectangle>& within = {});

  struct Named {
    std::string name, unit, description;
    std::function<FloatTreePtr()> tree;
    std::size_t cells, bytes;  // occupied; in memory
  };
  std::vector<Named> named() const;  // in the order in which they are written: density, moments, optics, wood
};

// openvdb::initialize, once for the process.
void initializeOpenVdb();

// The grids as OpenVDB keeps them, views of the cells' trees, with all metadata.
openvdb::GridCPtrVec describedGrids(const DensityGrid::Cells& cells, const GridSource& source);

// Writes the grids as NanoVDB keeps them. Throws std::exception when it cannot.
void writeNanoVdb(const openvdb::GridCPtrVec& grids, const std::filesystem::path& file);

}  // namespace sunfleck
