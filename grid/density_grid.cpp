#include "grid/density_grid.hpp"

#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "grid/detail/density_cells.hpp"

namespace sunfleck {
namespace {

using openvdb::Coord;
using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;

std::vector<const Leaf*> blocksOf(const FloatTree& tree) {
  std::vector<const Leaf*> blocks;
  tree.getNodes(blocks);
  return blocks;
}

// `part(block)` of each block of cells, computed in parallel, in the order of the tree: what is summed over them is the
// same for any number of threads.
template <typename Part>
auto overBlocks(const FloatTree& tree, const Part& part) {
  const std::vector<const Leaf*> blocks = blocksOf(tree);
  std::vector<decltype(part(*blocks[0]))> parts(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) { parts[i] = part(*blocks[i]); });
  return parts;
}

// `visit(value, cells, box)` of each tile, a value that stands for many cells.
template <typename Visit>
void overTiles(const FloatTree& tree, const Visit& visit) {
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (*tile != 0.f) visit(*tile, static_cast<std::size_t>(tile.getVoxelCount()), tile.getBoundingBox());
}

// Of the occupied part of a block of cells.
struct OccupiedOfBlock {
  Coord origin;
  std::uint64_t columns = 0;  // along z, 8 x 8, those that are occupied: column (x, y) is bit 8 x + y
  std::size_t cells = 0;
  double sum = 0.;  // of the values of the cells
  openvdb::CoordBBox box;
};

OccupiedOfBlock occupiedOf(const Leaf& leaf) {
  constexpr std::size_t kSide = Leaf::DIM;
  OccupiedOfBlock found{.origin = leaf.origin()};
  std::array<std::uint32_t, kSide> counts{};  // of each level of z, as the processor adds them at once
  std::array<double, kSide> sums{};
  const float* value = leaf.buffer().data();
  for (std::size_t column = 0; column < kSide * kSide; ++column, value += kSide) {
    std::uint32_t any = 0;
    for (std::size_t z = 0; z < kSide; ++z) {
      counts[z] += value[z] != 0.f;
      sums[z] += static_cast<double>(value[z]);
      any |= value[z] != 0.f;
    }
    found.columns |= std::uint64_t{any} << column;
  }
  for (std::size_t z = 0; z < kSide; ++z) {
    found.cells += counts[z];
    found.sum += sums[z];
  }
  if (found.cells == 0) return found;
  std::uint8_t along_y = 0;
  for (std::size_t x = 0; x < kSide; ++x) along_y |= static_cast<std::uint8_t>(found.columns >> kSide * x);
  const auto isZero = [](std::uint32_t count) { return count == 0; };
  const Coord low(std::countr_zero(found.columns) / 8, std::countr_zero(along_y),
                  static_cast<int>(std::find_if_not(counts.begin(), counts.end(), isZero) - counts.begin()));
  const Coord high(7 - std::countl_zero(found.columns) / 8, 7 - std::countl_zero(along_y),
                   7 - static_cast<int>(std::find_if_not(counts.rbegin(), counts.rend(), isZero) - counts.rbegin()));
  found.box = {found.origin + low, found.origin + high};
  return found;
}

// Of the occupied part of a tree.
struct Occupied {
  std::vector<OccupiedOfBlock> blocks;
  std::size_t cells = 0;
  double sum = 0.;
  openvdb::CoordBBox box;
  bool tiles = false;
};

Occupied occupiedOf(const FloatTree& tree) {
  Occupied all{.blocks = overBlocks(tree, [](const Leaf& leaf) { return occupiedOf(leaf); })};
  for (const OccupiedOfBlock& block : all.blocks) {
    all.cells += block.cells;
    all.sum += block.sum;
    all.box.expand(block.box);
  }
  overTiles(tree, [&](float value, std::size_t cells, const openvdb::CoordBBox& box) {
    all.tiles = true;
    all.cells += cells;
    all.sum += static_cast<double>(value) * static_cast<double>(cells);
    all.box.expand(box);
  });
  return all;
}

// Of the columns of cells along z that hold leaves, seen from above; of the whole, or of what lies within a rectangle
// [squared side of a cell].
double occupiedColumns(const std::vector<OccupiedOfBlock>& blocks,
                       const std::optional<DensityGrid::Cells::Rectangle>& within) {
  std::map<std::pair<int, int>, std::uint64_t> columns;  // of each 8 x 8, those that do
  for (std::size_t i = 0; i < blocks.size();) {
    const std::pair place(blocks[i].origin.x(), blocks[i].origin.y());
    std::uint64_t mask = 0;  // of the blocks above each other, which follow each other in the tree
    for (; i < blocks.size() && std::pair(blocks[i].origin.x(), blocks[i].origin.y()) == place; ++i)
      mask |= blocks[i].columns;
    columns[place] |= mask;
  }
  double area = 0.;
  for (const auto& [place, mask] : columns) {
    if (!within) {
      area += std::popcount(mask);
      continue;
    }
    const glm::dvec2 corner(place.first, place.second);
    for (int column = 0; column < 64; ++column)
      if (mask >> column & 1) {
        const glm::dvec2 low = corner + glm::dvec2(column / 8, column % 8);
        const glm::dvec2 size = glm::max(glm::min(low + 1., within->high) - glm::max(low, within->low), 0.);
        area += size.x * size.y;
      }
  }
  return area;
}

// Of the cells' optics, over their leaf area.
BandOptics meanOver(const FloatTree& density, const std::vector<std::vector<BandOptics>>& optics) {
  using Sums = std::array<double, kOpticsNames.size() + 1>;  // the last: of the density alone
  Sums all{};
  for (const Sums& part : overBlocks(density, [&](const Leaf& leaf) {
         Sums sums{};
         auto value = optics[leaf.transientData()].begin();
         for (auto cell = leaf.cbeginValueOn(); cell; ++cell) {
           const BandOptics& of_cell = *value++;
           const auto weight = static_cast<double>(*cell);
           for (std::size_t i = 0; i < kOpticsNames.size(); ++i)
             sums[i] += weight * static_cast<double>(opticsValue(of_cell, i));
           sums.back() += weight;
         }
         return sums;
       }))
    for (std::size_t i = 0; i < all.size(); ++i) all[i] += part[i];
  BandOptics mean;
  for (std::size_t i = 0; i < kOpticsNames.size(); ++i) opticsValue(mean, i) = static_cast<float>(all[i] / all.back());
  return mean;
}

std::optional<Coord> cellAt(const DensityGrid::Cells& cells, glm::vec3 position) {
  const glm::dvec3 cell = glm::floor((glm::dvec3(position) - cells.corner) / cells.cell_size);
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(cell[axis]) <= 0x1p30)) return {};
  return Coord(int(cell.x), int(cell.y), int(cell.z));
}

}  // namespace

void initializeOpenVdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

DensityGrid::Cells::Cells(DensityTrees trees, double side, const glm::dvec3& low,
                          const std::optional<Rectangle>& within)
    : DensityTrees(std::move(trees)), cell_size(side), corner(low) {
  const double volume = cell_size * cell_size * cell_size;
  const Occupied leaves = occupiedOf(*density);
  occupied = leaves.cells;
  leaf_area = leaves.sum * volume;
  if (!leaves.tiles) crown_area = occupiedColumns(leaves.blocks, within) * cell_size * cell_size;
  if (!optics.empty() && leaves.sum > 0.) mean_optics = meanOver(*density, optics);
  if (wood) {
    const Occupied blocked = occupiedOf(*wood);
    wood_cells = blocked.cells;
    wood_area = blocked.sum * volume;
  }
  if (occupied == 0) return;
  const auto at = [&](const Coord& cell) {
    return glm::vec3(corner + cell_size * glm::dvec3(cell.x(), cell.y(), cell.z()));
  };
  box.include(at(leaves.box.min()));
  box.include(at(leaves.box.max().offsetBy(1)));
}

std::vector<DensityGrid::Cells::Named> DensityGrid::Cells::named() const {
  const auto bytes = [](const FloatTree& tree) { return static_cast<std::size_t>(tree.memUsage()); };
  const auto kept = [](FloatTreePtr tree) { return [tree] { return tree; }; };
  std::vector<Named> all{{kDensityName, "1/m",
                          "one-sided leaf area density: leaf area in a cell over the volume of the cell", kept(density),
                          occupied, bytes(*density)}};
  if (!moments.empty())
    for (std::size_t i = 0; i < kNormalNames.size(); ++i) {
      const std::string name = kNormalNames[i], axes = name.substr(7);
      all.push_back({name, "1",
                     "second moment M_" + axes + " of leaf normals: mean of n_" + axes[0] + " n_" + axes[1] +
                         " over the leaf area in a cell; M_zz = 1 - M_xx - M_yy",
                     [this, i] { return momentTree(i); }, occupied, occupied * sizeof(float)});
    }
  if (!optics.empty())
    for (std::size_t i = 0; i < kOpticsNames.size(); ++i) {
      const std::string name = kOpticsNames[i], band = name.substr(name.find('_') + 1);
      all.push_back({name, "1",
                     "share of the arriving " + band + " light that leaves " +
                         (name.starts_with("r") ? "reflect" : "transmit") + ": mean over the leaf area in a cell",
                     [this, i] { return opticsTree(i); }, occupied, occupied * sizeof(float)});
    }
  if (wood)
    all.push_back({kWoodName, "1/m",
                   "extinction by wood: its projected area in a cell, mean of all directions, over the "
                   "volume of the cell",
                   kept(wood), wood_cells, bytes(*wood)});
  return all;
}

