#pragma once

#include <filesystem>

#include "core/tree_mesh.hpp"

namespace sunfleck {

// Writes a tree as `path`, an .obj with groups and materials `leaf` and `wood` in metres with z up, and its materials
// beside it as .mtl. importTree reads the same mesh back, bit for bit. Each file is written whole or not at all. Throws
// InvalidInput when they cannot be written or `path` does not end in .obj.
void writeObj(const std::filesystem::path& path, const TreeMesh& mesh);

}  // namespace sunfleck
