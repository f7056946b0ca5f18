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

// The leaves of any prototype less the cells' centres, and as far beyond as pictures are blurred by the cells they are
// seen from or by their own.
Bounds FoliageStand::reached(const CellGrid& receiver) const {
  Bounds box;
  for (const Prototype& p : prototypes_) {
    if (p.cells.leaves.empty()) continue;  // it has never stood
    const glm::vec3 beyond(2.f * std::max(p.cells.cell_size, receiver.cell_size));
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
  graph_.touchAll(ground_);
}

void FoliageStand::touchDepths(std::size_t instance, std::size_t axis) {
  if (axis < effort_.axes.size())
    graph_.touch(sample_depths_, instance * effort_.axes.size() + axis);
  else
    graph_.touch(light_depths_, member(instance, axis - effort_.axes.size()));
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
  try {
    index_ = StandIndex(positions_, std::max(width, 1e-6f), period_, around);
    around_ = around;
    index_stale_ = false;
    const std::vector<Part> parts = changedParts(standing);
    changes_.clear();
    const auto of_lights = std::partition_point(parts.begin(), parts.end(),
                                                [&](const Part& part) { return part.axis < effort_.axes.size(); });
    adjustSums(sample_depths_, {parts.begin(), of_lights});
    adjustSums(light_depths_, {of_lights, parts.end()});
  } catch (...) {  // out of memory, say: what is half done is not known
    touchDepths();
    throw;
  }
}

// Which sums up to date a moved tree is and was part of: the index tells it from where the tree stood and stands, on
// the same lines.
std::vector<FoliageStand::Part> FoliageStand::changedParts(std::span<const std::size_t> standing) {
  std::vector<Part> parts;
  const std::size_t axes = effort_.axes.size();
  Bounds seen;
  for (const std::size_t p : standing) {
    const Bounds met = reached(prototypes_[p].cells);
    seen.include(Bounds{-met.high, -met.low});
  }
  for (const Change& change : changes_)
    for (std::size_t axis = 0; axis < axes + lights_.size(); ++axis) {
      const std::size_t source = placed_[change.instance].prototype;
      if (axis >= axes && graph_.stale(light_axes_, member(source, axis - axes))) {
        // It is not known yet what the tree does along the light, nor needed now.
        for (std::size_t i = 0; i < placed_.size(); ++i) touchDepths(i, axis);
        continue;
      }
      // A kind that does not stand is not kept up to date: its trees have come and gone.
      if (axis < axes && graph_.stale(sample_axes_, source * axes + axis)) continue;
      const Direction& along = prototypes_[source].axes[axis]->axes().along;
      for (const auto& [place, times] : {std::pair(change.from, -1), std::pair(change.to, 1)})
        if (place)
          index_.along(*place, seen, along, [&](std::uint32_t instance, const glm::vec3& displacement) {
            const bool stale = axis < axes ? graph_.stale(sample_depths_, instance * axes + axis)
                                           : graph_.stale(light_depths_, member(instance, axis - axes));
            if (!stale) parts.push_back({instance, axis, source, -displacement, times});
          });
    }
  const auto order = [axes](const Part& part) { return std::tuple(part.axis >= axes, part.instance, part.axis); };
  std::sort(parts.begin(), parts.end(), [&](const Part& a, const Part& b) { return order(a) < order(b); });
  return parts;
}

void FoliageStand::adjustSums(ProductGraph::Product depths, std::span<const Part> parts) {
  if (parts.empty()) return;
  const Stopwatch watch(graph_.cost(depths).seconds);
  std::vector<std::size_t> first{0};  // of the parts of each instance
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].instance != parts[i - 1].instance) first.push_back(i);
  first.push_back(parts.size());
  std::vector<Adjusted> adjusted(first.size() - 1);
  tbb::parallel_for(std::size_t{0}, adjusted.size(), [&](std::size_t group) {
    adjusted[group] = adjust(parts.subspan(first[group], first[group + 1] - first[group]));
  });
  for (const Adjusted& of_instance : adjusted) passOn(of_instance);
}

// The sums of one instance.
FoliageStand::Adjusted FoliageStand::adjust(std::span<const Part> parts) {
  const std::size_t axes = effort_.axes.size();
  Adjusted result{.instance = parts.front().instance};
  Placed& placed = placed_[result.instance];
  const Prototype& receiver = prototypes_[placed.prototype];
  const std::size_t cells = receiver.cells.active.size();
  std::vector<std::int32_t> beyond(cells), before(cells);
  for (std::size_t i = 0; i < parts.size();) {
    const std::size_t axis = parts[i].axis;
    std::fill(beyond.begin(), beyond.end(), 0);
    std::fill(before.begin(), before.end(), 0);
    const std::size_t first_part = i;
    for (; i < parts.size() && i - first_part < kMostSummed && parts[i].axis == axis; ++i) {
      const Prototype& source = prototypes_[parts[i].source];
      source.axes[axis]->addTo(source.cells, *receiver.axes[axis], receiver.cells, placed.prototype,
                               parts[i].displacement, parts[i].times, beyond, before);
    }
    std::vector<char>& changed = axis < axes ? result.by_samples : result.by_light[axis - axes];
    changed.resize(cells, 0);
    bool lost = i - first_part == kMostSummed;  // the sum of the rest does not say how deep this is
    for (const bool is_before : {false, true}) {
      const std::span<FixedDepth> sums = row(placed, axis, is_before);
      const std::span<const std::int32_t> added = is_before ? before : beyond;
      for (std::size_t cell = 0; cell < cells; ++cell) {
        if (added[cell] == 0) continue;
        lost |= sums[cell] == kDeepest;
        sums[cell] = fixedDepth(static_cast<std::uint32_t>(std::max(0, std::int32_t{sums[cell]} + added[cell])));
        changed[cell] = 1;
      }
    }
    if (lost) result.lost.push_back(axis);
    ++(axis < axes ? result.sample_rows : result.light_rows);
  }
  return result;
}

// What rests on changed sums is stale in their cells.
void FoliageStand::passOn(const Adjusted& adjusted) {
  graph_.cost(sample_depths_).adjusted += adjusted.sample_rows;
  graph_.cost(light_depths_).adjusted += adjusted.light_rows;
  const auto pass = [&](ProductGraph::Product product, std::size_t of_product, std::size_t consumer,
                        const std::vector<char>& cells) {
    if (std::find(cells.begin(), cells.end(), 1) == cells.end()) return;
    std::vector<char>& changed = placed_[adjusted.instance].changed[consumer];
    if (graph_.stale(product, of_product)) {
      if (changed.empty()) return;  // all cells are due already
    } else {
      changed.assign(cells.size(), 0);
      graph_.touch(product, of_product);
    }
    for (std::size_t cell = 0; cell < cells.size(); ++cell) changed[cell] |= cells[cell];
  };
  pass(sky_light_, adjusted.instance, kMostLights, adjusted.by_samples);
  pass(ground_light_, adjusted.instance, kMostLights + 1, adjusted.by_samples);
  for (std::size_t light = 0; light < lights_.size(); ++light) {
    const std::size_t of_light = member(adjusted.instance, light);
    pass(compensation_, of_light, light, adjusted.by_samples);
    pass(compensation_, of_light, light, adjusted.by_light[light]);
  }
  for (const std::size_t axis : adjusted.lost) touchDepths(adjusted.instance, axis);
}

}  // namespace sunfleck
