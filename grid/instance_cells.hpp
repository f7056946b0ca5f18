#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "grid/deep_opacity_map.hpp"

namespace sunfleck {

// A coarse grid of cubic cells over one tree's leaves. Cell (x, y, z) is number (z * size.y + y) * size.x + x. Only
// cells that hold leaves, and those that touch them (which interpolation reads), are active.
struct CellGrid {
  glm::vec3 low{0.f};        // corner of cell (0, 0, 0) [m]
  float cell_size = 0.f;     // [m]
  glm::ivec3 size{0};        // [cell]
  std::vector<bool> active;  // per cell
  Bounds leaves;             // box of the leaves the cells were made for [m]

  std::size_t count() const { return active.size(); }
  glm::vec3 lowCorner(std::size_t cell) const;
};

// Cells of a tree, `resolution` >= 1 of them along its longest side.
CellGrid cellGrid(const TreeMesh& mesh, int resolution);

// (D4) Optical depths from the cells of one instance to the edge of the foliage, Eq. 31: the crossings found in the
// prototype's maps, summed over the instance itself and its neighbours. Each map serves both directions of its axis:
// elements 2 (cell * maps.size() + j) and the next are the mean number of leaf crossings from the cell outward along
// maps[j].along() and against it [1]; inactive cells hold 0.
//   neighbours  displacements of the other instances from this one [m]
std::vector<float> cellDepths(const CellGrid& grid, std::span<const DeepOpacityMap> maps,
                              std::span<const glm::vec3> neighbours);

// (D5) G-factor of each cell, Eqs. 27 and A.3, the slab's normal being the light's axis. In [0, 1]; inactive cells hold
// 0.
//   depths  cellDepths() of the same grid, maps and neighbours
//   light   the prototype's map along the light
std::vector<float> cellCompensation(const CellGrid& grid, std::span<const DeepOpacityMap> maps,
                                    std::span<const float> depths, const DeepOpacityMap& light,
                                    std::span<const glm::vec3> neighbours);

// Trilinear interpolation at a point between the values at the cells' centres; beyond the outermost centres their
// values.
float interpolate(const CellGrid& grid, std::span<const float> values, glm::vec3 point);

}  // namespace sunfleck
