#include <tbb/parallel_for.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "grid/foliage_stand.hpp"
#include "grid/neighbours.hpp"

// How sums over trees follow the trees that move.
namespace sunfleck {
namespace {

constexpr std::size_t kFewChanges = 4;  // more than one change to so many instances: sums are made anew

}  // namespace

// The leaves of any prototype less the cells' centres, with the half cell by which thickness reaches beyond the leaves.
Bounds FoliageStand::reached(const CellGrid& receiver) const {
  Bounds box;
  for (const Prototype& p : prototypes_) {
    if (p.cells.leaves.empty()) continue;  // it has never stood
    const glm::vec3 beyond(2.f * p.cells.cell_size);
    box.include(
        Bounds{p.cells.leaves.low - beyond - receiver.box().high, p.cells.leaves.high + beyond - receiver.box().low});
  }
  return box;
}

void FoliageStand::touchDepths() {
  changes_.clear();
  index_stale_ = true;
  graph_.touchAll(sample_depths_);
  graph_.touchAll(light_depths_);
}

void FoliageStand::applyChanges(std::span<const std::size_t> standing) {
  float width = 0.f;
  glm::ivec2 around(0);
  for (const std::size_t p : standing) {
    const Bounds& leaves = prototypes_[p].cells.leaves;
    width = std::max({width, leaves.size().x, leaves.size().y});
    around = glm::max(around, periodsAround({.period = period_}, leaves));
  }
  // A wider tree brings more copies of all trees into the stand.
  if (around != around_ || changes_.size() * kFewChanges > placed_.size() + kFewChanges) touchDepths();
  if (changes_.empty() && !index_stale_) return;
  around_ = around;
  index_ = StandIndex(positions_, std::max(width, 1e-6f), period_, around);
  index_stale_ = false;

  // Which trees see a moved one: the index tells it from where it stood and stands, which is the same line.
  struct Part {
    std::size_t instance, axis, source;
    glm::vec3 displacement;  // of the source from the instance [m]
    std::int32_t times;
  };
  std::vector<Part> parts;
  const std::size_t axes = effort_.axes.size();
  const auto isFresh = [&](std::size_t instance, std::size_t axis) {
    return axis < axes ? !graph_.stale(sample_depths_, instance * axes + axis)
                       : !graph_.stale(light_depths_, member(instance, axis - axes));
  };
  for (const Change& change : changes_)
    for (const auto& [place, times] : {std::pair(change.from, -1), std::pair(change.to, 1)}) {
      if (!place) continue;
      const std::size_t source = placed_[change.instance].prototype;
      Bounds seen;
      for (const std::size_t p : standing) {
        const Bounds met = reached(prototypes_[p].cells);
        seen.include(Bounds{-met.high, -met.low});
      }
      for (std::size_t axis = 0; axis < axes + lights_.size(); ++axis) {
        const auto& tree = prototypes_[source].axes[axis];
        if (axis >= axes && graph_.stale(light_axes_, member(source, axis - axes))) {
          // It is not known yet what the tree does along the light, nor needed now.
          for (std::size_t i = 0; i < placed_.size(); ++i) graph_.touch(light_depths_, member(i, axis - axes));
          continue;
        }
        if (!tree) continue;  // come and gone since its kind first stood
        index_.along(*place, seen, tree->axes().along, [&](std::uint32_t instance, const glm::vec3& displacement) {
          if (isFresh(instance, axis)) parts.push_back({instance, axis, source, -displacement, times});
        });
      }
    }
  changes_.clear();
  if (parts.empty()) return;

  const Stopwatch watch(graph_.cost(sample_depths_).seconds);
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return std::tie(a.instance, a.axis) < std::tie(b.instance, b.axis); });
  std::vector<std::size_t> first{0};  // of the parts of each instance
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].instance != parts[i - 1].instance) first.push_back(i);
  first.push_back(parts.size());
  struct Found {
    std::vector<char> by_samples;                         // cells whose depths changed along any sample axis
    std::array<std::vector<char>, kMostLights> by_light;  // along each light
    std::vector<std::size_t> lost;                        // axes whose sums cannot be told from the stored ones
    std::size_t adjusted = 0;
  };
  std::vector<Found> found(first.size() - 1);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t group) {
    Placed& placed = placed_[parts[first[group]].instance];
    const Prototype& receiver = prototypes_[placed.prototype];
    const std::size_t cells = receiver.cells.active.size();
    std::vector<std::int32_t> beyond(cells), before(cells);
    for (std::size_t i = first[group]; i < first[group + 1];) {
      const std::size_t axis = parts[i].axis;
      std::fill(beyond.begin(), beyond.end(), 0);
      std::fill(before.begin(), before.end(), 0);
      for (; i < first[group + 1] && parts[i].axis == axis; ++i) {
        const Prototype& source = prototypes_[parts[i].source];
        source.axes[axis]->addTo(source.cells, *receiver.axes[axis], receiver.cells, placed.prototype,
                                 parts[i].displacement, parts[i].times, beyond, before);
      }
      std::vector<char>& changed = axis < axes ? found[group].by_samples : found[group].by_light[axis - axes];
      changed.resize(cells, 0);
      for (const bool is_before : {false, true}) {
        const std::span<FixedDepth> sums = row(placed, axis, is_before);
        const std::span<const std::int32_t> added = is_before ? before : beyond;
        for (std::size_t cell = 0; cell < cells; ++cell) {
          if (added[cell] == 0) continue;
          if (sums[cell] == kDeepest && (found[group].lost.empty() || found[group].lost.back() != axis))
            found[group].lost.push_back(axis);
          sums[cell] = fixedDepth(static_cast<std::uint32_t>(std::max(0, std::int32_t{sums[cell]} + added[cell])));
          changed[cell] = 1;
        }
      }
      ++found[group].adjusted;
    }
  });

  for (std::size_t group = 0; group < found.size(); ++group) {
    const std::size_t instance = parts[first[group]].instance;
    graph_.cost(sample_depths_).adjusted += found[group].adjusted;
    const auto pass = [&](ProductGraph::Product product, std::size_t of_product, std::size_t consumer,
                          const std::vector<char>& cells) {
      if (std::find(cells.begin(), cells.end(), 1) == cells.end()) return;
      std::vector<char>& changed = placed_[instance].changed[consumer];
      if (graph_.stale(product, of_product)) {
        if (changed.empty()) return;  // all cells are due already
      } else {
        changed.assign(cells.size(), 0);
        graph_.touch(product, of_product);
      }
      for (std::size_t cell = 0; cell < cells.size(); ++cell) changed[cell] |= cells[cell];
    };
    pass(sky_light_, instance, kMostLights, found[group].by_samples);
    for (std::size_t light = 0; light < lights_.size(); ++light) {
      pass(compensation_, member(instance, light), light, found[group].by_samples);
      pass(compensation_, member(instance, light), light, found[group].by_light[light]);
    }
    for (const std::size_t axis : found[group].lost)
      if (axis < axes)
        graph_.touch(sample_depths_, instance * axes + axis);
      else
        graph_.touch(light_depths_, member(instance, axis - axes));
  }
}

}  // namespace sunfleck
