#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <string>

#include "core/bounds.hpp"
#include "core/progress.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// (D1) One-sided leaf area density u_L [1/m] = [m^2 of leaf per m^3 of space] on a sparse grid of cubic cells: the
// value of a cell is the leaf area inside it over its volume. Copies share their cells.
class DensityGrid {
 public:
  // Shares each leaf's area exactly among the cells it crosses, by clipping its triangles (D2). Cells lie at whole
  // multiples of their side from the origin. The same grid to the bit for any number of threads.
  //   cell_size  [m], 1e-6 .. 1e6
  // Throws InvalidInput when the tree would span more than 2^20 cells along an axis, reach beyond 2^30 cells from the
  // origin, or need more than 2^30 shares or 8 GiB; std::runtime_error("interrupted") when `progress` says to stop.
  static DensityGrid voxelize(const TreeMesh& mesh, float cell_size, const Progress& progress = {});

  // Reads the grid named "density" of a .vdb file. Throws InvalidInput on a file that is missing, empty, cut short or
  // corrupt, holds no such grid of floats, or holds a density that is negative or not finite. OpenVDB sees only what
  // has been checked against the file's length: a hostile file costs memory in proportion to its length, which is 8 GiB
  // at most.
  static DensityGrid read(const std::filesystem::path& file);

  // Writes a .vdb file other OpenVDB programs open, whole or not at all: a fog volume "density" with its units, leaf
  // area and source in the metadata. Equal grids and sources make equal files. Throws InvalidInput when it cannot be
  // written.
  //   source  what the leaves came from
  void write(const std::filesystem::path& file, const std::string& source) const;

  float at(glm::vec3 position) const;  // density of the cell that holds the position [1/m]; 0 outside
  float cellSize() const;              // [m]
  std::size_t occupiedCells() const;
  double leafArea() const;  // integral of the density over space [m^2]
  std::size_t memoryBytes() const;
  Bounds occupied() const;  // box of the occupied cells [m]

  struct Cells;  // the OpenVDB grid; complete in density_grid.cpp alone
 private:
  explicit DensityGrid(std::shared_ptr<const Cells> cells);
  std::shared_ptr<const Cells> cells_;
};

}  // namespace sunfleck
