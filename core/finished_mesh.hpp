#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/tree_mesh.hpp"

namespace sunfleck {

// What `finish` makes sure of, one by one. Each throws InvalidInput("<source>: ...").

// Coordinates are finite and at most 1e4 m in size.
void requireVertices(const TreeMesh& mesh, const std::string& source);
// Corners of triangles are vertices.
void requireIndices(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles, const std::string& what);
// Whether a triangle of that area [m^2] counts: of less, 1.2e-38 m^2, single precision leaves nothing, or few digits.
bool hasArea(double area);

// All of it, and that there are leaves, masks apart: for those to whom a mesh that nobody finished would bring numbers
// that are none. A millisecond for 100,000 triangles.
void requireFinished(const TreeMesh& mesh, const std::string& source);

}  // namespace sunfleck
