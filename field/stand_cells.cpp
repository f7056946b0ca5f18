#include "field/stand_cells.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "core/shared_progress.hpp"

namespace sunfleck {
namespace {

constexpr double kMostCells = 1e9;

SweepGrid gridOf(const Bounds& box, float side, const std::optional<glm::vec2>& period) {
  SweepGrid grid{.side = glm::vec3(side), .periodic = period.has_value()};
  const glm::vec3 extent = glm::max(box.size(), glm::vec3(1e-6f));
  glm::dvec3 count = glm::max(glm::ceil(glm::dvec3(extent / side) - 1e-4), 1.);
  grid.low = box.centre() - 0.5f * side * glm::vec3(count);
  // The ground and what is highest lie on faces of cells.
  grid.low.z = box.low.z;
  grid.side.z = extent.z / static_cast<float>(count.z);
  if (period)
    for (int a = 0; a < 2; ++a) {
      count[a] = std::max(std::round(double{(*period)[a] / side}), 1.);
      grid.side[a] = (*period)[a] / static_cast<float>(count[a]);
      grid.low[a] = box.centre()[a] - 0.5f * (*period)[a];
    }
  const double cells = count.x * count.y * count.z;
  require(cells <= kMostCells && 5. * cells <= availableMemory(), "cells of the field", cells,
          "few enough for memory, 5 bytes each; trees nearer to each other");
  grid.size = glm::ivec3(count);
  return grid;
}

std::uint32_t kindOfElement(std::uint32_t kind, std::uint8_t wood) {
  return 2 * kind + wood;
}

// What of a tree is in a cell, of one kind of element.
struct Part {
  std::uint32_t slot, material;
  std::uint8_t axis;
  float area;
  glm::vec3 normal;  // times the area

  auto key() const { return std::tuple(slot, material, axis); }
};

}  // namespace

TurnedClusters turnedClusters(const LeafClusters& clusters, float rotation) {
  const float cosine = std::cos(rotation), sine = std::sin(rotation);
  const auto turn = [&](const glm::vec3& v) {
    return glm::vec3(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z);
  };
  TurnedClusters turned{.clusters = &clusters, .centre = {}, .normal = {}, .facing = {}};
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    turned.centre.push_back(turn(clusters.centre[i]));
    const glm::vec3 normal = turn(clusters.normal[i]);
    turned.facing.push_back(facingOf(normal));
    turned.normal.push_back(turned.facing.back().against ? -normal : normal);
  }
  return turned;
}

glm::ivec3 cellAt(const SweepGrid& grid, const glm::vec3& point) {
  glm::ivec3 cell(glm::floor((point - grid.low) / grid.side));
  for (int a = 0; a < 3; ++a)
    if (a == 2 || !grid.periodic) cell[a] = std::clamp(cell[a], 0, grid.size[a] - 1);
  return cell;
}

std::uint32_t cellNumber(const SweepGrid& grid, glm::ivec3 cell) {
  if (grid.periodic)
    for (int a = 0; a < 2; ++a) cell[a] = (cell[a] % grid.size[a] + grid.size[a]) % grid.size[a];
  return static_cast<std::uint32_t>((cell.z * grid.size.y + cell.y) * grid.size.x + cell.x);
}

