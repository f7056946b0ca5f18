#include "field/large_stand.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <numeric>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "field/detail/large_stand_state.hpp"
#include "field/escape_clumping.hpp"
#include "field/near_return.hpp"

namespace sunfleck {
namespace {

constexpr float kClusterShare = 0.4f;  // side of the cells that gather clusters, in those of the stand [1]
constexpr int kFarGroup = 3;           // cells of clusters along that of a group of a far tree

}  // namespace

LargeStandField::LargeStandField(const LargeStandEffort& effort) : effort_(effort) {
  for (const char* name : {"kinds", "cells", "direct light", "solution on cells", "light at walls", "trees in view"})
    costs_.push_back({.name = name});
}
LargeStandField::~LargeStandField() = default;

std::vector<ProductCost> LargeStandField::costs() const {
  return costs_;
}

void LargeStandField::setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) {
  requireFieldStand(kinds, stand);
  const bool same_kinds = std::ranges::equal(kinds, meshes_);
  if (stand == stand_ && same_kinds) return;
  if (!same_kinds) kinds_.clear();
  meshes_.assign(kinds.begin(), kinds.end());
  stand_ = stand;
  made_ = kNothing;
}

void LargeStandField::makeKinds(const Progress& progress) {
  const Stopwatch watch(costs_[detail::kKinds].seconds);
  kinds_.resize(meshes_.size());
  double triangles = 0., done = 0.;  // of those that are to be made
  const auto stands = [&](std::size_t i) {
    return std::ranges::any_of(stand_.trees, [&](const Placement& tree) { return tree.kind == i; });
  };
  const auto size = [&](std::size_t i) {
    return static_cast<double>(meshes_[i]->leaf_triangles.size() + meshes_[i]->wood_triangles.size());
  };
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (!stands(i)) kinds_[i] = nullptr;
    if (stands(i) && !kinds_[i]) triangles += size(i);
  }
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (!stands(i) || kinds_[i]) continue;
    const double before = done / triangles;
    done += size(i);
    requireGoOn(progress, before);
    auto made = std::make_unique<Kind>();
    Kind& kind = *made;
    kind.elements = fieldElements(*meshes_[i], effort_.elements);
    kind.exchange = lineExchange(*meshes_[i], kind.elements, std::nullopt, effort_.exchange,
                                 partOf(progress, before, done / triangles));
    requireGoOn(progress, done / triangles);
    kind.outside = outsideLines(kind.exchange);
    double from_leaves = 0., outside = 0.;
    for (std::size_t e = 0; e < kind.elements.size(); ++e) {
      const bool wood = e >= kind.elements.leaf_elements;
      kind.materials.push_back(wood ? 1 : 0);
      kind.per_line.push_back(std::numbers::pi_v<float> / static_cast<float>(std::max(kind.exchange.lines[e], 1u)));
      from_leaves += (wood ? 1. : 2.) * kind.exchange.lines[e];
      for (std::size_t side = 2 * e; side < 2 * e + (wood ? 1 : 2); ++side)
        outside += static_cast<double>(kind.exchange.first_outside[side + 1] - kind.exchange.first_outside[side]);
    }
    kind.near_return = nearReturn(kind.elements, kind.exchange, kind.materials, 2);
    requireGoOn(progress, done / triangles);
    kind.escape = outside / std::max(from_leaves, 1.);
    kind.box = bounds(*meshes_[i]);
    kinds_[i] = std::move(made);
    ++costs_[detail::kKinds].made;
  }
}

void LargeStandField::makeTurns(const Progress& progress) {
  const Stopwatch watch(costs_[detail::kKinds].seconds);
  turns_.clear();
  turn_of_tree_.clear();
  std::map<std::pair<std::uint32_t, float>, std::size_t> known;
  for (const Placement& tree : stand_.trees) {
    const auto [place, is_new] = known.try_emplace({tree.kind, tree.rotation}, turns_.size());
    if (is_new) {
      requireGoOn(progress, static_cast<double>(turn_of_tree_.size()) / static_cast<double>(stand_.trees.size()));
      Turn& turn = *turns_.emplace_back(std::make_unique<Turn>());
      turn.kind = tree.kind;
      turn.rotation = tree.rotation;
      const TreeMesh& mesh = *meshes_[tree.kind];
      for (const auto* triangles : {&mesh.leaf_triangles, &mesh.wood_triangles})
        for (const glm::uvec3& t : *triangles)
          for (int corner = 0; corner < 3; ++corner)
            turn.box.include(detail::turnedBy(mesh.vertices[t[corner]], tree.rotation));
      const std::vector<Direction>& directions = kinds_[tree.kind]->exchange.directions;
      for (const Direction& direction : directions) {
        const glm::vec3 along = detail::turnedBy(direction, tree.rotation);
        // Of those that rise and those that come down each for itself: light of the sky comes down.
        const auto nearness = [&](const Direction& other) {
          return glm::dot(other, along) - (other.z * along.z < 0.f ? 4.f : 0.f);
        };
        turn.nearest.push_back(
            static_cast<std::uint32_t>(std::ranges::max_element(directions, {}, nearness) - directions.begin()));
      }
    }
    turn_of_tree_.push_back(place->second);
  }
}