DensityGrid::DensityGrid(std::shared_ptr<const Cells> cells) : cells_(std::move(cells)) {}

float DensityGrid::at(glm::vec3 position) const {
  const auto cell = cellAt(*cells_, position);
  return cell ? cells_->density->getValue(*cell) : 0.f;
}

LeafOrientation DensityGrid::orientationAt(glm::vec3 position) const {
  const auto cell = cellAt(*cells_, position);
  return cell ? cells_->orientation(*cell) : LeafOrientation{};
}

std::optional<BandOptics> DensityGrid::opticsAt(glm::vec3 position) const {
  const auto cell = cellAt(*cells_, position);
  return cell ? cells_->opticsOf(*cell) : std::nullopt;
}

std::optional<BandOptics> DensityGrid::meanOptics() const {
  return cells_->mean_optics;
}

float DensityGrid::woodAt(glm::vec3 position) const {
  const auto cell = cellAt(*cells_, position);
  return cell && cells_->wood ? cells_->wood->getValue(*cell) : 0.f;
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

double DensityGrid::projectedLeafArea(const Direction& s) const {
  const Cells& cells = *cells_;
  double sum = 0.;
  for (const double part : overBlocks(*cells.density, [&](const Leaf& leaf) {
         const LeafOrientation* moments = cells.moments.empty() ? nullptr : cells.moments[leaf.transientData()].data();
         double projected = 0.;
         for (openvdb::Index i = 0; i < Leaf::SIZE; ++i)
           if (const float density = leaf.getValue(i); density != 0.f)
             projected += static_cast<double>(density) *
                          static_cast<double>((moments ? *moments++ : LeafOrientation{}).projection(s));
         return projected;
       }))
    sum += part;
  overTiles(*cells.density, [&](float density, std::size_t count, const openvdb::CoordBBox&) {
    sum += static_cast<double>(density) * static_cast<double>(count) *
           static_cast<double>(LeafOrientation{}.projection(s));
  });
  return sum * cells.cell_size * cells.cell_size * cells.cell_size;
}

double DensityGrid::projectedWoodArea() const {
  return cells_->wood_area;
}

double DensityGrid::crownArea() const {
  return cells_->crown_area;
}

glm::vec3 DensityGrid::corner() const {
  return glm::vec3(cells_->corner);
}

bool DensityGrid::hasOrientation() const {
  return !cells_->moments.empty();
}

std::size_t DensityGrid::blocks() const {
  std::size_t count = cells_->density->leafCount();
  overTiles(*cells_->density,
            [&](float, std::size_t cells, const openvdb::CoordBBox&) { count += cells / Block::kCells; });
  return count;
}

void DensityGrid::visitBlocks(const std::function<void(const Block&)>& visit) const {
  const Cells& cells = *cells_;
  Block block;
  const auto place = [&](const Coord& first) { block.first = {first.x(), first.y(), first.z()}; };
  for (const Leaf* leaf : blocksOf(*cells.density)) {
    place(leaf->origin());
    std::copy_n(leaf->buffer().data(), Block::kCells, block.density.begin());
    block.orientation.fill({});
    if (!cells.moments.empty()) {
      auto moments = cells.moments[leaf->transientData()].begin();
      for (auto cell = leaf->cbeginValueOn(); cell; ++cell) block.orientation[cell.pos()] = *moments++;
    }
    visit(block);
  }
  block.orientation.fill({});
  overTiles(*cells.density, [&](float density, std::size_t, const openvdb::CoordBBox& box) {
    block.density.fill(density);
    constexpr int kSide = Leaf::DIM;
    for (int x = box.min().x(); x <= box.max().x(); x += kSide)
      for (int y = box.min().y(); y <= box.max().y(); y += kSide)
        for (int z = box.min().z(); z <= box.max().z(); z += kSide) {
          place(Coord(x, y, z));
          visit(block);
        }
  });
}

std::size_t DensityGrid::memoryBytes() const {
  std::size_t bytes = sizeof(Cells);
  for (const Cells::Named& grid : cells_->named()) bytes += grid.bytes;
  return bytes;
}

Bounds DensityGrid::occupied() const {
  return cells_->box;
}

std::vector<DensityGrid::Summary> DensityGrid::grids() const {
  std::vector<Summary> all;
  for (const Cells::Named& grid : cells_->named()) all.push_back({grid.name, grid.unit, grid.cells, grid.bytes});
  return all;
}

}  // namespace sunfleck
