#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/stand.hpp"
#include "grid/deep_opacity_map.hpp"

namespace sunfleck {

// A coarse grid of cubic cells over one tree's leaves, about `resolution` along the longest side. Cell (x, y, z) is
// number (z * size.y + y) * size.x + x. Only cells that hold leaves, and those that touch them (which interpolation
// reads), are active.
struct CellGrid {
  glm::vec3 low{0.f};        // corner of cell (0, 0, 0) [m]
  float cell_size = 0.f;     // [m]
  glm::ivec3 size{0};        // [cell]
  std::vector<bool> active;  // per cell

  std::size_t count() const { return active.size(); }
  glm::vec3 centre(glm::ivec3 cell) const { return low + cell_size * (glm::vec3(cell) + 0.5f); }
};
CellGrid cellGrid(const TreeMesh& mesh, int resolution);

// (D4) Optical depths from the cells of one instance to the edge of the foliage, Eq. 31: the crossings found in the
// prototype's maps, summed over the instance itself and its neighbours. `depths[cell * directions + j]` is the mean
// number of leaf crossings from the cell outward along maps[j].along() [1]; inactive cells hold 0.
//   neighbours  displacements of the other instances from this one [m]
std::vector<float> cellDepths(const CellGrid& grid, std::span<const DeepOpacityMap> maps,
                              std::span<const glm::vec3> neighbours);

// (D5) G-factor of each cell, Eqs. 27 and A.3, for light along `light.along()`, the slab's normal being the light's
// axis. In [0, 1]; inactive cells hold 0.
//   depths  of cellDepths for `maps`
//   light   the prototype's map along the light
std::vector<float> cellCompensation(const CellGrid& grid, std::span<const DeepOpacityMap> maps,
                                    std::span<const float> depths, const DeepOpacityMap& light,
                                    std::span<const glm::vec3> neighbours);

// Trilinear interpolation of a value per cell at a point; clamped to the outermost cell centres.
float interpolate(const CellGrid& grid, std::span<const float> values, glm::vec3 point);

// Displacements of the neighbours of tree `index` of a stand that could stand between its leaves and light along any
// direction that matters: all other trees, and the copies of a periodic stand as far as a path through the crown layer
// whose slope is at least `smallest_slope` (|z| of the direction) reaches, at most 8 periods away.
std::vector<glm::vec3> neighbourDisplacements(const Stand& stand, std::size_t index, const Bounds& box,
                                              float smallest_slope);

}  // namespace sunfleck
