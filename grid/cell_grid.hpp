#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// A coarse grid of cubic cells over one tree's leaves. Cell (x, y, z) is number (z * size.y + y) * size.x + x. Only
// cells that hold leaves, and those that touch them (which interpolation reads), are active: values are kept for these
// alone, one after the other.
struct CellGrid {
  glm::vec3 low{0.f};     // corner of cell (0, 0, 0) [m]
  float cell_size = 0.f;  // [m]
  glm::ivec3 size{0};     // [cell]
  Bounds leaves;          // box of the leaves the cells were made for [m]

  static constexpr std::uint32_t kInactive = ~0u;
  std::vector<std::uint32_t> active;  // numbers of the active cells, in order
  std::vector<std::uint32_t> slot;    // of each cell: its place among the active ones, or kInactive

  std::size_t count() const { return slot.size(); }
  glm::ivec3 cell(std::size_t number) const;
  std::size_t number(const glm::ivec3& cell) const {
    return static_cast<std::size_t>((cell.z * size.y + cell.y) * size.x + cell.x);
  }
  glm::vec3 centre(std::size_t number) const { return low + cell_size * (glm::vec3(cell(number)) + 0.5f); }
  Bounds box() const { return {low, low + cell_size * glm::vec3(size)}; }  // of all cells [m]
};

// Cells of a tree, `resolution` >= 1 of them along its longest side.
CellGrid cellGrid(const TreeMesh& mesh, int resolution);

// Values of all cells from those of the active ones; 0 in the others.
template <typename Value>
std::vector<Value> spread(const CellGrid& grid, std::span<const Value> of_active) {
  std::vector<Value> all(grid.count(), Value(0.f));
  for (std::size_t i = 0; i < grid.active.size(); ++i) all[grid.active[i]] = of_active[i];
  return all;
}

// Trilinear interpolation at a point between the values at the cells' centres, of all cells; beyond the outermost
// centres their values.
float interpolate(const CellGrid& grid, std::span<const float> values, glm::vec3 point);

}  // namespace sunfleck
