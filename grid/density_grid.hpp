#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bounds.hpp"
#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "core/progress.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "grid/leaf_orientation.hpp"

namespace sunfleck {

// What a written grid tells about where it comes from.
struct GridSource {
  std::string name;     // what the leaves came from, such as a file
  std::string hash;     // of their mesh; empty when it is not known
  std::string program;  // that wrote the grid, with version and commit
};

// The leaves and the wood of a tree on sparse grids of the same cubic cells: (D1) one-sided leaf area density u_L [1/m]
// = [m^2 of leaf per m^3 of space], the leaf area inside a cell over its volume; (D7) the second moments of the leaves'
// normals; (D11) the leaves' optics, where asked for; (D9) wood as an extinction [1/m]. Copies share their cells.
class DensityGrid {
 public:
  // Shares each leaf's and each wood triangle's area exactly among the cells it crosses, by clipping its triangles
  // (D2). Cells lie at whole multiples of their side from the origin. The same grids to the bit for any number of
  // threads.
  //   cell_size  [m], 2e-5 .. 1e6
  // Throws InvalidInput when the tree would span more than 2^20 cells along an axis, reach beyond 2^30 cells from the
  // origin, or need more than 2^30 shares, 8 GiB or the memory there is; std::runtime_error("interrupted") when
  // `progress` says to stop.
  static DensityGrid voxelize(const TreeMesh& mesh, float cell_size, const Progress& progress = {});

  // The same of all trees of a stand: each prototype is voxelized once, and once more for each further rotation, and
  // its cells are placed by displacement (D2). A tree that is moved by whole cells keeps its values; otherwise each
  // cell is shared among those that it overlaps. With a period, one period, about the middle of the trees' places: what
  // stands beyond its sides enters at the opposite ones. The area is that of all trees. Independent of the number of
  // threads, and of the order of the trees but for rounding. Throws as voxelize does, of the stand.
  //   kinds   prototypes of the kinds of trees
  //   optics  of the leaves of each kind: the grid then holds those of each cell (D11). None: it does not
  // Also throws InvalidInput when the period is less than a cell, or so small that the stand needs more than 2^24
  // copies of its trees.
  static DensityGrid voxelizeStand(std::span<const TreeMesh* const> kinds, const Stand& stand, float cell_size,
                                   std::span<const BandOptics> optics = {}, const Progress& progress = {});
  static DensityGrid voxelizeStand(const TreeMesh& mesh, const Stand& stand, float cell_size);  // trees of one kind

  // Turbid leaves of one density, with all orientations alike, in an ellipsoid: a crown whose answer theory knows.
  // Cells on its surface hold their share of it, by 64 samples each.
  //   size       full axes [m], > 0; at most 512 cells
  //   density    leaf area density within [1/m], > 0 .. 1e6
  //   cell_size  [m], > 0
  // Throws InvalidInput on what is out of its range.
  static DensityGrid turbidEllipsoid(const glm::vec3& size, const glm::vec3& centre, float density, float cell_size);

  // Reads the grid named "density" of a .vdb file and, where the file has them, the second moments "normal_xx" and so
  // on, the optics "reflectance_red" and so on, and "wood". Throws InvalidInput on a file that is missing, empty, cut
  // short or corrupt, holds no density or one of these that is not of floats, lies in other cells or has values that
  // cannot be. OpenVDB sees only what has been checked, and the file is refused before when its grids would take more
  // than 8 GiB or the memory there is: a hostile file costs time in proportion to its length, and memory some 35 times
  // that at most.
  static DensityGrid read(const std::filesystem::path& file);

  // Writes all grids into one file, whole or not at all: a .vdb file that other OpenVDB programs open, fog volumes,
  // "density" first, with units, leaf area and source in the metadata; or, where the name ends so, a .nvdb file for
  // NanoVDB, which has no place for metadata. Equal grids and sources make equal files. Throws InvalidInput when it
  // cannot be written.
  void write(const std::filesystem::path& file, const GridSource& source) const;

  // The same into a .vdb file that is there already, such as one that lies in memory, without a source. Throws
  // std::exception when it cannot be written, and leaves it as it is then.
  void writeOver(const std::filesystem::path& file) const;

  float at(glm::vec3 position) const;  // density of the cell that holds the position [1/m]; 0 outside
  LeafOrientation orientationAt(glm::vec3 position) const;  // of that cell's leaves; all directions alike outside
  // (D11) Means over that cell's leaf area, and over that of all cells; none where they are not known.
  std::optional<BandOptics> opticsAt(glm::vec3 position) const;
  std::optional<BandOptics> meanOptics() const;
  float woodAt(glm::vec3 position) const;              // wood's extinction in that cell [1/m]; 0 outside
  float cellSize() const;                              // [m]
  std::size_t occupiedCells() const;                   // with leaves
  double leafArea() const;                             // integral of the density over space [m^2]
  double projectedLeafArea(const Direction& s) const;  // integral of density times projection (D8) along s [m^2]
  double projectedWoodArea() const;                    // integral of wood's extinction: mean of all directions [m^2]
  double crownArea() const;                            // of the columns that hold leaves, seen from above [m^2]
  std::size_t memoryBytes() const;
  Bounds occupied() const;  // box of the cells with leaves [m]

  struct Summary {
    std::string name, unit;
    std::size_t cells, bytes;  // occupied; in memory
  };
  std::vector<Summary> grids() const;  // in the order in which they are written

  // Cells as they are kept, in blocks of 8 x 8 x 8: cell (x, y, z) of a block is number 64 x + 8 y + z.
  struct Block {
    static constexpr std::size_t kCells = 512;
    glm::ivec3 first{0};                                // cell (0, 0, 0) of the block, in whole cells from corner()
    std::array<float, kCells> density{};                // [1/m]
    std::array<LeafOrientation, kCells> orientation{};  // all directions alike where it is not known
  };
  glm::vec3 corner() const;  // lower corner of cell (0, 0, 0) [m]
  bool hasOrientation() const;
  std::size_t blocks() const;  // that hold leaves
  void visitBlocks(const std::function<void(const Block&)>& visit) const;

  struct Cells;  // the OpenVDB grids; complete in grid/detail alone
 private:
  explicit DensityGrid(std::shared_ptr<const Cells> cells);
  std::shared_ptr<const Cells> cells_;
};

// Tells meshes apart: a hash of their vertices and triangles as text, a UUID of version 5.
std::string meshHash(const TreeMesh& mesh);
// Tells stands apart: by the meshes of the kinds, the places of the trees, the period and, where given, the optics.
std::string standHash(std::span<const TreeMesh* const> kinds, const Stand& stand,
                      std::span<const BandOptics> optics = {});

}  // namespace sunfleck
