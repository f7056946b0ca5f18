#include "field/cell_medium.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <string>

#include "core/available_memory.hpp"
#include "core/finished_mesh.hpp"
#include "core/require.hpp"
#include "grid/triangle_clipping.hpp"

namespace sunfleck {
namespace {

constexpr double kMostCells = 2e9;

struct Turned {
  float cosine, sine;
  glm::vec3 operator()(const glm::vec3& v) const { return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z}; }
};

Turned turnOf(const Placement& placement) {
  return {std::cos(placement.rotation), std::sin(placement.rotation)};
}

struct PlacedPiece {
  std::uint32_t cell, element;
  double area;
};

void placeCells(SweepGrid& grid, std::span<const PlacedElements> trees, const CellRule& rule,
                const std::optional<glm::vec2>& period) {
  Bounds all;
  float side = std::numeric_limits<float>::infinity();
  for (const PlacedElements& tree : trees) {
    const Turned turn = turnOf(tree.placement);
    Bounds box;
    for (const glm::uvec3& t : tree.mesh->leaf_triangles)
      for (int corner = 0; corner < 3; ++corner)
        box.include(turn(tree.mesh->vertices[t[corner]]) + tree.placement.position);
    const glm::vec3 size = leafBounds(*tree.mesh).size();
    side = std::min(side, std::max({size.x, size.y, size.z, 1e-6f}) / static_cast<float>(rule.cells));
    all.include(box);
  }
  side = std::max(side, rule.least_side);
  grid.periodic = period.has_value();
  const glm::vec3 extent = all.size();
  glm::dvec3 count = glm::max(glm::ceil(glm::dvec3(extent / side) - 1e-4), 1.);
  grid.side = glm::vec3(side);
  grid.low = all.centre() - 0.5f * side * glm::vec3(count);
  if (rule.ground) {
    // The ground and the topmost leaf both lie on faces of cells.
    const float height = std::max(all.high.z - *rule.ground, side);
    count.z = std::max(std::round(double{height / side}), 1.);
    grid.side.z = height / static_cast<float>(count.z);
    grid.low.z = *rule.ground;
  }
  if (period)
    for (int axis = 0; axis < 2; ++axis) {
      count[axis] = std::max(std::round(double{(*period)[axis] / side}), 1.);
      grid.side[axis] = (*period)[axis] / static_cast<float>(count[axis]);
      grid.low[axis] = all.centre()[axis] - 0.5f * (*period)[axis];
    }
  const double cells = count.x * count.y * count.z;
  require(cells <= kMostCells && 4. * cells <= availableMemory(), "cells of the field", cells,
          "few enough for memory, 4 bytes each; larger cells or fewer trees");
  grid.size = glm::ivec3(count);
}

// Gives cells with pieces their slots, and sorts pieces by slots and by elements.
void fill(CellMedium& medium, std::span<const std::vector<PlacedPiece>> of_tree) {
  SweepGrid& grid = medium.grid;
  grid.slot.assign(grid.count(), SweepGrid::kEmpty);
  for (const auto& pieces : of_tree)
    for (const PlacedPiece& piece : pieces) grid.slot[piece.cell] = 0;
  for (std::uint32_t cell = 0; cell < grid.slot.size(); ++cell)
    if (grid.slot[cell] != SweepGrid::kEmpty) {
      grid.slot[cell] = static_cast<std::uint32_t>(grid.cells.size());
      grid.cells.push_back(cell);
    }
  medium.first_piece.assign(grid.cells.size() + 1, 0);
  medium.first_of.assign(medium.area.size() + 1, 0);
  for (const auto& pieces : of_tree)
    for (const PlacedPiece& piece : pieces) {
      ++medium.first_piece[grid.slot[piece.cell] + 1];
      ++medium.first_of[piece.element + 1];
    }
  for (std::size_t i = 1; i < medium.first_piece.size(); ++i) medium.first_piece[i] += medium.first_piece[i - 1];
  for (std::size_t i = 1; i < medium.first_of.size(); ++i) medium.first_of[i] += medium.first_of[i - 1];
  medium.pieces.resize(medium.first_piece.back());
  medium.of_element.resize(medium.first_of.back());
  std::vector<std::uint32_t> next(medium.first_piece), next_of(medium.first_of);
  for (const auto& pieces : of_tree)
    for (const PlacedPiece& piece : pieces) {
      const std::uint32_t place = next[grid.slot[piece.cell]]++;
      medium.pieces[place] = {piece.element, static_cast<float>(piece.area)};
      medium.of_element[next_of[piece.element]++] = place;
    }
}

}  // namespace

