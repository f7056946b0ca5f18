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
  float piece_area = 0.f;         // that smaller pieces were enlarged to; 0: all is drawn as it is [m^2]
  std::vector<Cluster> clusters;  // one after the other in the index list
  std::uint32_t firstIndex() const { return clusters.empty() ? 0 : clusters.front().first_index; }
  std::uint32_t endIndex() const { return clusters.empty() ? 0 : clusters.back().end_index; }
};

// What shading reads of a triangle.
struct TriangleData {
  // The plane that it lies in: unit normal, times the enlargement of the piece that it is part of; w: distance of the
  // plane from the origin along the unit normal [m].
  glm::vec4 plane{0.f};
  // The middle of the piece, about which it was enlarged; where `leaf` is kNoLeaf, x: how far the wood may lie from the
  // full tree's [m].
  glm::vec3 middle{0.f};
  std::uint32_t leaf = kNoLeaf;
  static constexpr std::uint32_t kNoLeaf = ~0u, kThinWood = ~0u - 1;  // kThinWood: a piece of a twig
};
static_assert(sizeof(TriangleData) == 32);

// (R25) A tree as it is drawn, from all of its triangles to few. Each level draws a part of the small pieces, leaves
// and bits of twigs, and these enlarged, so that area is kept: a piece of area a is there if its rank, a random number
// that is the same each time, is below a / A, and then has the area A of the level (Cook et al. 2007). So levels are
// nested. Wood that is not thin has its vertices joined within a distance that grows with the level (Rossignac & Borrel
// 1993). Triangle i is the one whose last corner is vertex i: the first are those of the mesh, leaves before wood, as
// they stand there.
struct TreeLevels {
  std::vector<glm::vec3> vertices;      // in the prototype's frame [m]
  std::vector<std::uint32_t> indices;   // three for each triangle, of each level
  std::vector<TriangleData> triangles;  // of all levels
  // Of each triangle, the one of the mesh that it is or stands for: leaves first, then wood.
  std::vector<std::uint32_t> sources;
  std::vector<Level> leaves, wood;  // from fine to coarse, at least one
  Bounds box;                       // of all levels [m]
};
TreeLevels treeLevels(const TreeMesh& mesh);

}  // namespace sunfleck::gl
