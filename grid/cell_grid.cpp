#include "grid/cell_grid.hpp"

#include <algorithm>
#include <glm/common.hpp>

namespace sunfleck {

glm::ivec3 CellGrid::cell(std::size_t number) const {
  const int i = static_cast<int>(number);
  return {i % size.x, i / size.x % size.y, i / (size.x * size.y)};
}

CellGrid cellGrid(const TreeMesh& mesh, int resolution) {
  CellGrid grid;
  grid.leaves = leafBounds(mesh);
  const glm::vec3 extent = grid.leaves.size();
  grid.cell_size = std::max({extent.x, extent.y, extent.z, 1e-6f}) / static_cast<float>(resolution);
  grid.size = glm::clamp(glm::ivec3(glm::ceil(extent / grid.cell_size)), 1, resolution);
  grid.low = grid.leaves.centre() - 0.5f * grid.cell_size * glm::vec3(grid.size);
  const auto holding = [&](glm::vec3 point) {
    return glm::clamp(glm::ivec3(glm::floor((point - grid.low) / grid.cell_size)), glm::ivec3(0), grid.size - 1);
  };
  grid.slot.assign(grid.number({0, 0, grid.size.z}), CellGrid::kInactive);
  // A leaf makes all cells of its triangles' boxes active, and one layer around them.
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    Bounds box;
    for (int corner = 0; corner < 3; ++corner) box.include(mesh.vertices[t[corner]]);
    const glm::ivec3 low = glm::max(holding(box.low) - 1, 0);
    const glm::ivec3 high = glm::min(holding(box.high) + 1, grid.size - 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) grid.slot[grid.number({x, y, z})] = 0;
  }
  for (std::uint32_t number = 0; number < grid.slot.size(); ++number)
    if (grid.slot[number] != CellGrid::kInactive) {
      grid.slot[number] = static_cast<std::uint32_t>(grid.active.size());
      grid.active.push_back(number);
    }
  return grid;
}

float interpolate(const CellGrid& grid, std::span<const float> values, glm::vec3 point) {
  const glm::vec3 at = glm::clamp((point - grid.low) / grid.cell_size - 0.5f, glm::vec3(0.f), glm::vec3(grid.size - 1));
  const glm::ivec3 low = glm::min(glm::ivec3(at), grid.size - 1);
  const glm::ivec3 high = glm::min(low + 1, grid.size - 1);
  const glm::vec3 part = at - glm::vec3(low);
  const auto value = [&](int x, int y, int z) { return values[grid.number({x, y, z})]; };
  const auto along_x = [&](int y, int z) { return glm::mix(value(low.x, y, z), value(high.x, y, z), part.x); };
  return glm::mix(glm::mix(along_x(low.y, low.z), along_x(high.y, low.z), part.y),
                  glm::mix(along_x(low.y, high.z), along_x(high.y, high.z), part.y), part.z);
}

}  // namespace sunfleck
