#include <openvdb/openvdb.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/block_visits.hpp"
#include "grid/detail/density_cells.hpp"

namespace sunfleck {
namespace {

using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;
using Cells = DensityGrid::Cells;

constexpr double kMostCells = 0x1p20;  // of the stand along an axis
constexpr double kMostCopies = 0x1p24;
// Eight visits of a tree make a block of 2 KiB at least, unless trees stand in each other: so much is sure to be needed
// where up to four do.
constexpr double kBytesOfVisit = 4. * sizeof(Visit);

TreeMesh turned(TreeMesh mesh, float angle) {
  const double c = std::cos(static_cast<double>(angle)), s = std::sin(static_cast<double>(angle));
  for (glm::vec3& v : mesh.vertices)
    v = glm::dvec3(c * static_cast<double>(v.x) - s * static_cast<double>(v.y),
                   s * static_cast<double>(v.x) + c * static_cast<double>(v.y), static_cast<double>(v.z));
  return mesh;
}

// A number of cells; lengths are floats, so that what differs from a whole number by their roundings is meant to be
// one.
double inCells(double length, double cell_size) {
  const double cells = length / cell_size;
  const double whole = std::round(cells);
  return std::abs(cells - whole) <= 0x1p-22 * std::abs(cells) ? whole : cells;
}

// A tree's grid, moved by a number of cells that need not be whole.
struct Copy {
  std::size_t prototype;
  glm::ivec3 whole;
  glm::dvec3 fraction;  // 0 .. below 1
};

// What of the space is kept: everything, or one period [cell].
struct Kept {
  glm::dvec3 low{-std::numeric_limits<double>::infinity()}, high{std::numeric_limits<double>::infinity()};
};

// How the 8 cells of a block are shared along an axis among the cells of another: each overlaps at most two of them.
struct SharesAlong {
  struct Share {
    int cell;       // in the other block, 0 .. 7
    double weight;  // 0: none, or outside
  };
  std::array<std::array<Share, 2>, kBlock> of;

  SharesAlong(int source, int whole, double fraction, int target, double low, double high) {
    for (int i = 0; i < kBlock; ++i)
      for (int step = 0; step < 2; ++step) {
        const int cell = source + i + whole + step;
        const double begin = std::max(cell + (step == 0 ? fraction : 0.), low);
        const double end = std::min(cell + (step == 0 ? 1. : fraction), high);
        const bool inside = cell >= target && cell < target + kBlock && begin < end;
        of[static_cast<std::size_t>(i)][static_cast<std::size_t>(step)] = {inside ? cell - target : 0,
                                                                           inside ? end - begin : 0.};
      }
  }
};

glm::ivec3 toIvec(const openvdb::Coord& c) {
  return {c.x(), c.y(), c.z()};
}
openvdb::Coord toCoord(const glm::ivec3& c) {
  return {c.x, c.y, c.z};
}
glm::ivec3 blockHolding(const glm::ivec3& cell) {
  return cell >> 3;
}

// Cells of a kind of tree, turned by one of the rotations that trees of this kind have.
struct Prototype {
  DensityTrees trees;
  std::optional<BandOptics> optics;  // of its leaves; none where they are not asked for
};

// The blocks of all copies' cells of leaves, or of those of wood.
class Placed {
 public:
  Placed(const std::vector<Prototype>& prototypes, FloatTreePtr DensityTrees::*of, const std::vector<Copy>& copies,
         const Kept& kept)
      : prototypes_(prototypes), copies_(copies), kept_(kept) {
    for (const Prototype& prototype : prototypes) {
      blocks_.emplace_back();
      boxes_.emplace_back();
      if (prototype.trees.*of) (prototype.trees.*of)->getNodes(blocks_.back());
      for (const Leaf* leaf : blocks_.back()) leaf->evalActiveBoundingBox(boxes_.back().emplace_back());
    }
    std::size_t count = 0;
    for (const Copy& copy : copies) {
      first_.push_back(count);
      count += blocks_[copy.prototype].size();
    }
    first_.push_back(count);
  }