// (F28)
StandMedium standMedium(std::span<const ClusteredTree> trees, const Bounds& box, float side,
                        const std::optional<glm::vec2>& period, const Progress& progress) {
  StandMedium made;
  SharedProgress trees_done(progress, 2. * static_cast<double>(trees.size()));
  CellMedium& medium = made.cells;
  SweepGrid& grid = medium.grid;
  grid = gridOf(box, side, period);
  std::vector<std::uint8_t> taken(grid.count());
  const auto cellOf = [&](const ClusteredTree& tree, std::size_t cluster) {
    return cellNumber(grid, cellAt(grid, tree.position + tree.turned->centre[cluster]));
  };
  tbb::parallel_for(std::size_t{0}, trees.size(), [&](std::size_t tree) {
    for (std::size_t i = 0; i < trees[tree].turned->centre.size(); ++i)
      std::atomic_ref(taken[cellOf(trees[tree], i)]).store(1, std::memory_order_relaxed);
    trees_done.add();
  });
  grid.slot.assign(grid.count(), SweepGrid::kEmpty);
  for (std::uint32_t cell = 0; cell < grid.slot.size(); ++cell)
    if (taken[cell]) {
      grid.slot[cell] = static_cast<std::uint32_t>(grid.cells.size());
      grid.cells.push_back(cell);
    }

  std::vector<std::vector<Part>> of_trees(trees.size());
  tbb::parallel_for(std::size_t{0}, trees.size(), [&](std::size_t number) {
    const ClusteredTree& tree = trees[number];
    const TurnedClusters& turned = *tree.turned;
    std::vector<Part> parts;
    for (std::size_t i = 0; i < turned.centre.size(); ++i) {
      const float area = turned.clusters->area[i];
      parts.push_back({grid.slot[cellOf(tree, i)], kindOfElement(tree.kind, turned.clusters->wood[i]),
                       turned.facing[i].axis, area, area * turned.normal[i]});
    }
    std::ranges::stable_sort(parts, {}, &Part::key);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (kept > 0 && parts[kept - 1].key() == parts[i].key()) {
        parts[kept - 1].area += parts[i].area;
        parts[kept - 1].normal += parts[i].normal;
      } else {
        parts[kept++] = parts[i];
      }
    of_trees[number].assign(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(kept));
    trees_done.add();
  });
  // By cells, those of a cell in the order of the trees; then, those of a cell, by what they are.
  constexpr std::size_t kAsk = 64;  // trees, and cells times as many, after which it is asked whether to go on
  std::vector<std::uint32_t> first(grid.cells.size() + 1), next;
  for (const auto& of_tree : of_trees)
    for (const Part& part : of_tree) ++first[part.slot + 1];
  for (std::size_t slot = 0; slot < grid.cells.size(); ++slot) first[slot + 1] += first[slot];
  next.assign(first.begin(), first.end() - 1);
  std::vector<Part> parts(first.back());
  for (std::size_t tree = 0; tree < of_trees.size(); ++tree) {
    if (tree % kAsk == 0) trees_done.ask();
    for (const Part& part : of_trees[tree]) parts[next[part.slot]++] = part;
    of_trees[tree] = {};
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.cells.size(), kAsk), [&](const auto& range) {
    for (std::size_t slot = range.begin(); slot < range.end(); ++slot)
      std::ranges::stable_sort(std::span(parts).subspan(first[slot], first[slot + 1] - first[slot]), {}, &Part::key);
    trees_done.ask();
  });
  medium.first_piece.assign(grid.cells.size() + 1, 0);
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    const Part& of_all = parts[begin];
    if (of_all.slot % (kAsk * kAsk) == 0) trees_done.ask();
    double area = 0.;
    glm::dvec3 normal(0.);
    for (; end < parts.size() && parts[end].key() == of_all.key(); ++end) {
      area += double{parts[end].area};
      normal += glm::dvec3(parts[end].normal);
    }
    medium.pieces.push_back({static_cast<std::uint32_t>(medium.area.size()), static_cast<float>(area)});
    medium.area.push_back(static_cast<float>(area));
    medium.normal.emplace_back(glm::normalize(normal));
    medium.material.push_back(of_all.material);
    made.axis.push_back(of_all.axis);
    ++medium.first_piece[of_all.slot + 1];
  }
  for (std::size_t slot = 0; slot < grid.cells.size(); ++slot) medium.first_piece[slot + 1] += medium.first_piece[slot];
  const auto elements = static_cast<std::uint32_t>(medium.area.size());
  for (std::uint32_t i = 0; i < elements; ++i) {
    medium.of_element.push_back(i);
    medium.first_of.push_back(i);
  }
  medium.first_of.push_back(elements);
  medium.first_element = {0, elements};
  return made;
}

std::vector<std::uint32_t> elementSides(const StandMedium& medium, const CellMedium& cells, const ClusteredTree& tree) {
  const TurnedClusters& turned = *tree.turned;
  std::vector<std::uint32_t> sides(turned.centre.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::uint32_t slot =
        cells.grid.slot[cellNumber(cells.grid, cellAt(cells.grid, tree.position + turned.centre[i]))];
    const std::uint32_t material = kindOfElement(tree.kind, turned.clusters->wood[i]);
    std::uint32_t element = cells.first_piece[slot];
    while (cells.material[element] != material || medium.axis[element] != turned.facing[i].axis) ++element;
    sides[i] = 2 * element + (turned.facing[i].against ? 1 : 0);
  }
  return sides;
}

}  // namespace sunfleck
