#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "core/bounds.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck::gl {

// Triangles near each other, drawn or left out together.
struct Cluster {
  std::uint32_t first_index = 0, end_index = 0;  // in TreeLevels::indices
  Bounds box;                                    // [m]
};

// Leaves or wood in some degree of detail.
struct Level {
  std::vector<Cluster> clusters;  // one after the other in the index list
  float enlargement = 1.f;        // of a leaf's length, so that those left have the area of all [1]
  float error = 0.f;              // how far a surface of wood may lie from the full tree's [m]
  std::uint32_t firstIndex() const { return clusters.empty() ? 0 : clusters.front().first_index; }
  std::uint32_t endIndex() const { return clusters.empty() ? 0 : clusters.back().end_index; }
};

// What shading reads of a triangle: two rows of four numbers.
struct TriangleData {
  // The plane that it lies in, unit normal times the leaf's enlargement; w: distance of the plane from the origin along
  // the unit normal [m].
  glm::vec4 plane{0.f};
  // xyz: the middle of the leaf, about which it was enlarged; of wood, x: how far from the full tree's surface it may
  // lie [m]. w: the bits of the leaf's number, or of kNoLeaf for wood.
  glm::vec4 leaf{0.f};
};

// (R25) A tree as it is drawn, from all of its triangles to few. Levels of leaves are nested: a random order, the same
// each time, of which each level keeps the first half of the one before, enlarged (Cook et al. 2007). Triangle i is the
// one whose last corner is vertex i: the first are those of the mesh, leaves before wood, as they stand there.
struct TreeLevels {
  std::vector<glm::vec3> vertices;       // in the prototype's frame [m]
  std::vector<std::uint32_t> indices;    // three for each triangle, of each level
  std::vector<TriangleData> triangles;   // of all levels
  std::vector<Level> leaves, wood;       // from fine to coarse, at least one
  Bounds box;                            // of all levels [m]
  float leaf_area = 0.f;                 // mean of a leaf in full detail, one side [m^2]
};
TreeLevels treeLevels(const TreeMesh& mesh);

}  // namespace sunfleck::gl
