#pragma once

#include <filesystem>

#include "core/tree_mesh.hpp"

namespace sunfleck {

// Writes a tree as a binary PLY in metres with z up. A face's property `wood` tells leaf, 0, from wood, 1; where leaf
// triangles know their patches, the vertices' s and t tell them. importTree reads the same mesh back, bit for bit;
// vertices whose triangles lie apart in the images become several. Whole or not at all. Throws InvalidInput when the
// file cannot be written or does not end in .ply.
void writePly(const std::filesystem::path& path, const TreeMesh& mesh);

}  // namespace sunfleck
