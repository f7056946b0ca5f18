#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <sstream>
#include <utility>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "core/stand.hpp"
#include "grid/foliage_stand.hpp"
#include "grid/neighbours.hpp"
#include "spp/compensation.hpp"
#include "spp/slab.hpp"
#include "spp/slab_arrays.hpp"

// How products are brought up to date, and made.
namespace sunfleck {
namespace {

constexpr float kMu0 = 1.f;          // the slab's normal is the light's axis
constexpr std::size_t kBlock = 512;  // cells computed at once: few enough for the nearest cache

}  // namespace

const CellGrid& FoliageStand::cells(std::size_t prototype) {
  graph_.bring(cells_, std::span(&prototype, 1), [&](std::size_t p) {
    const CellGrid& made = prototypes_[p].cells = cellGrid(*prototypes_[p].mesh, effort_.cells);
    graph_.cost(cells_).skipped += made.count() - made.active.size();
  });
  return prototypes_[prototype].cells;
}

const DeepOpacityMap& FoliageStand::lightMap(std::size_t prototype, std::size_t light) {
  cells(prototype);  // else it would be up to date before what it follows, and not notice the next change
  assert(light < lights_.size());
  const std::size_t one = member(prototype, light);
  graph_.bring(light_maps_, std::span(&one, 1), [&](std::size_t) {
    const auto& mesh = prototypes_[prototype].mesh;
    auto& map = prototypes_[prototype].light_maps[light];
    if (effort_.light_map)
      map.emplace(effort_.light_map(mesh, lights_[light], effort_.light_resolution));
    else
      map.emplace(*mesh, lights_[light], effort_.light_resolution);
  });
  return *prototypes_[prototype].light_maps[light];
}

// What the depths will take, about: rows of sums for each instance, what is known of each kind along each axis as seen
// from all, and the index with its copies.
void FoliageStand::requireMemory(std::span<const std::size_t> instances, std::span<const std::size_t> standing) const {
  const double axes = static_cast<double>(effort_.axes.size() + lights_.size());
  double bytes = 0., kinds = 0.;
  glm::ivec2 around(0);
  for (const std::size_t p : standing) {
    const CellGrid& cells = prototypes_[p].cells;
    const double side = static_cast<double>(std::max({cells.size.x, cells.size.y, cells.size.z}));
    const double parts = 8. * (cells.size.x + 2.) * (cells.size.y + 2.) * (cells.size.z + 2.);
    bytes += axes * 12. * parts;                                                         // while they are made
    kinds += axes * (parts + std::pow(14. * side + 20., 2.)) * 2. * sizeof(FixedDepth);  // a picture is seen obliquely
    around = glm::max(around, periodsAround({.period = period_}, cells.leaves));
  }
  bytes += kinds * static_cast<double>(prototypes_.size());
  for (const std::size_t i : instances)
    bytes += (2. * axes * sizeof(FixedDepth) + 32.) *
             static_cast<double>(prototypes_[placed_[i].prototype].cells.active.size());
  bytes += 64. * static_cast<double>(placed_.size()) * (2. * around.x + 1.) * (2. * around.y + 1.);
  if (const double most = availableMemory(); bytes > most) {
    std::ostringstream text;
    text.precision(3);
    text << "cells, sample directions and trees: would take " << bytes * 1e-9 << " GB: must be at most the "
         << most * 1e-9 << " GB there are";
    throw InvalidInput(text.str());
  }
}

// Prototypes first, then what their copies need of them.
void FoliageStand::prepareDepths(std::span<const std::size_t> instances, bool with_lights, const Progress& progress) {
  const std::size_t axes = effort_.axes.size();
  const std::vector<std::size_t> standing = standingPrototypes();
  for (const std::size_t p : standing) {
    const float cell_size = cells(p).cell_size;
    if (std::exchange(seen_from_[p], cell_size) == cell_size) continue;
    graph_.touchAll(sample_axes_);
    graph_.touchAll(light_axes_);
  }
  requireMemory(instances, standing);
  constexpr auto wood = DeepOpacityMap::Wood::first_and_last;
  std::vector<std::size_t> members;
  for (const std::size_t p : standing)
    for (std::size_t axis = 0; axis < axes; ++axis) members.push_back(p * axes + axis);
  graph_.bring(
      sample_axes_, members,
      [&](std::size_t i) {
        Prototype& p = prototypes_[i / axes];
        p.axes[i % axes].emplace(
            p.cells, DeepOpacityMap(*p.mesh, effort_.axes[i % axes], effort_.sample_resolution, wood), seen_from_);
      },
      progress);
  if (with_lights) {
    for (const std::size_t p : standing)
      for (std::size_t light = 0; light < lights_.size(); ++light) lightMap(p, light);
    graph_.bring(light_axes_, ofLights(standing), [&](std::size_t i) {
      Prototype& p = prototypes_[i / kMostLights];
      p.axes[axes + i % kMostLights].emplace(p.cells, *p.light_maps[i % kMostLights], seen_from_);
    });
  }

  applyChanges(standing);
  for (const std::size_t i : instances) {
    Placed& placed = placed_[i];
    placed.depths.resize(2 * (axes + lights_.size()) * prototypes_[placed.prototype].cells.active.size());
  }
  members.clear();
  for (const std::size_t i : instances)
    for (std::size_t axis = 0; axis < axes; ++axis) members.push_back(i * axes + axis);
  graph_.bring(
      sample_depths_, members, [&](std::size_t i) { makeDepths(i / axes, i % axes); }, progress);
  if (with_lights)
    graph_.bring(
        light_depths_, ofLights(instances), [&](std::size_t i) { makeDepths(i / kMostLights, axes + i % kMostLights); },
        progress);
}

void FoliageStand::prepareCompensation(std::span<const std::size_t> instances, const Progress& progress) {
  const std::vector<std::size_t> those = present(instances);
  prepareDepths(those, true, progress);
  unlit_ = 0;
  graph_.bring(
      compensation_, ofLights(those), [&](std::size_t i) { makeCompensation(i / kMostLights, i % kMostLights); },
      progress);
  graph_.cost(compensation_).skipped += unlit_;
}

void FoliageStand::prepareSkyLight(std::span<const std::size_t> instances, const Progress& progress) {
  const std::vector<std::size_t> those = present(instances);
  prepareDepths(those, false, progress);
  graph_.bring(
      sky_light_, those, [&](std::size_t i) { makeEnvironment(i, 0, sky_); }, progress);
}

void FoliageStand::prepareGroundLight(std::span<const std::size_t> instances, const Progress& progress) {
  const std::vector<std::size_t> those = present(instances);
  prepareDepths(those, false, progress);
  graph_.bring(
      ground_light_, those, [&](std::size_t i) { makeEnvironment(i, 1, below_); }, progress);
}

// (D4) The tree itself and all that its cells meet along the axis.
void FoliageStand::makeDepths(std::size_t instance, std::size_t axis) {
  Placed& placed = placed_[instance];
  const Prototype& receiver = prototypes_[placed.prototype];
  const TreeDepths& own = *receiver.axes[axis];
  std::vector<std::int32_t> beyond, before;
  for (const std::uint32_t cell : receiver.cells.active) {
    beyond.push_back(own.beyond()[cell]);
    before.push_back(own.before()[cell]);
  }
  std::size_t met = 0;
  index_.along(positions_[instance], reached(receiver.cells), own.axes().along,
               [&](std::uint32_t tree, const glm::vec3& displacement) {
                 if (tree == instance && displacement == glm::vec3(0.f)) return;
                 if (++met % kMostSummed == 0)
                   for (auto* sums : {&beyond, &before})
                     for (std::int32_t& sum : *sums) sum = std::min(sum, std::int32_t{kDeepest});
                 const Prototype& source = prototypes_[placed_[tree].prototype];
                 source.axes[axis]->addTo(source.cells, own, receiver.cells, placed.prototype, displacement, 1, beyond,
                                          before);
               });
  for (std::size_t cell = 0; cell < beyond.size(); ++cell) {
    row(placed, axis, false)[cell] = fixedDepth(static_cast<std::uint32_t>(beyond[cell]));
    row(placed, axis, true)[cell] = fixedDepth(static_cast<std::uint32_t>(before[cell]));
  }
}

namespace {

// Calls work(slots) for blocks of those cells that are due: all of `count` where `changed` is empty.
template <typename Work>
void forDueCells(std::size_t count, const std::vector<char>& changed, const Work& work) {
  std::vector<std::uint32_t> block;
  block.reserve(kBlock);
  for (std::uint32_t cell = 0; cell < count; ++cell) {
    if (changed.empty() || changed[cell]) block.push_back(cell);
    if (block.size() == kBlock || (cell + 1 == count && !block.empty())) {
      work(std::span<const std::uint32_t>(block));
      block.clear();
    }
  }
}

void gather(std::span<const FixedDepth> row, std::span<const std::uint32_t> cells, float* to) {
  const std::size_t first = cells.empty() ? 0 : cells.front();
  if (!cells.empty() && cells.back() - first + 1 == cells.size())  // as most are: in vectors
    for (std::size_t i = 0; i < cells.size(); ++i) to[i] = depthOf(row[first + i]);
  else
    for (std::size_t i = 0; i < cells.size(); ++i) to[i] = depthOf(row[cells[i]]);
}

}  // namespace

// (D5) Cells that no light of the source reaches need no G.
void FoliageStand::makeCompensation(std::size_t instance, std::size_t light) {
  Placed& placed = placed_[instance];
  const std::size_t count = prototypes_[placed.prototype].cells.active.size();
  std::vector<float>& compensation = placed.compensation[light];
  compensation.resize(count, 0.f);
  std::vector<float> cosines;  // of the sample directions to the direction back to the light
  for (const Direction& direction : sampleDirections()) cosines.push_back(-glm::dot(direction, lights_[light]));
  std::vector<float> edges(cosines.size() * kBlock), depth(kBlock), thickness(kBlock), found(kBlock);
  std::vector<std::uint32_t> lit;
  forDueCells(count, placed.changed[light], [&](std::span<const std::uint32_t> due) {
    lit.clear();
    for (const std::uint32_t cell : due)
      if (lightDepths(instance, light)[cell] < kDeepest)
        lit.push_back(cell);
      else
        compensation[cell] = 0.f;
    unlit_ += due.size() - lit.size();
    const std::span<const std::uint32_t> cells = lit;
    const std::size_t n = cells.size();
    for (std::size_t j = 0; j < cosines.size(); ++j) gather(depths(instance, j), cells, &edges[j * n]);
    gather(lightDepths(instance, light), cells, depth.data());
    gather(depthsBeyond(instance, light), cells, thickness.data());
    for (std::size_t i = 0; i < n; ++i) thickness[i] += depth[i];
    spp::compensation(cosines, std::span(edges).first(cosines.size() * n), std::span(depth).first(n),
                      std::span(thickness).first(n), kMu0, std::span(found).first(n));
    for (std::size_t i = 0; i < n; ++i) compensation[cells[i]] = found[i];
  });
  placed.changed[light].clear();
}

// (D10) Each axis is the normal of a slab, lit on both faces by what shines there; (D13) where the tree's own wood does
// not hide it.
void FoliageStand::makeEnvironment(std::size_t instance, std::size_t which, std::span<const glm::vec3> radiance) {
  Placed& placed = placed_[instance];
  const Prototype& prototype = prototypes_[placed.prototype];
  const std::size_t count = prototype.cells.active.size();
  std::vector<glm::vec3>& light = placed.environment[which];
  light.resize(count, glm::vec3(0.f));
  const float weight = 1.f / static_cast<float>(radiance.size());
  std::vector<float> depth(kBlock), thickness(kBlock), down(kBlock), up(kBlock), open(kBlock);
  std::array<std::vector<float>, kBands> sum;
  forDueCells(count, placed.changed[kMostLights + which], [&](std::span<const std::uint32_t> cells) {
    const std::size_t n = cells.size();
    for (std::vector<float>& of_band : sum) of_band.assign(n, 0.f);
    for (std::size_t j = 0; j < radiance.size(); ++j) {
      if (radiance[j] == glm::vec3(0.f)) continue;
      const TreeDepths& own = *prototype.axes[j / 2];
      const std::span<const float> share = j % 2 == 0 ? own.openBeyond() : own.openBefore();
      for (std::size_t i = 0; i < n; ++i) open[i] = weight * share[prototype.cells.active[cells[i]]];
      gather(depths(instance, j), cells, depth.data());
      gather(depths(instance, j ^ 1), cells, thickness.data());
      for (std::size_t i = 0; i < n; ++i) thickness[i] += depth[i];
      for (std::size_t band = 0; band < kBands; ++band) {
        const LeafOptics& leaf = prototype.leaf[band];
        if (band == 0 || !(leaf == prototype.leaf[band - 1]))
          spp::sppPowers(std::span(depth).first(n), std::span(thickness).first(n), kMu0, leaf.albedo(),
                         spp::sphericalLeafForwardShare(leaf.reflectance, leaf.transmittance), std::span(down).first(n),
                         std::span(up).first(n));
        const float from = radiance[j][static_cast<int>(band)];
        for (std::size_t i = 0; i < n; ++i) sum[band][i] += from * open[i] * (down[i] + up[i]);
      }
    }
    for (std::size_t i = 0; i < n; ++i) light[cells[i]] = {sum[0][i], sum[1][i], sum[2][i]};
  });
  placed.changed[kMostLights + which].clear();
}

}  // namespace sunfleck
