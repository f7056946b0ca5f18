#pragma once

#include <filesystem>

#include "core/tree_mesh.hpp"

namespace sunfleck::apps {

// Writes a .png of 256 x 256 pixels that shows what a tree looks like: leaves green and wood brown by how they face a
// light, without shadows and scattering. Throws InvalidInput on another extension or a place that cannot be written.
void writeThumbnail(const std::filesystem::path& file, const TreeMesh& mesh);

}  // namespace sunfleck::apps