void LargeStandField::makeCells(const Progress& progress) {
  const Stopwatch watch(costs_[detail::kCells].seconds);
  ++costs_[detail::kCells].made;
  std::vector<double> count(kinds_.size());
  for (const Placement& tree : stand_.trees) ++count[tree.kind];
  Bounds box;
  float smallest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < stand_.trees.size(); ++i) {
    const Bounds& of_tree = turns_[turn_of_tree_[i]]->box;
    box.include(of_tree.low + stand_.trees[i].position);
    box.include(of_tree.high + stand_.trees[i].position);
  }
  for (std::size_t i = 0; i < kinds_.size(); ++i)
    if (kinds_[i]) {
      const glm::vec3 size = leafBounds(*meshes_[i]).size();
      smallest = std::min(smallest, std::max({size.x, size.y, size.z, 1e-6f}));
    }
  // Larger cells where these would be too many, those in which nothing is as well.
  float side = smallest / static_cast<float>(effort_.cells_along);
  const glm::dvec3 extent =
      stand_.period ? glm::dvec3(glm::dvec2(*stand_.period), double{box.size().z}) : glm::dvec3(box.size());
  for (;; side *= 1.1f) {
    requireGoOn(progress, 0.);
    double taken = 0.;
    for (std::size_t i = 0; i < kinds_.size(); ++i)
      if (kinds_[i]) taken += count[i] * static_cast<double>(cellsTaken(kinds_[i]->elements, side));
    const glm::dvec3 cells = glm::ceil(extent / double{side});
    constexpr double empty_per_taken = 32., few = 1e6;
    if (taken <= effort_.most_cells && cells.x * cells.y * cells.z <= std::max(few, empty_per_taken * taken)) break;
  }
  stats_.cell_side = side;
  stats_.clumping.assign(kinds_.size(), 1.f);
  constexpr double kOfKinds = 0.4, kOfTurns = 0.5;  // how far these are
  const Progress of_kinds = partOf(progress, 0., kOfKinds), of_turns = partOf(progress, kOfKinds, kOfTurns),
                 of_trees = partOf(progress, kOfTurns, 1.);
  SharedProgress kinds_done(of_kinds, static_cast<double>(kinds_.size())),
      turns_done(of_turns, static_cast<double>(turns_.size()));
  tbb::parallel_for(std::size_t{0}, kinds_.size(), [&](std::size_t i) {
    if (!kinds_[i]) return;
    Kind& kind = *kinds_[i];
    kind.clusters = leafClusters(kind.elements, kClusterShare * side);
    kind.groups = clusterGroups(kind.clusters, kFarGroup);
    kind.group_side.clear();
    for (const std::uint32_t of_cluster : kind.clusters.of_side)
      kind.group_side.push_back(2 * kind.groups.of_cluster[of_cluster / 2] + of_cluster % 2);
    stats_.clumping[i] =
        clumpingByEscape(turnedClusters(kind.clusters, 0.f), kind.box, side, kind.escape, kinds_done.asking());
    kinds_done.add();
  });
  trees_.clear();
  tbb::parallel_for(std::size_t{0}, turns_.size(), [&](std::size_t i) {
    turns_[i]->clusters = turnedClusters(kinds_[turns_[i]->kind]->clusters, turns_[i]->rotation);
    turns_done.add();
  });
  for (std::size_t i = 0; i < stand_.trees.size(); ++i)
    trees_.push_back({&turns_[turn_of_tree_[i]]->clusters, stand_.trees[i].position, stand_.trees[i].kind});
  cells_.reset();
  medium_ = standMedium(trees_, box, side, stand_.period, of_trees);
  stats_.cells = medium_->cells.grid.cells.size();
  stats_.elements = medium_->cells.area.size();
  cells_.emplace(std::move(medium_->cells), stats_.clumping);
}

std::span<const std::uint32_t> LargeStandField::farSidesOf(std::uint32_t kind) const {
  return kinds_[kind] ? std::span<const std::uint32_t>(kinds_[kind]->group_side) : std::span<const std::uint32_t>();
}

const FieldElements& LargeStandField::elements(std::uint32_t kind) const {
  return kinds_[kind]->elements;
}