  std::vector<BlockOfCells> blocks(double cell_size, const glm::ivec3& first_block, bool leaves,
                                   const Stage& stage) const {
    const double bytes_of_cell =
        leaves ? sizeof(LeafOrientation) + (prototypes_[0].optics ? sizeof(BandOptics) : 0.) : 0.;
    requireMemory(static_cast<double>(first_.back()) * kBytesOfVisit, cell_size);  // one at least, but beyond a period
    const SortedVisits sorted = visits(cell_size, first_block, stage);
    std::vector<double> cells_of;
    for (const auto& of_prototype : blocks_)
      cells_of.push_back(std::accumulate(
          of_prototype.begin(), of_prototype.end(), 0.,
          [](double sum, const Leaf* leaf) { return sum + static_cast<double>(leaf->onVoxelCount()); }));
    double cells = 0.;  // at most
    for (const Copy& copy : copies_) cells += 8. * cells_of[copy.prototype];
    const auto blocks = static_cast<double>(sorted.blocks());
    requireMemory(blocks * kBytesOfBlock + std::min(cells, blocks * Leaf::SIZE) * bytes_of_cell, cell_size);
    std::vector<BlockOfCells> made(sorted.blocks());
    tbb::enumerable_thread_specific<Sums> workspaces;
    stage.inBatches(made.size(), 0.4, 1., [&](std::size_t i) {
      made[i] = block(sorted.ofBlock(i), first_block, leaves, workspaces.local());
    });
    stage.report(1.);
    return made;
  }

 private:
  // Of each cell in use: density, and density times each moment and each of the optics.
  static constexpr std::size_t kOptics = kOpticsNames.size(), kFirstOptics = 1 + kMoments.size();
  using OfCell = std::array<double, kFirstOptics + kOptics>;
  using Sums = std::array<OfCell, Leaf::SIZE>;

  // `act(key)` of each block in which a block of the copy has a part.
  template <typename Act>
  void overTargets(const Copy& copy, const openvdb::CoordBBox& cells, const glm::ivec3& first_block,
                   const Act& act) const {
    const glm::ivec3 beyond(glm::ceil(copy.fraction));
    const glm::dvec3 low = glm::max(glm::dvec3(toIvec(cells.min()) + copy.whole), kept_.low);
    const glm::dvec3 high = glm::min(glm::dvec3(toIvec(cells.max()) + copy.whole + beyond), glm::ceil(kept_.high) - 1.);
    if (low.x > high.x || low.y > high.y) return;
    const glm::ivec3 first = blockHolding(glm::ivec3(low)), last = blockHolding(glm::ivec3(high));
    for (int x = first.x; x <= last.x; ++x)
      for (int y = first.y; y <= last.y; ++y)
        for (int z = first.z; z <= last.z; ++z) act(blockKey(glm::ivec3(x, y, z) - first_block));
  }

  SortedVisits visits(double cell_size, const glm::ivec3& first_block, const Stage& stage) const {
    const auto overCopy = [&](std::size_t i, const auto& act) {
      const Copy& copy = copies_[i];
      const std::vector<openvdb::CoordBBox>& boxes = boxes_[copy.prototype];
      for (std::size_t b = 0; b < boxes.size(); ++b)
        overTargets(copy, boxes[b], first_block, [&](std::uint64_t key) {
          act(Visit{key, static_cast<std::uint32_t>(first_[i] + b)});
        });
    };
    std::vector<std::size_t> place(copies_.size() + 1);
    stage.inBatches(copies_.size(), 0., 0.1, [&](std::size_t i) {
      std::size_t count = 0;
      overCopy(i, [&](const Visit&) { ++count; });
      place[i + 1] = count;
    });
    std::partial_sum(place.begin(), place.end(), place.begin());
    requireMemory(static_cast<double>(place.back()) * kBytesOfVisit, cell_size);
    std::vector<Visit> all(place.back());
    stage.inBatches(copies_.size(), 0.1, 0.2, [&](std::size_t i) {
      Visit* next = all.data() + place[i];
      overCopy(i, [&](const Visit& visit) { *next++ = visit; });
    });
    return SortedVisits(std::move(all));
  }

