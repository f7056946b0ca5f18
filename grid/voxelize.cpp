#include <openvdb/openvdb.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/triangle_clipping.hpp"

namespace sunfleck {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;  // a block of 8 x 8 x 8 cells

constexpr double kMostCells = 0x1p20;          // of the tree along an axis
constexpr double kFarthestCell = 0x1p30;       // from the origin along an axis
constexpr double kMostCrossings = 0x1p30;      // of triangles and cells: minutes of work
constexpr std::size_t kMostBlocks = 1u << 22;  // of 2 KiB: 8 GiB
constexpr int kBlock = Leaf::DIM;
constexpr int kBatches = 16;  // progress is told after each

// A triangle has a part in a block of cells.
struct Visit {
  std::uint64_t block;  // x, y and z of the block from the tree's lowest, 21 bits each
  std::uint32_t triangle;

  auto operator<=>(const Visit&) const = default;
};

std::uint64_t blockKey(const glm::ivec3& block) {
  return (static_cast<std::uint64_t>(block.x) << 42) | (static_cast<std::uint64_t>(block.y) << 21) |
         static_cast<std::uint64_t>(block.z);
}

glm::ivec3 blockOf(std::uint64_t key) {
  constexpr std::uint64_t mask = (1u << 21) - 1;
  return {static_cast<int>(key >> 42), static_cast<int>((key >> 21) & mask), static_cast<int>(key & mask)};
}

// Where a mesh lies in the grid: its triangles in units of a cell, from a corner of a block, so that far from the
// origin no digits are lost.
class MeshInCells {
 public:
  MeshInCells(const TreeMesh& mesh, double cell_size) : mesh_(mesh), cell_size_(cell_size) {
    const Bounds box = leafBounds(mesh);
    first_block_ = glm::ivec3(glm::floor(glm::dvec3(box.low) / (cell_size * kBlock)));
    corner_ = glm::dvec3(first_block_) * (cell_size * kBlock);
  }

  ConvexPolygon triangle(std::uint32_t i) const {
    const glm::uvec3& t = mesh_.leaf_triangles[i];
    return sunfleck::triangle(inCells(t.x), inCells(t.y), inCells(t.z));
  }
  glm::ivec3 firstBlock() const { return first_block_; }
  std::size_t triangles() const { return mesh_.leaf_triangles.size(); }

 private:
  // Rounding must not put the lowest vertex below the corner.
  glm::dvec3 inCells(std::uint32_t vertex) const {
    return glm::max((glm::dvec3(mesh_.vertices[vertex]) - corner_) / cell_size_, 0.);
  }

  const TreeMesh& mesh_;
  double cell_size_;
  glm::ivec3 first_block_;
  glm::dvec3 corner_;  // [m]
};

glm::dvec3 normal(const ConvexPolygon& triangle) {
  return glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
}

void validate(const TreeMesh& mesh, double cell_size) {
  const auto check = [&](bool ok, const char* rule) { require(ok, "cell size [m]", cell_size, rule); };
  check(cell_size >= 1e-6 && cell_size <= 1e6, "from 1e-6 to 1e6");
  const Bounds box = leafBounds(mesh);
  if (box.empty()) throw InvalidInput("the tree has no leaves: at least one is needed for a density");
  double crossings = 0.;
  for (int axis = 0; axis < 3; ++axis) {
    check(static_cast<double>(box.high[axis]) - static_cast<double>(box.low[axis]) <= kMostCells * cell_size,
          "so large that the tree spans at most 2^20 cells along an axis");
    check(std::max(std::abs(static_cast<double>(box.low[axis])), std::abs(static_cast<double>(box.high[axis]))) <=
              kFarthestCell * cell_size,
          "so large that the tree lies within 2^30 cells of the origin");
  }
  // A triangle crosses at most as many cells as its three projections cover and its sides pass.
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    const glm::dvec3 projected = glm::abs(glm::cross(b - a, c - a)) * 0.5;
    const glm::dvec3 sides = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
    crossings += (projected.x + projected.y + projected.z) / (cell_size * cell_size) +
                 2. * (sides.x + sides.y + sides.z) / cell_size + 1.;
  }
  check(crossings <= kMostCrossings, "so large that the leaves cross at most 2^30 cells");
}

void report(const Progress& progress, double done) {
  if (!goOn(progress, done)) throw std::runtime_error("interrupted");
}

// Runs `work(i)` for all i < count in parallel and tells progress from `begin` to `end` between batches.
template <typename Work>
void inBatches(std::size_t count, const Progress& progress, double begin, double end, const Work& work) {
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    report(progress, begin + (end - begin) * static_cast<double>(batch) / kBatches);
    tbb::parallel_for(count * batch / kBatches, count * (batch + 1) / kBatches, work);
  }
}