void LargeStandField::requireMemory(const FieldLighting& lighting, std::span<const std::size_t> seen,
                                    std::span<const std::size_t> far) {
  const auto bands = static_cast<double>(kBands), suns = static_cast<double>(lighting.suns.size());
  double bytes = 0., light = 0.;
  for (const std::size_t tree : seen) {
    const std::uint32_t kind = stand_.trees[tree].kind;
    const bool known = kind < kinds_.size() && kinds_[kind];
    const double sides =
        2. * static_cast<double>(known ? kinds_[kind]->elements.size() : std::size_t{meshes_[kind]->leaf_count});
    bytes += sizeof(LeafLight) * static_cast<double>(meshes_[kind]->leaf_count) + 4. * sides * suns;
    light += 8. * bands * sides;
  }
  bytes += std::min(light, detail::kLargeStandLight);
  const double pictures = pictureBytes(lighting);
  bytes += pictures;
  if (cells_) {
    bytes += cells_->memoryBytes(1);
    const double line_area = lineArea();
    for (const std::size_t tree : seen) {
      const glm::dvec3 size(kinds_[stand_.trees[tree].kind]->box.size());
      bytes += suns / 8. * (size.x * size.y + size.y * size.z + size.x * size.z) / line_area;
    }
    for (const std::size_t tree : far)
      bytes += 2. * sizeof(glm::vec3) * static_cast<double>(kinds_[stand_.trees[tree].kind]->groups.count);
    for (const auto& kind : kinds_)
      if (kind) bytes += static_cast<double>(kind->exchange.memoryBytes() + 4 * kind->outside.side.size());
  }
  stats_.memory = bytes;
  double held = 0.;  // of pictures, already
  for (const auto& turn : turns_) held += detail::kBytesOfPixel * static_cast<double>(turn->picture.side.size());
  const double most = std::min(effort_.most_memory, availableMemory() + held);
  require(bytes <= most, fmt::format("light field of {} trees in view: memory [MB]", seen.size() + far.size()),
          std::ceil(1e-6 * bytes),
          fmt::format("at most {:.0f}: fewer {}", 1e-6 * most,
                      pictures > 0.5 * bytes ? "rotations of trees that differ" : "trees in view"));
}

void LargeStandField::makeStep(Step step, std::span<const std::size_t> seen, std::span<const std::size_t> far,
                               const Progress& progress) {
  if (made_ >= step) return;
  requireGoOn(progress, 0.);
  switch (step) {
    case kNothing:
      return;
    case kKindsMade:
      cells_.reset();
      requireMemory(*lighting_, seen, far);  // as far as it is known before there are elements
      makeKinds(progress);
      break;
    case kCellsMade:
      makeTurns(partOf(progress, 0., 0.1));
      makeCells(partOf(progress, 0.1, 1.));
      break;
    case kSunsMade:
      requireMemory(*lighting_, seen, far);
      makeSuns(seen, progress);
      break;
    case kCellsSolved:
      solveCells(progress);
      break;
    case kTreesSolved:
      solveTrees(seen, progress);
      break;
    case kFarTold: {
      SharedProgress trees_done(progress, static_cast<double>(std::max<std::size_t>(far.size(), 1)));
      tellFar(far, trees_done);
      break;
    }
  }
  made_ = step;
}

const FieldResult& LargeStandField::solve(const FieldLighting& lighting, std::span<const std::size_t> seen,
                                          std::span<const std::size_t> far, const Progress& progress) {
  require(!meshes_.empty(), "number of trees", 0, "at least 1: setStand first");
  requireFieldLighting(lighting, meshes_.size());
  const bool same_light = lighting_ && lighting_->suns == lighting.suns && lighting_->sky == lighting.sky &&
                          lighting_->kinds == lighting.kinds && lighting_->ground_albedo == lighting.ground_albedo;
  if (!same_light || !std::ranges::equal(seen, seen_)) made_ = std::min(made_, kCellsMade);
  if (!std::ranges::equal(far, far_)) made_ = std::min(made_, kTreesSolved);
  if (made_ == kFarTold) return result_;
  if (made_ >= kCellsMade) requireMemory(lighting, seen, far);
  lighting_ = lighting;
  seen_.assign(seen.begin(), seen.end());
  far_.assign(far.begin(), far.end());

  // How far it is, by how long steps take [microseconds of a processor].
  const auto leavesOf = [&](const Placement& tree) { return static_cast<double>(meshes_[tree.kind]->leaf_count); };
  double of_kinds = 0., of_all = 0., of_seen = 0.;
  for (std::size_t i = 0; i < meshes_.size(); ++i)
    if (i >= kinds_.size() || !kinds_[i]) of_kinds += static_cast<double>(meshes_[i]->leaf_count);
  for (const Placement& tree : stand_.trees) of_all += leavesOf(tree);
  for (const std::size_t tree : seen) of_seen += leavesOf(stand_.trees[tree]);
  const std::array<std::pair<Step, double>, 6> steps{
      {{kKindsMade, 25. * of_kinds},
       {kCellsMade, 0.25 * of_all},
       {kSunsMade, 0.4 * of_all * static_cast<double>(lighting.suns.size())},
       {kCellsSolved, 0.4 * of_all},
       {kTreesSolved, 2.5 * of_seen},
       {kFarTold, 0.01 * of_all}}};
  double all = 0., done = 0.;
  for (const auto& [step, work] : steps)
    if (made_ < step) all += work;
  for (const auto& [step, work] : steps) {
    if (made_ >= step) continue;
    makeStep(step, seen, far, partOf(progress, done / all, (done + work) / all));
    done += work;
  }
  return result_;
}

}  // namespace sunfleck
