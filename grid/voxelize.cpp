#include <openvdb/openvdb.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <span>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/block_visits.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/triangle_clipping.hpp"

namespace sunfleck {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;  // a block of 8 x 8 x 8 cells

constexpr double kMostCells = 0x1p20;      // of the tree along an axis
constexpr double kFarthestCell = 0x1p30;   // from the origin along an axis
constexpr double kMostCrossings = 0x1p30;  // of triangles and cells: minutes of work
static_assert(kBlock == Leaf::DIM);

// Where triangles of a mesh lie in the grid: in units of a cell, from a corner of a block, so that far from the origin
// no digits are lost.
class TrianglesInCells {
 public:
  // `box`: of the triangles
  TrianglesInCells(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles, const Bounds& box, double cell_size)
      : mesh_(mesh),
        triangles_(triangles),
        cell_size_(cell_size),
        first_block_(glm::floor(glm::dvec3(box.low) / (cell_size * kBlock))),
        corner_(glm::dvec3(first_block_) * (cell_size * kBlock)) {}

  ConvexPolygon triangle(std::uint32_t i) const {
    const glm::uvec3& t = triangles_[i];
    return sunfleck::triangle(inCells(t.x), inCells(t.y), inCells(t.z));
  }
  // Ask for what triangle() reads of a triangle to be fetched into the cache, first its corners' numbers, then these.
  void fetchNumbers(std::uint32_t i) const { __builtin_prefetch(&triangles_[i]); }
  void fetchCorners(std::uint32_t i) const {
    for (int corner = 0; corner < 3; ++corner) __builtin_prefetch(&mesh_.vertices[triangles_[i][corner]]);
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
  glm::ivec3 first_block_;
  glm::dvec3 corner_;  // [m]
};

glm::dvec3 normal(const ConvexPolygon& triangle) {
  return glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
}

// What bounds where triangles lie and how many cells they cross.
struct Extents {
  double faces = 0.;  // of the triangles' projections along x, y and z, the sum [m^2]
  double sides = 0.;  // of the triangles' boxes, the sum [m]
  double count = 0.;
  Bounds box;

  // At most so many cells of that side: as many as the projections cover and the sides pass.
  double crossings(double side) const { return faces / (side * side) + 2. * sides / side + count; }
};

Extents extentsOf(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, triangles.size(), 10'000), Extents{},
      [&](const tbb::blocked_range<std::size_t>& range, Extents sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const glm::uvec3& t = triangles[i];
          for (int corner = 0; corner < 3; ++corner) sum.box.include(mesh.vertices[t[corner]]);
          const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
          const glm::dvec3 projected = glm::abs(glm::cross(b - a, c - a)) * 0.5;
          const glm::dvec3 sides = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
          sum.faces += projected.x + projected.y + projected.z;
          sum.sides += sides.x + sides.y + sides.z;
          sum.count += 1.;
        }
        return sum;
      },
      [](const Extents& a, const Extents& b) {
        Extents sum{a.faces + b.faces, a.sides + b.sides, a.count + b.count, a.box};
        sum.box.include(b.box);
        return sum;
      });
}

void validate(const Extents& leaves, const Extents& wood, double cell_size) {
  const auto check = [&](bool ok, const char* rule) {
    require(ok, "cell size [m]", static_cast<float>(cell_size), rule);
  };
  // OpenVDB knows no smaller cells: their volume is 0 to it.
  check(cell_size >= static_cast<double>(2e-5f) && cell_size <= 1e6, "from 2e-5 to 1e6");
  if (leaves.box.empty()) throw InvalidInput("the tree has no leaves: at least one is needed for a density");
  Bounds box = leaves.box;
  box.include(wood.box);
  for (int axis = 0; axis < 3; ++axis) {
    check(static_cast<double>(box.high[axis]) - static_cast<double>(box.low[axis]) <= kMostCells * cell_size,
          "so large that the tree spans at most 2^20 cells along an axis");
    check(std::max(std::abs(static_cast<double>(box.low[axis])), std::abs(static_cast<double>(box.high[axis]))) <=
              kFarthestCell * cell_size,
          "so large that the tree lies within 2^30 cells of the origin");
  }
  check(leaves.crossings(cell_size) + wood.crossings(cell_size) <= kMostCrossings,
        "so large that leaves and wood cross at most 2^30 cells");
  const double block = cell_size * kBlock;
  requireMemory(std::max(leaves.crossings(block), wood.crossings(block)) * 2. * sizeof(Visit), cell_size);
}

// Of a triangle in units of a cell.
struct Box {
  glm::dvec3 low, high;

