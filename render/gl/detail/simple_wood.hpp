#pragma once

#include <vector>

#include "core/tree_mesh.hpp"
#include "render/gl/detail/level_builder.hpp"

namespace sunfleck::gl::detail {

// Wood with few triangles: what is thicker than `reach` keeps its surface, whose vertices are joined within that
// distance; of what is thinner, the joined vertices are the bones, each covered by a flat piece of half the surface
// that was there, which is what a convex body shows on average. Pieces are thinned as leaves are (R25).
struct SimpleWood {
  std::vector<LevelTriangle> triangles;
  std::size_t shared_count = 0;  // numbers that their corners have
};
SimpleWood simpleWood(const TreeMesh& mesh, float reach, float piece_area);

}  // namespace sunfleck::gl::detail