// All pairs of a block and a triangle with a part in it, sorted by block and then by triangle: an order that threads
// cannot change.
std::vector<Visit> visits(const MeshInCells& mesh, const Progress& progress) {
  constexpr std::size_t kRun = 1024;  // triangles
  struct Local {
    std::vector<Visit> visits;
    std::vector<CellShare> shares;
  };
  tbb::enumerable_thread_specific<Local> locals;
  inBatches((mesh.triangles() + kRun - 1) / kRun, progress, 0., 0.4, [&](std::size_t run) {
    Local& local = locals.local();
    for (std::size_t i = run * kRun; i < std::min(mesh.triangles(), (run + 1) * kRun); ++i) {
      ConvexPolygon polygon = mesh.triangle(static_cast<std::uint32_t>(i));
      for (int corner = 0; corner < 3; ++corner) polygon.corners[static_cast<std::size_t>(corner)] /= double{kBlock};
      local.shares.clear();
      shareAmongCells(polygon, normal(polygon), local.shares);
      for (const CellShare& share : local.shares)
        local.visits.push_back({blockKey(share.cell), static_cast<std::uint32_t>(i)});
    }
  });

  std::vector<Visit> all;
  std::size_t count = 0;
  for (const Local& local : locals) count += local.visits.size();
  all.reserve(count);
  for (Local& local : locals) {
    all.insert(all.end(), local.visits.begin(), local.visits.end());
    local.visits = {};
  }
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

// (D1) The densities of one block of cells: of the parts of its triangles, summed in their order.
std::unique_ptr<Leaf> blockDensities(const MeshInCells& mesh, const Visit* begin, const Visit* end, double cell_size,
                                     std::vector<CellShare>& shares) {
  const glm::ivec3 block = blockOf(begin->block);
  const glm::ivec3 first = block * kBlock;
  std::array<double, Leaf::SIZE> area{};  // [squared side of a cell]
  for (const Visit* visit = begin; visit != end; ++visit) {
    const ConvexPolygon whole = mesh.triangle(visit->triangle);
    shares.clear();
    shareAmongCells(clip(whole, glm::dvec3(first), glm::dvec3(first + kBlock)), normal(whole), shares);
    for (const CellShare& share : shares) {
      // Rounding may leave a corner one digit outside the block.
      const glm::ivec3 cell = glm::clamp(share.cell - first, 0, kBlock - 1);
      area[static_cast<std::size_t>((cell.x * kBlock + cell.y) * kBlock + cell.z)] += share.area;
    }
  }

  const glm::ivec3 origin = (mesh.firstBlock() + block) * kBlock;
  auto leaf = std::make_unique<Leaf>(openvdb::Coord(origin.x, origin.y, origin.z), 0.f);
  for (openvdb::Index i = 0; i < Leaf::SIZE; ++i)
    if (const auto density = static_cast<float>(area[i] / cell_size); density > 0.f) leaf->setValueOn(i, density);
  return leaf;
}

}  // namespace

DensityGrid DensityGrid::voxelize(const TreeMesh& mesh, float cell_size, const Progress& progress) {
  const double side = static_cast<double>(cell_size);
  validate(mesh, side);
  const MeshInCells in_cells(mesh, side);
  const std::vector<Visit> all = visits(in_cells, progress);

  std::vector<std::size_t> first;  // visit of each block, and the end
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i == 0 || all[i].block != all[i - 1].block) first.push_back(i);
  const std::size_t blocks = first.size();
  require(blocks <= kMostBlocks, "cell size [m]", side, "so large that leaves lie in at most 2^22 blocks of 8^3 cells");
  first.push_back(all.size());

  std::vector<std::unique_ptr<Leaf>> leaves(blocks);
  tbb::enumerable_thread_specific<std::vector<CellShare>> shares;
  inBatches(blocks, progress, 0.5, 1., [&](std::size_t i) {
    leaves[i] = blockDensities(in_cells, all.data() + first[i], all.data() + first[i + 1], side, shares.local());
  });

  auto tree = std::make_shared<openvdb::FloatTree>(0.f);
  for (std::unique_ptr<Leaf>& leaf : leaves)
    if (!leaf->isEmpty()) tree->addLeaf(leaf.release());
  report(progress, 1.);
  return DensityGrid(std::make_shared<const Cells>(std::move(tree), side, glm::dvec3(0.)));
}

}  // namespace sunfleck
