#include "field/large_stand.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
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
  lighting_.reset();
  cells_stale_ = true;
}

void LargeStandField::makeKinds() {
  const Stopwatch watch(costs_[detail::kKinds].seconds);
  kinds_.resize(meshes_.size());
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (std::ranges::none_of(stand_.trees, [&](const Placement& tree) { return tree.kind == i; })) {
      kinds_[i] = nullptr;
      continue;
    }
    if (kinds_[i]) continue;
    Kind& kind = *(kinds_[i] = std::make_unique<Kind>());
    ++costs_[detail::kKinds].made;
    kind.elements = fieldElements(*meshes_[i], effort_.elements);
    kind.exchange = lineExchange(*meshes_[i], kind.elements, std::nullopt, effort_.exchange);
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
    kind.escape = outside / std::max(from_leaves, 1.);
    kind.box = bounds(*meshes_[i]);
  }
  turns_.clear();
  turn_of_tree_.clear();
  std::map<std::pair<std::uint32_t, float>, std::size_t> known;
  for (const Placement& tree : stand_.trees) {
    const auto [place, is_new] = known.try_emplace({tree.kind, tree.rotation}, turns_.size());
    if (is_new) {
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

void LargeStandField::makeCells() {
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
    double taken = 0.;
    for (std::size_t i = 0; i < kinds_.size(); ++i)
      if (kinds_[i]) taken += count[i] * static_cast<double>(cellsTaken(kinds_[i]->elements, side));
    const glm::dvec3 cells = glm::ceil(extent / double{side});
    constexpr double empty_per_taken = 32., few = 1e6;
    if (taken <= effort_.most_cells && cells.x * cells.y * cells.z <= std::max(few, empty_per_taken * taken)) break;
  }
  stats_.cell_side = side;
  stats_.clumping.assign(kinds_.size(), 1.f);
  tbb::parallel_for(std::size_t{0}, kinds_.size(), [&](std::size_t i) {
    if (!kinds_[i]) return;
    Kind& kind = *kinds_[i];
    kind.clusters = leafClusters(kind.elements, kClusterShare * side);
    kind.groups = clusterGroups(kind.clusters, kFarGroup);
    kind.group_side.clear();
    for (const std::uint32_t of_cluster : kind.clusters.of_side)
      kind.group_side.push_back(2 * kind.groups.of_cluster[of_cluster / 2] + of_cluster % 2);
    stats_.clumping[i] = clumpingByEscape(turnedClusters(kind.clusters, 0.f), kind.box, side, kind.escape);
  });
  trees_.clear();
  tbb::parallel_for(std::size_t{0}, turns_.size(), [&](std::size_t i) {
    turns_[i]->clusters = turnedClusters(kinds_[turns_[i]->kind]->clusters, turns_[i]->rotation);
  });
  for (std::size_t i = 0; i < stand_.trees.size(); ++i)
    trees_.push_back({&turns_[turn_of_tree_[i]]->clusters, stand_.trees[i].position, stand_.trees[i].kind});
  cells_.reset();
  medium_ = standMedium(trees_, box, side, stand_.period);
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
    light += 4. * bands * sides;
  }
  bytes += std::min(light, detail::kLargeStandLight);
  if (cells_) {
    bytes += cells_->memoryBytes(1);
    for (const std::size_t tree : far)
      bytes += 2. * sizeof(glm::vec3) * static_cast<double>(kinds_[stand_.trees[tree].kind]->groups.count);
    for (const auto& kind : kinds_)
      if (kind) bytes += static_cast<double>(kind->exchange.memoryBytes() + 4 * kind->outside.side.size());
  }
  stats_.memory = bytes;
  const double most = std::min(effort_.most_memory, availableMemory());
  require(bytes <= most, fmt::format("light field of {} trees in view: memory [MB]", seen.size() + far.size()),
          std::ceil(1e-6 * bytes), fmt::format("at most {:.0f}: fewer trees in view", 1e-6 * most));
}

const FieldResult& LargeStandField::solve(const FieldLighting& lighting, std::span<const std::size_t> seen,
                                          std::span<const std::size_t> far) {
  require(!meshes_.empty(), "number of trees", 0, "at least 1: setStand first");
  requireFieldLighting(lighting, meshes_.size());
  if (cells_stale_) {
    cells_.reset();
    requireMemory(lighting, seen, far);  // as far as it is known before there are elements
    makeKinds();
    makeCells();
    cells_stale_ = false;
    lighting_.reset();
  }
  const bool same_light = lighting_ && lighting_->suns == lighting.suns && lighting_->sky == lighting.sky &&
                          lighting_->kinds == lighting.kinds && lighting_->ground_albedo == lighting.ground_albedo;
  if (same_light && std::ranges::equal(seen, seen_) && std::ranges::equal(far, far_)) return result_;
  lighting_ = lighting;
  seen_.assign(seen.begin(), seen.end());
  far_.assign(far.begin(), far.end());
  try {
    requireMemory(lighting, seen, far);
    result_ = {};
    result_.trees.resize(stand_.trees.size());
    makeSuns(seen);
    solveCells();
    solveTrees(seen);
    tellFar(far);
  } catch (...) {
    lighting_.reset();
    throw;
  }
  return result_;
}

}  // namespace sunfleck