  // (D2), and (D11) where there are optics
  BlockOfCells block(std::span<const Visit> visits, const glm::ivec3& first_block, bool leaves, Sums& sums) const {
    const glm::ivec3 origin = (blockOf(visits[0].block) + first_block) * kBlock;
    BlockOfCells made{std::make_unique<Leaf>(toCoord(origin), 0.f), {}, {}};
    const bool with_optics = leaves && prototypes_[0].optics;
    const std::size_t used = with_optics ? kFirstOptics + kOptics : leaves ? kFirstOptics : 1;
    for (const Visit& visit : visits) {
      const std::size_t number =
          static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), visit.visitor) - first_.begin()) - 1;
      const Copy& copy = copies_[number];
      const Leaf& source = *blocks_[copy.prototype][visit.visitor - first_[number]];
      const auto along = [&](int axis) {
        return SharesAlong(source.origin()[axis], copy.whole[axis], copy.fraction[axis], origin[axis], kept_.low[axis],
                           kept_.high[axis]);
      };
      const SharesAlong x_shares = along(0), y_shares = along(1), z_shares = along(2);
      const Prototype& prototype = prototypes_[copy.prototype];
      const LeafOrientation* moment = leaves ? prototype.trees.moments[source.transientData()].data() : nullptr;
      OfCell values{1.};
      if (with_optics)
        for (std::size_t i = 0; i < kOptics; ++i)
          values[kFirstOptics + i] = static_cast<double>(opticsValue(*prototype.optics, i));
      for (auto cell = source.cbeginValueOn(); cell; ++cell) {
        if (moment) {
          for (std::size_t i = 0; i < kMoments.size(); ++i) values[1 + i] = static_cast<double>(moment->*kMoments[i]);
          ++moment;
        }
        const auto density = static_cast<double>(*cell);
        const openvdb::Coord at = Leaf::offsetToLocalCoord(cell.pos());
        for (const auto& x : x_shares.of[static_cast<std::size_t>(at.x())])
          for (const auto& y : y_shares.of[static_cast<std::size_t>(at.y())])
            for (const auto& z : z_shares.of[static_cast<std::size_t>(at.z())]) {
              const double share = density * x.weight * y.weight * z.weight;
              if (share == 0.) continue;
              const auto target = static_cast<openvdb::Index>((x.cell * kBlock + y.cell) * kBlock + z.cell);
              if (!made.leaf->isValueOn(target)) {
                made.leaf->setActiveState(target, true);
                sums[target] = {};
              }
              for (std::size_t k = 0; k < used; ++k) sums[target][k] += share * values[k];
            }
      }
    }
    for (auto cell = made.leaf->beginValueOn(); cell; ++cell) {
      const auto& sum = sums[cell.pos()];
      cell.setValue(static_cast<float>(sum[0]));
      const auto mean = [&](std::size_t k) { return static_cast<float>(sum[k] / sum[0]); };
      if (*cell == 0.f) {
        cell.setValueOff();
        continue;
      }
      if (leaves) made.moments.push_back({mean(1), mean(2), mean(3), mean(4), mean(5)});
      if (!with_optics) continue;
      BandOptics& optics = made.optics.emplace_back();
      for (std::size_t i = 0; i < kOptics; ++i) opticsValue(optics, i) = mean(kFirstOptics + i);
    }
    return made;
  }

  const std::vector<Prototype>& prototypes_;
  const std::vector<Copy>& copies_;
  Kept kept_;
  std::vector<std::vector<const Leaf*>> blocks_;        // of each prototype
  std::vector<std::vector<openvdb::CoordBBox>> boxes_;  // of the active cells of each of them
  std::vector<std::size_t> first_;                      // block of each copy among those of all, and the end
};

