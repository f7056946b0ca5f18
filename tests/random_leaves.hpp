#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/tree_mesh.hpp"
#include "grid/density_grid.hpp"
#include "plants/random_leaves.hpp"

namespace sunfleck {

// Square leaves of side 2 `half_side` in random directions, in a ball of radius `half_width` about `centre` [m].
inline TreeMesh randomLeaves(int leaves, float half_width, float half_side, glm::vec3 centre = glm::vec3(0.f)) {
  TreeMesh mesh =
      randomCrown({.size = glm::vec3(2.f * half_width), .leaf_side = 2.f * half_side, .leaves = leaves}, 11);
  for (glm::vec3& vertex : mesh.vertices) vertex += centre;
  return mesh;
}

// The density at the centres of all cells of side 0.1 in the cube from -1.5 to 1.5.
inline std::vector<float> sampled(const DensityGrid& grid) {
  std::vector<float> values;
  for (int x = -15; x < 15; ++x)
    for (int y = -15; y < 15; ++y)
      for (int z = -15; z < 15; ++z) values.push_back(grid.at(0.1f * (glm::vec3(x, y, z) + 0.5f)));
  return values;
}

}  // namespace sunfleck
