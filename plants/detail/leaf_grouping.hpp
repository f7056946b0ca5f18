#pragma once

#include <cstddef>

#include "core/tree_mesh.hpp"

namespace sunfleck::detail {

// Tells leaves apart in a mesh as a file brings it: leaf triangles that share a vertex are one leaf, and so are those
// that share an edge of two places, where every triangle has corners of its own. Leaf triangles that a file holds
// twice, once for each side, stay once: leaves have two sides. Sets `leaf_of_triangle` and `leaf_count`; indices are in
// range, coordinates finite. Returns the number of doubled triangles.
std::size_t groupLeaves(TreeMesh& mesh);

}  // namespace sunfleck::detail