void validate(const Stand& stand, std::size_t kinds, float cell_size) {
  require(!stand.trees.empty(), "number of trees", stand.trees.size(), "at least 1");
  for (std::size_t i = 0; i < stand.trees.size(); ++i) {
    const auto& [position, rotation, kind] = stand.trees[i];
    const std::string name = "tree " + std::to_string(i) + " ";
    require(kind < kinds, name + "kind", kind, "below the number of kinds, " + std::to_string(kinds));
    require(std::isfinite(rotation), name + "rotation", rotation, "finite");
    for (int axis = 0; axis < 3; ++axis)
      require(std::isfinite(position[axis]), name + "position [m]", position[axis], "finite");
  }
  if (!stand.period) return;
  for (int axis = 0; axis < 2; ++axis) {
    const float side = (*stand.period)[axis];
    require(std::isfinite(side) && side > 0.f, "period [m]", side, "above 0");
    require(!(cell_size > side), "cell size [m]", cell_size,
            "at most a side of the period, " + std::to_string(side) + " m");
  }
}

// Box of the cells of leaves and wood.
openvdb::CoordBBox boxOf(const DensityTrees& trees) {
  openvdb::CoordBBox box, wood;
  trees.density->evalActiveVoxelBoundingBox(box);
  if (trees.wood && trees.wood->evalActiveVoxelBoundingBox(wood)) box.expand(wood);
  return box;
}

void requireCells(bool ok, double cell_size, const char* rule) {
  require(ok, "cell size [m]", static_cast<float>(cell_size), rule);
}

// All copies of the trees, with a period also those of the neighbouring periods that reach into this one; and the box
// of their cells.
struct Arrangement {
  Kept kept;
  std::vector<Copy> copies;
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  Arrangement(const Stand& stand, const std::vector<Prototype>& prototypes,
              const std::vector<std::size_t>& prototype_of_tree, double cell_size) {
    const glm::dvec2 period = stand.period ? glm::dvec2(inCells(static_cast<double>(stand.period->x), cell_size),
                                                        inCells(static_cast<double>(stand.period->y), cell_size))
                                           : glm::dvec2(0.);
    if (stand.period) keepPeriod(stand, period, cell_size);
    std::vector<openvdb::CoordBBox> boxes;
    for (const Prototype& prototype : prototypes) boxes.push_back(boxOf(prototype.trees));
    for (std::size_t tree = 0; tree < stand.trees.size(); ++tree) {
      const std::size_t prototype = prototype_of_tree[tree];
      const glm::dvec3 position(stand.trees[tree].position);
      const glm::dvec3 box_low(toIvec(boxes[prototype].min())), box_high(toIvec(boxes[prototype].max()) + 1);
      const auto images = [&](int axis) {  // first and last
        if (!stand.period) return std::pair{0., 0.};
        const double at = position[axis] / cell_size;
        return std::pair{std::ceil((kept.low[axis] - at - box_high[axis]) / period[axis]),
                         std::floor((kept.high[axis] - at - box_low[axis]) / period[axis])};
      };
      const auto [first_x, last_x] = images(0);
      const auto [first_y, last_y] = images(1);
      const double count = static_cast<double>(copies.size()) + (last_x - first_x + 1.) * (last_y - first_y + 1.);
      if (stand.period)
        require(count <= kMostCopies, "period [m]", std::min(stand.period->x, stand.period->y),
                "so long that at most 2^24 trees reach into one period, those of its neighbours included");
      else
        require(count <= kMostCopies, "number of trees", stand.trees.size(), "at most 2^24");
      for (double x = first_x; x <= last_x; ++x)
        for (double y = first_y; y <= last_y; ++y) {
          const glm::dvec3 image(x, y, 0.);
          glm::dvec3 shift;
          for (int axis = 0; axis < 3; ++axis)
            shift[axis] =
                stand.period && axis < 2
                    ? inCells(position[axis] + image[axis] * static_cast<double>((*stand.period)[axis]), cell_size)
                    : inCells(position[axis], cell_size);
          add(prototype, shift, box_low, box_high, cell_size);
        }
    }
  }

 private:
  // One period, about the middle of the trees' places.
  void keepPeriod(const Stand& stand, const glm::dvec2& period, double cell_size) {
    Bounds places;
    for (const Placement& tree : stand.trees) places.include(tree.position);
    for (int axis = 0; axis < 2; ++axis) {
      const double middle = 0.5 * (static_cast<double>(places.low[axis]) + static_cast<double>(places.high[axis]));
      kept.low[axis] = std::round(middle / cell_size - 0.5 * period[axis]);
      kept.high[axis] = kept.low[axis] + period[axis];
    }
  }

