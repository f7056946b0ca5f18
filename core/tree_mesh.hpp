#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/bounds.hpp"
#include "core/leaf_mask.hpp"

namespace sunfleck {

// A tree as the simulation sees it: leaves that scatter, wood that blocks. Lengths in metres, z up. Every index is in
// range, every coordinate finite and every leaf triangle has an area: whoever makes a TreeMesh calls `finish`, and all
// who read one rely on it.
struct TreeMesh {
  std::vector<glm::vec3> vertices;              // position [m]
  std::vector<glm::uvec3> leaf_triangles;       // corners, as indices of `vertices`
  std::vector<std::uint32_t> leaf_of_triangle;  // the leaf a leaf triangle is part of, 0 .. leaf_count - 1
  std::vector<glm::uvec3> wood_triangles;       // corners, as indices of `vertices`
  std::uint32_t leaf_count = 0;
  // Of leaves that masks cut out of their triangles; empty where there are none.
  std::vector<std::shared_ptr<const LeafMask>> masks;
  // Where leaf triangles lie in the images of their leaf, which many may share.
  static constexpr std::uint32_t kNoPatch = ~0u;
  std::vector<LeafPatch> patches;
  std::vector<std::uint32_t> patch_of_triangle;  // of each leaf triangle, or kNoPatch; empty where none has one
};

// Where a leaf triangle lies in the images of its leaf; none where that is not known.
const LeafPatch* patchOf(const TreeMesh& mesh, std::size_t leaf_triangle);
// Whether a mask cuts the leaf out of the triangle.
bool isCut(const TreeMesh& mesh, std::size_t leaf_triangle);

// What `finish` left out.
struct Dropped {
  std::size_t leaf_triangles = 0;  // leaf triangles of no area, or cut away
  std::size_t wood_triangles = 0;  // wood triangles of no area
  std::size_t doubled = 0;         // leaf triangles that a file held twice, once for each side
};

// Makes a mesh safe to use: throws InvalidInput("<source>: ...") on an index out of range, a coordinate that is not
// finite or beyond 1e4 m, or a mesh without leaves; drops triangles of no area, also those that masks leave nothing of;
// and tells leaves apart: leaf triangles that share a vertex belong to one leaf, and those that have the same number in
// `leaf_of_triangle`, where it has one for each (below the number of leaf triangles). Masks are checked as well;
// patches of no use (isUsable()) are dropped.
Dropped finish(TreeMesh& mesh, const std::string& source);

double triangleArea(const TreeMesh& mesh, const glm::uvec3& triangle);  // whole, whatever a mask cuts away [m^2]
std::vector<double> leafAreas(const TreeMesh& mesh);                    // one-sided area of each leaf [m^2]
double leafArea(const TreeMesh& mesh);                                  // one-sided area of all leaves [m^2]
Bounds leafBounds(const TreeMesh& mesh);                                // box of the leaves
Bounds bounds(const TreeMesh& mesh);                                    // box of leaves and wood

}  // namespace sunfleck