// (F15)
CellMedium cellMedium(std::span<const PlacedElements> trees, const CellRule& rule,
                      const std::optional<glm::vec2>& period) {
  require(!trees.empty(), "trees of the field", trees.size(), "at least 1");
  require(rule.cells >= 1 && rule.cells <= 256, "cells of the field", rule.cells, "1 to 256 along a tree");
  std::set<const TreeMesh*> known;
  for (std::size_t i = 0; i < trees.size(); ++i)
    if (known.insert(trees[i].mesh).second) requireFinished(*trees[i].mesh, "tree " + std::to_string(i + 1));
  CellMedium medium;
  SweepGrid& grid = medium.grid;
  placeCells(grid, trees, rule, period);

  medium.first_element.push_back(0);
  for (const PlacedElements& tree : trees) {
    const Turned turn = turnOf(tree.placement);
    const FieldElements& elements = *tree.elements;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const bool wood = i >= elements.leaf_elements;
      medium.normal.push_back(turn(elements.normal[i]));
      medium.area.push_back(wood ? 0.5f * elements.area[i] : elements.area[i]);
      medium.material.push_back(2 * tree.placement.kind + (wood ? 1 : 0));
    }
    medium.first_element.push_back(static_cast<std::uint32_t>(medium.area.size()));
  }

  // Pieces of each tree by the cells they lie in; beyond the box, where only wood can be, there is no medium.
  std::vector<std::vector<PlacedPiece>> of_tree(trees.size());
  tbb::parallel_for(std::size_t{0}, trees.size(), [&](std::size_t number) {
    const PlacedElements& tree = trees[number];
    const TreeMesh& mesh = *tree.mesh;
    const FieldElements& elements = *tree.elements;
    const Turned turn = turnOf(tree.placement);
    const auto placed = [&](const glm::vec3& v) {
      return (glm::dvec3(turn(v)) + glm::dvec3(tree.placement.position) - glm::dvec3(grid.low)) / glm::dvec3(grid.side);
    };
    std::vector<PlacedPiece>& pieces = of_tree[number];
    const auto add = [&](glm::ivec3 cell, std::uint32_t element, double area, bool inside) {
      for (int axis = 0; axis < 3; ++axis)
        if (grid.periodic && axis < 2)
          cell[axis] = (cell[axis] % grid.size[axis] + grid.size[axis]) % grid.size[axis];
        else if (inside)  // by rounding on the box's face
          cell[axis] = std::clamp(cell[axis], 0, grid.size[axis] - 1);
        else if (cell[axis] < 0 || cell[axis] >= grid.size[axis])
          return;
      pieces.push_back({static_cast<std::uint32_t>((cell.z * grid.size.y + cell.y) * grid.size.x + cell.x),
                        medium.first_element[number] + element, area});
    };
    std::vector<CellShare> shares;
    for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
      const glm::uvec3& t = mesh.leaf_triangles[i];
      const glm::dvec3 a = placed(mesh.vertices[t.x]), b = placed(mesh.vertices[t.y]), c = placed(mesh.vertices[t.z]);
      const double area = triangleArea(mesh, t);
      const glm::dvec3 low = glm::floor(glm::min(a, glm::min(b, c)));
      const std::uint32_t element = elements.of_leaf_triangle[i];
      if (low == glm::floor(glm::max(a, glm::max(b, c)))) {
        add(glm::ivec3(low), element, area, true);
        continue;
      }
      shares.clear();
      shareAmongCells(triangle(a, b, c), glm::cross(b - a, c - a), shares);
      double sum = 0.;
      for (const CellShare& share : shares) sum += share.area;
      if (sum > 0.)
        for (const CellShare& share : shares) add(share.cell, element, area * share.area / sum, true);
    }
    for (std::size_t i = elements.leaf_elements; i < elements.size(); ++i)
      add(glm::ivec3(glm::floor(placed(elements.centre[i]))), static_cast<std::uint32_t>(i),
          0.5 * double{elements.area[i]}, false);
    std::sort(pieces.begin(), pieces.end(), [](const PlacedPiece& p, const PlacedPiece& q) {
      return p.cell != q.cell ? p.cell < q.cell : p.element != q.element ? p.element < q.element : p.area < q.area;
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i)
      if (kept > 0 && pieces[kept - 1].cell == pieces[i].cell && pieces[kept - 1].element == pieces[i].element)
        pieces[kept - 1].area += pieces[i].area;
      else
        pieces[kept++] = pieces[i];
    pieces.resize(kept);
  });

  fill(medium, of_tree);
  return medium;
}

// (F20)
CellMedium turbidMedium(SweepGrid grid, std::span<const CellLeaves> leaves) {
  CellMedium medium;
  medium.grid = std::move(grid);
  std::vector<std::vector<PlacedPiece>> pieces(1);
  const std::size_t cells = medium.grid.count();
  for (const CellLeaves& some : leaves) {
    require(some.cell < cells, "cell of leaves", some.cell, fmt::format("below {}", cells));
    require(some.area > 0.f && std::isfinite(some.area), "area of leaves", some.area, "above 0");
    pieces[0].push_back({some.cell, static_cast<std::uint32_t>(medium.area.size()), double{some.area}});
    medium.normal.emplace_back(0.f);
    medium.area.push_back(some.area);
    medium.material.push_back(2 * some.kind);
  }
  medium.first_element = {0, static_cast<std::uint32_t>(medium.area.size())};
  std::stable_sort(pieces[0].begin(), pieces[0].end(),
                   [](const PlacedPiece& p, const PlacedPiece& q) { return p.cell < q.cell; });
  fill(medium, pieces);
  return medium;
}

}  // namespace sunfleck
