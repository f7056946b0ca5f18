#include "grid/density_grid.hpp"

#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <mutex>
#include <utility>

#include "grid/detail/density_cells.hpp"

namespace sunfleck {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

// Of the occupied part of a block of cells.
struct Summary {
  std::size_t cells = 0;
  double density = 0.;  // summed over the cells [1/m]
  openvdb::CoordBBox box;
};

Summary summary(const Leaf& leaf) {
  Summary found;
  for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
    const float value = leaf.getValue(i);
    if (value == 0.f) continue;
    ++found.cells;
    found.density += static_cast<double>(value);
    found.box.expand(leaf.offsetToGlobalCoord(i));
  }
  return found;
}

}  // namespace

void initializeOpenVdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

DensityGrid::Cells::Cells(openvdb::FloatTree::Ptr densities, double side, const glm::dvec3& low)
    : tree(std::move(densities)), cell_size(side), corner(low) {
  std::vector<const Leaf*> leaves;
  tree->getNodes(leaves);
  std::vector<Summary> summaries(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) { summaries[i] = summary(*leaves[i]); });

  Summary all;
  for (const Summary& part : summaries) {  // in the order of the tree: the same sum for any number of threads
    all.cells += part.cells;
    all.density += part.density;
    all.box.expand(part.box);
  }
  auto tile = std::as_const(*tree).cbeginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    if (*tile == 0.f) continue;
    all.cells += tile.getVoxelCount();
    all.density += static_cast<double>(*tile) * static_cast<double>(tile.getVoxelCount());
    all.box.expand(tile.getBoundingBox());
  }

  occupied = all.cells;
  leaf_area = all.density * cell_size * cell_size * cell_size;
  if (occupied == 0) return;
  const auto at = [&](const openvdb::Coord& cell) {
    return glm::vec3(corner + cell_size * glm::dvec3(cell.x(), cell.y(), cell.z()));
  };
  box.include(at(all.box.min()));
  box.include(at(all.box.max().offsetBy(1)));
}

DensityGrid::DensityGrid(std::shared_ptr<const Cells> cells) : cells_(std::move(cells)) {}

float DensityGrid::at(glm::vec3 position) const {
  const glm::dvec3 cell = glm::floor((glm::dvec3(position) - cells_->corner) / cells_->cell_size);
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(cell[axis]) <= 0x1p30)) return 0.f;
  return cells_->tree->getValue(openvdb::Coord(int(cell.x), int(cell.y), int(cell.z)));
}

float DensityGrid::cellSize() const {
  return static_cast<float>(cells_->cell_size);
}

std::size_t DensityGrid::occupiedCells() const {
  return cells_->occupied;
}

double DensityGrid::leafArea() const {
  return cells_->leaf_area;
}

std::size_t DensityGrid::memoryBytes() const {
  return sizeof(Cells) + cells_->tree->memUsage();
}

Bounds DensityGrid::occupied() const {
  return cells_->box;
}

}  // namespace sunfleck
