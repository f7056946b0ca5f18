#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/random.hpp"
#include "core/tree_mesh.hpp"
#include "grid/density_grid.hpp"

namespace sunfleck {

inline glm::vec3 inUnitCube(Random& random) {
  return 2.f * glm::vec3(random.uniform(), random.uniform(), random.uniform()) - 1.f;
}

// Square leaves of side 2 `half_side` in random directions, in a cube of side 2 `half_width` about `centre` [m].
inline TreeMesh randomLeaves(std::uint32_t leaves, float half_width, float half_side,
                             glm::vec3 centre = glm::vec3(0.f)) {
  TreeMesh mesh;
  Random random(11, 0);
  for (std::uint32_t i = 0; i < leaves; ++i) {
    const glm::vec3 middle = centre + half_width * inUnitCube(random);
    const glm::vec3 u = half_side * glm::normalize(inUnitCube(random));
    const glm::vec3 v = half_side * glm::normalize(glm::cross(u, inUnitCube(random)));
    for (const glm::vec3& corner : {-u - v, u - v, u + v, v - u}) mesh.vertices.push_back(middle + corner);
    mesh.leaf_triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
    mesh.leaf_triangles.push_back({4 * i, 4 * i + 2, 4 * i + 3});
  }
  finish(mesh, "random leaves");
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