  explicit Box(const ConvexPolygon& triangle)
      : low(glm::min(glm::min(triangle.corners[0], triangle.corners[1]), triangle.corners[2])),
        high(glm::max(glm::max(triangle.corners[0], triangle.corners[1]), triangle.corners[2])) {}

  // Whether it lies in one cube of that side, and in no wall of it.
  bool inOne(int side) const { return glm::ivec3(low) / side == glm::ivec3(high) / side; }
};

// All pairs of a block and a triangle with a part in it.
SortedVisits visits(const TrianglesInCells& triangles, const Stage& stage) {
  constexpr std::size_t kRun = 1024;  // triangles
  std::vector<std::vector<Visit>> of_runs((triangles.count() + kRun - 1) / kRun);
  tbb::enumerable_thread_specific<std::vector<CellShare>> of_threads;
  stage.inBatches(of_runs.size(), 0., 0.3, [&](std::size_t run) {
    std::vector<CellShare>& shares = of_threads.local();
    of_runs[run].reserve(2 * kRun);
    for (std::size_t i = run * kRun; i < std::min(triangles.count(), (run + 1) * kRun); ++i) {
      ConvexPolygon polygon = triangles.triangle(static_cast<std::uint32_t>(i));
      if (const Box box(polygon); box.inOne(kBlock)) {
        of_runs[run].push_back({blockKey(glm::ivec3(box.low) / kBlock), static_cast<std::uint32_t>(i)});
        continue;
      }
      for (int corner = 0; corner < 3; ++corner) polygon.corners[static_cast<std::size_t>(corner)] /= double{kBlock};
      shares.clear();
      shareAmongCells(polygon, normal(polygon), shares);
      for (const CellShare& share : shares)
        of_runs[run].push_back({blockKey(share.cell), static_cast<std::uint32_t>(i)});
    }
  });

  std::vector<std::size_t> place(of_runs.size() + 1);
  for (std::size_t run = 0; run < of_runs.size(); ++run) place[run + 1] = place[run] + of_runs[run].size();
  std::vector<Visit> all(place.back());
  stage.inBatches(of_runs.size(), 0.3, 0.4, [&](std::size_t run) {
    std::copy(of_runs[run].begin(), of_runs[run].end(), all.data() + place[run]);
    of_runs[run] = {};
  });
  return SortedVisits(std::move(all));
}

// What is summed of leaves, and of wood: the kinds of sums over the triangles' parts in a cell, and the values that
// follow from them. `factors(n)`, n the unit normal, is what a triangle adds to each sum per area.
struct LeafSums {
  static constexpr std::size_t kSums = 6;
  static constexpr bool kMoments = true;
  static std::array<double, kSums> factors(const glm::dvec3& n) {
    return {1., n.x * n.x, n.y * n.y, n.x * n.y, n.x * n.z, n.y * n.z};
  }
  // (D1)
  static double density(const std::array<double, kSums>& sums, double cell_size) { return sums[0] / cell_size; }
  // (D7) Means of the products over the area.
  static LeafOrientation moments(const std::array<double, kSums>& sums) {
    const double per_area = 1. / sums[0];
    const auto mean = [&](std::size_t i) { return static_cast<float>(sums[i] * per_area); };
    return {mean(1), mean(2), mean(3), mean(4), mean(5)};
  }
};
struct WoodSums {
  static constexpr std::size_t kSums = 4;
  static constexpr bool kMoments = false;
  static std::array<double, kSums> factors(const glm::dvec3& n) { return {1., n.x, n.y, n.z}; }
  // (D9) A body whole in the cell has no vector area, and its mean shadow is a quarter of its surface; of a wall of
  // thicker wood that the cell holds alone, half is seen.
  static double density(const std::array<double, kSums>& sums, double cell_size) {
    return (sums[0] + glm::length(glm::dvec3(sums[1], sums[2], sums[3]))) / (4. * cell_size);
  }
};

// What a thread works with.
template <typename Sums>
struct Workspace {
  std::vector<CellShare> shares;
  std::array<std::array<double, Sums::kSums>, Leaf::SIZE> sums;  // of the cells in use [squared side of a cell]
};