  void add(std::size_t prototype, const glm::dvec3& shift, const glm::dvec3& box_low, const glm::dvec3& box_high,
           double cell_size) {
    low = glm::min(low, glm::max(glm::floor(shift + box_low), kept.low));
    high = glm::max(high, glm::min(glm::ceil(shift + box_high), glm::ceil(kept.high)));
    const glm::dvec3 size = high - low, farthest = glm::max(glm::abs(shift + box_low), glm::abs(shift + box_high));
    requireCells(std::max({size.x, size.y, size.z}) <= kMostCells, cell_size,
                 "so large that the stand spans at most 2^20 cells along an axis");
    requireCells(std::max({farthest.x, farthest.y, farthest.z}) <= 0x1p30, cell_size,
                 "so large that the stand lies within 2^30 cells of the origin");
    const glm::dvec3 whole = glm::floor(shift);
    copies.push_back({prototype, glm::ivec3(whole), shift - whole});
  }
};

}  // namespace

DensityGrid DensityGrid::voxelizeStand(std::span<const TreeMesh* const> kinds, const Stand& stand, float cell_size,
                                       std::span<const BandOptics> optics, const Progress& progress) {
  const double side = static_cast<double>(cell_size);
  validate(stand, kinds.size(), cell_size);
  require(optics.empty() || optics.size() == kinds.size(), "number of kinds of trees with optics", optics.size(),
          "0 or that of all kinds, " + std::to_string(kinds.size()));
  for (const BandOptics& of_kind : optics)
    for (const LeafOptics& band : of_kind) sunfleck::validate(band);

  std::map<std::pair<std::uint32_t, float>, std::size_t> prototype_of;  // of a kind and a rotation
  std::vector<std::size_t> prototype_of_tree;
  for (const Placement& tree : stand.trees)
    prototype_of_tree.push_back(
        prototype_of.try_emplace({tree.kind, tree.rotation}, prototype_of.size()).first->second);
  std::vector<Prototype> prototypes(prototype_of.size());
  double done = 0.;
  bool wood = false;
  for (const auto& [what, number] : prototype_of) {
    const auto& [kind, rotation] = what;
    const double part = 0.5 / static_cast<double>(prototypes.size());
    const Progress partly = [&](double share) { return goOn(progress, done + part * share); };
    const DensityGrid grid = rotation == 0.f ? voxelize(*kinds[kind], cell_size, partly)
                                             : voxelize(turned(*kinds[kind], rotation), cell_size, partly);
    requireMemory(static_cast<double>(grid.memoryBytes() * prototypes.size()), side);
    prototypes[number].trees = *grid.cells_;
    if (!optics.empty()) prototypes[number].optics = optics[kind];
    wood = wood || prototypes[number].trees.wood;
    done += part;
  }

  const Arrangement arrangement(stand, prototypes, prototype_of_tree, side);
  const glm::ivec3 first_block = blockHolding(glm::ivec3(arrangement.low));
  const auto placed = [&](FloatTreePtr DensityTrees::*of, const Stage& stage) {
    return Placed(prototypes, of, arrangement.copies, arrangement.kept)
        .blocks(side, first_block, of == &DensityTrees::density, stage);
  };
  DensityTrees trees(placed(&DensityTrees::density, {progress, 0.5, 0.9}));
  if (wood) trees.setWood(placed(&DensityTrees::wood, {progress, 0.9, 1.}));
  std::optional<Cells::Rectangle> period;
  if (stand.period) period = {glm::dvec2(arrangement.kept.low), glm::dvec2(arrangement.kept.high)};
  auto cells = std::make_shared<Cells>(std::move(trees), side, glm::dvec3(0.), period);
  if (stand.period) cells->period = *stand.period;
  return DensityGrid(std::move(cells));
}

DensityGrid DensityGrid::voxelizeStand(const TreeMesh& mesh, const Stand& stand, float cell_size) {
  return voxelizeStand(std::array{&mesh}, stand, cell_size);
}

}  // namespace sunfleck
