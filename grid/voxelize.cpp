#include <openvdb/openvdb.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/triangle_clipping.hpp"

namespace sunfleck {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;  // a block of 8 x 8 x 8 cells

constexpr double kMostCells = 0x1p20;      // of the tree along an axis
constexpr double kFarthestCell = 0x1p30;   // from the origin along an axis
constexpr double kMostCrossings = 0x1p30;  // of triangles and cells: minutes of work
constexpr double kMostMemory = 0x1p33;     // [byte]
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

// Where triangles of a mesh lie in the grid: in units of a cell, from a corner of a block, so that far from the origin
// no digits are lost.
class TrianglesInCells {
 public:
  TrianglesInCells(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles, double cell_size)
      : mesh_(mesh), triangles_(triangles), cell_size_(cell_size) {
    Bounds box;
    for (const glm::uvec3& t : triangles)
      for (int corner = 0; corner < 3; ++corner) box.include(mesh.vertices[t[corner]]);
    if (box.empty()) return;
    first_block_ = glm::ivec3(glm::floor(glm::dvec3(box.low) / (cell_size * kBlock)));
    corner_ = glm::dvec3(first_block_) * (cell_size * kBlock);
  }

  ConvexPolygon triangle(std::uint32_t i) const {
    const glm::uvec3& t = triangles_[i];
    return sunfleck::triangle(inCells(t.x), inCells(t.y), inCells(t.z));
  }
  glm::ivec3 firstBlock() const { return first_block_; }
  std::size_t count() const { return triangles_.size(); }
  double cellSize() const { return cell_size_; }

 private:
  // Rounding must not put the lowest vertex below the corner.
  glm::dvec3 inCells(std::uint32_t vertex) const {
    return glm::max((glm::dvec3(mesh_.vertices[vertex]) - corner_) / cell_size_, 0.);
  }

  const TreeMesh& mesh_;
  const std::vector<glm::uvec3>& triangles_;
  double cell_size_;
  glm::ivec3 first_block_{0};
  glm::dvec3 corner_{0.};  // [m]
};

glm::dvec3 normal(const ConvexPolygon& triangle) {
  return glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
}

// What the system can still give, where it tells [byte].
double availableMemory() {
  std::ifstream in("/proc/meminfo");
  for (std::string word; in >> word;)
    if (double kibibytes = 0.; word == "MemAvailable:" && in >> kibibytes) return kibibytes * 1024.;
  return std::numeric_limits<double>::infinity();
}

void requireMemory(double bytes, double cell_size) {
  const double most = std::min(kMostMemory, availableMemory());
  if (bytes <= most) return;
  std::ostringstream rule;
  rule.precision(3);
  rule << "so large that the grids take less memory: they would take " << bytes * 1e-9 << " GB, of " << most * 1e-9
       << " GB there are";
  require(false, "cell size [m]", cell_size, rule.str());
}

// At most so many cells of that side do the triangles cross: as many as their three projections cover and their sides
// pass.
double mostCrossings(const TreeMesh& mesh, double side) {
  double crossings = 0.;
  for (const auto* triangles : {&mesh.leaf_triangles, &mesh.wood_triangles})
    for (const glm::uvec3& t : *triangles) {
      const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
      const glm::dvec3 projected = glm::abs(glm::cross(b - a, c - a)) * 0.5;
      const glm::dvec3 sides = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
      crossings +=
          (projected.x + projected.y + projected.z) / (side * side) + 2. * (sides.x + sides.y + sides.z) / side + 1.;
    }
  return crossings;
}

void validate(const TreeMesh& mesh, double cell_size) {
  const auto check = [&](bool ok, const char* rule) { require(ok, "cell size [m]", cell_size, rule); };
  check(cell_size >= 1e-6 && cell_size <= 1e6, "from 1e-6 to 1e6");
  if (leafBounds(mesh).empty()) throw InvalidInput("the tree has no leaves: at least one is needed for a density");
  const Bounds box = bounds(mesh);
  for (int axis = 0; axis < 3; ++axis) {
    check(static_cast<double>(box.high[axis]) - static_cast<double>(box.low[axis]) <= kMostCells * cell_size,
          "so large that the tree spans at most 2^20 cells along an axis");
    check(std::max(std::abs(static_cast<double>(box.low[axis])), std::abs(static_cast<double>(box.high[axis]))) <=
              kFarthestCell * cell_size,
          "so large that the tree lies within 2^30 cells of the origin");
  }
  check(mostCrossings(mesh, cell_size) <= kMostCrossings, "so large that leaves and wood cross at most 2^30 cells");
  requireMemory(mostCrossings(mesh, cell_size * kBlock) * 2. * sizeof(Visit), cell_size);
}

// A part of the whole work, of whose own 0 .. 1 progress is told.
struct Stage {
  const Progress& progress;
  double begin, end;
  void report(double done) const {
    if (!goOn(progress, begin + (end - begin) * done)) throw std::runtime_error("interrupted");
  }
};

// Runs `work(i)` for all i < count in parallel and tells progress from `begin` to `end` between batches.
template <typename Work>
void inBatches(std::size_t count, const Stage& stage, double begin, double end, const Work& work) {
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    stage.report(begin + (end - begin) * static_cast<double>(batch) / kBatches);
    tbb::parallel_for(count * batch / kBatches, count * (batch + 1) / kBatches, work);
  }
}

