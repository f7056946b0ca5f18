#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/tree_mesh.hpp"

namespace sunfleck::detail {

// A mesh's vertices for formats that tell the place in an image with each vertex. One whose leaf triangles do not agree
// on it is there several times.
struct TexturedVertices {
  std::vector<glm::vec3> vertices;         // the mesh's, then those again that are there several times [m]
  std::vector<glm::vec2> texture;          // of each, u to the right and v up: all 0 about triangles without a patch
  std::vector<glm::uvec3> leaf_triangles;  // in the mesh's order
};

// Whether any leaf triangle tells its place.
bool anyPatch(const TreeMesh& mesh);

// `texture` is empty of a mesh without patches.
TexturedVertices texturedVertices(const TreeMesh& mesh);

}  // namespace sunfleck::detail
