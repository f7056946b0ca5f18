#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/tree_mesh.hpp"

namespace sunfleck::apps {

// A picture of 256 x 256 pixels that shows what a tree looks like, as writeThumbnail() says: red, green and blue of
// each pixel, rows from the top.
inline constexpr int kThumbnailPixels = 256;
std::vector<std::uint8_t> thumbnail(const TreeMesh& mesh);

// Writes a .png of 256 x 256 pixels that shows what a tree looks like: leaves green and wood brown by how they face a
// light, without shadows and scattering. Throws InvalidInput on another extension or a place that cannot be written.
void writeThumbnail(const std::filesystem::path& file, const TreeMesh& mesh);

}  // namespace sunfleck::apps
