#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <optional>
#include <utility>

#include "grid/detail/density_cells.hpp"

namespace sunfleck {
namespace {

using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;

// How many cells of a block before the cell are active.
std::size_t activeBefore(const Leaf& leaf, openvdb::Index cell) {
  using Word = std::uint64_t;
  constexpr openvdb::Index bits = 64;
  const auto count = [](Word word) { return static_cast<std::size_t>(std::popcount(word)); };
  std::size_t before = 0;
  for (openvdb::Index i = 0; i < cell / bits; ++i) before += count(leaf.valueMask().getWord<Word>(i));
  return before + count(leaf.valueMask().getWord<Word>(cell / bits) & ((Word{1} << cell % bits) - 1));
}

// Of a cell, what is kept for the active cells of each block; none elsewhere.
template <typename Value>
std::optional<Value> valueOf(const FloatTree& density, const std::vector<std::vector<Value>>& of_blocks,
                             const openvdb::Coord& cell) {
  if (of_blocks.empty()) return {};
  const Leaf* leaf = density.probeConstLeaf(cell);
  const openvdb::Index i = Leaf::coordToOffset(cell);
  if (!leaf || !leaf->isValueOn(i)) return {};
  return of_blocks[leaf->transientData()][activeBefore(*leaf, i)];
}

// `part(value)` of what is kept for the active cells, as a tree of its own.
template <typename Value, typename Part>
FloatTreePtr treeOf(const FloatTree& density, const std::vector<std::vector<Value>>& of_blocks, const Part& part) {
  auto tree = std::make_shared<FloatTree>(density, 0.f, openvdb::TopologyCopy());
  std::vector<Leaf*> blocks;
  tree->getNodes(blocks);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    auto value = of_blocks[blocks[block]->transientData()].begin();
    for (auto cell = blocks[block]->beginValueOn(); cell; ++cell) cell.setValue(part(*value++));
  });
  return tree;
}

}  // namespace

DensityTrees::DensityTrees(std::vector<BlockOfCells> leaves) {
  openvdb::tree::ValueAccessor<FloatTree> nearby(*density);
  moments.reserve(leaves.size());
  for (BlockOfCells& block : leaves) {
    if (block.leaf->isEmpty()) continue;
    block.leaf->setTransientData(static_cast<openvdb::Index32>(moments.size()));
    moments.push_back(std::move(block.moments));
    if (!block.optics.empty()) optics.push_back(std::move(block.optics));
    nearby.addLeaf(block.leaf.release());
  }
}

void DensityTrees::setWood(std::vector<BlockOfCells> blocks) {
  wood = std::make_shared<FloatTree>(0.f);
  openvdb::tree::ValueAccessor<FloatTree> nearby(*wood);
  for (BlockOfCells& block : blocks)
    if (!block.leaf->isEmpty()) nearby.addLeaf(block.leaf.release());
}

LeafOrientation DensityTrees::orientation(const openvdb::Coord& cell) const {
  return valueOf(*density, moments, cell).value_or(LeafOrientation{});
}

std::optional<BandOptics> DensityTrees::opticsOf(const openvdb::Coord& cell) const {
  return valueOf(*density, optics, cell);
}

FloatTreePtr DensityTrees::momentTree(std::size_t i) const {
  return treeOf(*density, moments, [i](const LeafOrientation& moment) { return moment.*kMoments[i]; });
}

FloatTreePtr DensityTrees::opticsTree(std::size_t i) const {
  return treeOf(*density, optics, [i](const BandOptics& of_cell) { return opticsValue(of_cell, i); });
}

}  // namespace sunfleck