// All pairs of a block and a triangle with a part in it, sorted by block and then by triangle: an order that threads
// cannot change.
std::vector<Visit> visits(const TrianglesInCells& triangles, const Stage& stage) {
  constexpr std::size_t kRun = 1024;  // triangles
  struct Local {
    std::vector<Visit> visits;
    std::vector<CellShare> shares;
  };
  tbb::enumerable_thread_specific<Local> locals;
  inBatches((triangles.count() + kRun - 1) / kRun, stage, 0., 0.4, [&](std::size_t run) {
    Local& local = locals.local();
    for (std::size_t i = run * kRun; i < std::min(triangles.count(), (run + 1) * kRun); ++i) {
      ConvexPolygon polygon = triangles.triangle(static_cast<std::uint32_t>(i));
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

// What is summed of leaves, and of wood: the kinds of sums over the triangles' parts in a cell, and the values that
// follow from them. `factors(n)`, n the unit normal, is what a triangle adds to each sum per area. `values(sums, h)` of
// a cell: the first of them is 0 where a cell stays empty.
struct LeafSums {
  static constexpr std::size_t kSums = 6, kGrids = 6;
  static std::array<double, kSums> factors(const glm::dvec3& n) {
    return {1., n.x * n.x, n.y * n.y, n.x * n.y, n.x * n.z, n.y * n.z};
  }
  // (D1) (D7) Density, and the means of the products over the area.
  static std::array<double, kGrids> values(const std::array<double, kSums>& sums, double cell_size) {
    const double area = sums[0];
    return {area / cell_size, sums[1] / area, sums[2] / area, sums[3] / area, sums[4] / area, sums[5] / area};
  }
};
struct WoodSums {
  static constexpr std::size_t kSums = 4, kGrids = 1;
  static std::array<double, kSums> factors(const glm::dvec3& n) { return {1., n.x, n.y, n.z}; }
  // (D9) A body whole in the cell has no vector area, and its mean shadow is a quarter of its surface; of a wall of
  // thicker wood that the cell holds alone, half is seen.
  static std::array<double, kGrids> values(const std::array<double, kSums>& sums, double cell_size) {
    return {(sums[0] + glm::length(glm::dvec3(sums[1], sums[2], sums[3]))) / (4. * cell_size)};
  }
};

template <typename Sums>
using Blocks = std::array<std::unique_ptr<Leaf>, Sums::kGrids>;

// What a thread works with.
template <typename Sums>
struct Workspace {
  std::vector<CellShare> shares;
  std::vector<std::array<double, Sums::kSums>> sums{Leaf::SIZE};  // [squared side of a cell]
};

// The values of one block of cells: of the parts of its triangles, summed in their order.
template <typename Sums>
Blocks<Sums> blockOfCells(const TrianglesInCells& triangles, const Visit* begin, const Visit* end,
                          Workspace<Sums>& work) {
  const glm::ivec3 block = blockOf(begin->block);
  const glm::ivec3 first = block * kBlock;
  std::fill(work.sums.begin(), work.sums.end(), std::array<double, Sums::kSums>{});
  for (const Visit* visit = begin; visit != end; ++visit) {
    const ConvexPolygon whole = triangles.triangle(visit->triangle);
    const glm::dvec3 n = normal(whole);
    work.shares.clear();
    shareAmongCells(clip(whole, glm::dvec3(first), glm::dvec3(first + kBlock)), n, work.shares);
    const auto factors = Sums::factors(n / glm::length(n));
    for (const CellShare& share : work.shares) {
      // Rounding may leave a corner one digit outside the block.
      const glm::ivec3 cell = glm::clamp(share.cell - first, 0, kBlock - 1);
      auto& sums = work.sums[static_cast<std::size_t>((cell.x * kBlock + cell.y) * kBlock + cell.z)];
      for (std::size_t k = 0; k < Sums::kSums; ++k) sums[k] += share.area * factors[k];
    }
  }

  const glm::ivec3 origin = (triangles.firstBlock() + block) * kBlock;
  Blocks<Sums> made;
  for (auto& leaf : made) leaf = std::make_unique<Leaf>(openvdb::Coord(origin.x, origin.y, origin.z), 0.f);
  for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
    if (work.sums[i][0] == 0.) continue;
    const auto values = Sums::values(work.sums[i], triangles.cellSize());
    if (static_cast<float>(values[0]) == 0.f) continue;
    for (std::size_t k = 0; k < Sums::kGrids; ++k) made[k]->setValueOn(i, static_cast<float>(values[k]));
  }
  return made;
}

template <typename Sums>
std::array<openvdb::FloatTree::Ptr, Sums::kGrids> treesOf(const TreeMesh& mesh,
                                                          const std::vector<glm::uvec3>& mesh_triangles,
                                                          double cell_size, const Stage& stage) {
  const TrianglesInCells triangles(mesh, mesh_triangles, cell_size);
  const std::vector<Visit> all = visits(triangles, stage);
  std::vector<std::size_t> first;  // visit of each block, and the end
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i == 0 || all[i].block != all[i - 1].block) first.push_back(i);
  const std::size_t blocks = first.size();
  requireMemory(static_cast<double>(blocks * Sums::kGrids * (sizeof(Leaf) + Leaf::SIZE * sizeof(float))), cell_size);
  first.push_back(all.size());

  std::vector<Blocks<Sums>> made(blocks);
  tbb::enumerable_thread_specific<Workspace<Sums>> workspaces;
  inBatches(blocks, stage, 0.5, 1., [&](std::size_t i) {
    made[i] = blockOfCells<Sums>(triangles, all.data() + first[i], all.data() + first[i + 1], workspaces.local());
  });

  std::array<openvdb::FloatTree::Ptr, Sums::kGrids> trees;
  for (std::size_t k = 0; k < Sums::kGrids; ++k) {
    trees[k] = std::make_shared<openvdb::FloatTree>(0.f);
    for (Blocks<Sums>& block : made)
      if (!block[k]->isEmpty()) trees[k]->addLeaf(block[k].release());
  }
  stage.report(1.);
  return trees;
}

}  // namespace

DensityGrid DensityGrid::voxelize(const TreeMesh& mesh, float cell_size, const Progress& progress) {
  const double side = static_cast<double>(cell_size);
  validate(mesh, side);
  const auto leaves = static_cast<double>(mesh.leaf_triangles.size());
  const double leaf_work = leaves / (leaves + static_cast<double>(mesh.wood_triangles.size()));
  DensityTrees trees;
  const auto of_leaves = treesOf<LeafSums>(mesh, mesh.leaf_triangles, side, {progress, 0., leaf_work});
  trees.density = of_leaves[0];
  std::copy(of_leaves.begin() + 1, of_leaves.end(), trees.normals.begin());
  if (!mesh.wood_triangles.empty())
    trees.wood = treesOf<WoodSums>(mesh, mesh.wood_triangles, side, {progress, leaf_work, 1.})[0];
  return DensityGrid(std::make_shared<const Cells>(std::move(trees), side, glm::dvec3(0.)));
}

}  // namespace sunfleck
