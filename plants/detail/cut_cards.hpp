#pragma once

#include <string>

#include "core/tree_mesh.hpp"

namespace sunfleck::detail {

// Replaces the leaf triangles that masks cut out by triangles of their solid parts; the mesh is without masks then. All
// that comes of a card (triangles that `leaf_of_triangle` calls one leaf) is one leaf, as `leaf_of_triangle` says
// afterwards. Indices are in range. Throws InvalidInput("<source>: ...") on texture coordinates that a mask cannot be
// laid on by, and on masks that cannot be cut.
void cutCards(TreeMesh& mesh, const std::string& source);

}  // namespace sunfleck::detail