// The block of cells of the first `count` of these visits: of the parts of its triangles, summed in their order. Its
// triangles lie anywhere in memory; those of later visits are fetched meanwhile.
template <typename Sums>
BlockOfCells blockOfCells(const TrianglesInCells& triangles, std::span<const Visit> visits, std::size_t count,
                          Workspace<Sums>& work) {
  constexpr std::size_t kAhead = 8;  // visits
  const glm::ivec3 block = blockOf(visits[0].block);
  const glm::ivec3 first = block * kBlock;
  const glm::ivec3 origin = (triangles.firstBlock() + block) * kBlock;
  BlockOfCells made{std::make_unique<Leaf>(openvdb::Coord(origin.x, origin.y, origin.z), 0.f), {}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 2 * kAhead < visits.size()) triangles.fetchNumbers(visits[i + 2 * kAhead].visitor);
    if (i + kAhead < visits.size()) triangles.fetchCorners(visits[i + kAhead].visitor);
    const ConvexPolygon whole = triangles.triangle(visits[i].visitor);
    const glm::dvec3 n = normal(whole);
    const double twice_area = glm::length(n);
    if (twice_area == 0.) continue;
    work.shares.clear();
    if (const Box box(whole); box.inOne(1))
      work.shares.push_back({glm::ivec3(box.low), 0.5 * twice_area});
    else if (box.inOne(kBlock))
      shareAmongCells(whole, n, work.shares);
    else
      shareAmongCells(clip(whole, glm::dvec3(first), glm::dvec3(first + kBlock)), n, work.shares);
    const auto factors = Sums::factors(n / twice_area);
    for (const CellShare& share : work.shares) {
      // Rounding may leave a corner one digit outside the block.
      const glm::ivec3 cell = glm::clamp(share.cell - first, 0, kBlock - 1);
      const auto in_block = static_cast<openvdb::Index>((cell.x * kBlock + cell.y) * kBlock + cell.z);
      auto& sums = work.sums[in_block];
      if (!made.leaf->isValueOn(in_block)) {
        made.leaf->setActiveState(in_block, true);
        sums = {};
      }
      for (std::size_t k = 0; k < Sums::kSums; ++k) sums[k] += share.area * factors[k];
    }
  }
  if constexpr (Sums::kMoments) made.moments.reserve(made.leaf->onVoxelCount());
  for (auto cell = made.leaf->beginValueOn(); cell; ++cell) {
    const auto& sums = work.sums[cell.pos()];
    const auto density = static_cast<float>(Sums::density(sums, triangles.cellSize()));
    cell.setValue(density);
    if (density == 0.f)
      cell.setValueOff();
    else if constexpr (Sums::kMoments)
      made.moments.push_back(Sums::moments(sums));
  }
  return made;
}

template <typename Sums>
std::vector<BlockOfCells> blocksOf(const TreeMesh& mesh, const std::vector<glm::uvec3>& mesh_triangles,
                                   const Extents& extents, double cell_size, const Stage& stage) {
  const TrianglesInCells triangles(mesh, mesh_triangles, extents.box, cell_size);
  const SortedVisits sorted = visits(triangles, stage);
  const double cells = std::min(extents.crossings(cell_size), static_cast<double>(sorted.blocks()) * Leaf::SIZE);
  requireMemory(
      static_cast<double>(sorted.blocks()) * kBytesOfBlock + (Sums::kMoments ? cells * sizeof(LeafOrientation) : 0.),
      cell_size);
  std::vector<BlockOfCells> made(sorted.blocks());
  tbb::enumerable_thread_specific<Workspace<Sums>> workspaces;
  stage.inBatches(made.size(), 0.5, 1., [&](std::size_t i) {
    made[i] = blockOfCells<Sums>(triangles, sorted.fromBlock(i), sorted.ofBlock(i).size(), workspaces.local());
  });
  stage.report(1.);
  return made;
}

}  // namespace

void requireMemory(double bytes, double cell_size) {
  const double most = availableMemory();
  if (bytes <= most) return;
  std::ostringstream rule;
  rule.precision(3);
  rule << "so large that the grids take less memory: they would take " << bytes * 1e-9 << " GB, of " << most * 1e-9
       << " GB there are";
  require(false, "cell size [m]", static_cast<float>(cell_size), rule.str());
}

DensityGrid DensityGrid::voxelize(const TreeMesh& mesh, float cell_size, const Progress& progress) {
  const double side = static_cast<double>(cell_size);
  const Extents leaves = extentsOf(mesh, mesh.leaf_triangles), wood = extentsOf(mesh, mesh.wood_triangles);
  validate(leaves, wood, side);
  const double leaf_work = leaves.count / (leaves.count + wood.count);
  DensityTrees trees(blocksOf<LeafSums>(mesh, mesh.leaf_triangles, leaves, side, {progress, 0., leaf_work}));
  if (!mesh.wood_triangles.empty())
    trees.setWood(blocksOf<WoodSums>(mesh, mesh.wood_triangles, wood, side, {progress, leaf_work, 1.}));
  return DensityGrid(std::make_shared<const Cells>(std::move(trees), side, glm::dvec3(0.)));
}

}  // namespace sunfleck
