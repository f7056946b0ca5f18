#pragma once

#include <filesystem>
#include <string>

#include "plants/import.hpp"

namespace sunfleck::detail {

// Reads a glTF as one tree, finished, in metres with z up: all of it, or the kind `rules.mesh`.
ImportedTree readGltf(const std::filesystem::path& path, const std::string& bytes, const ImportRules& rules,
                      const ImageReader& read_image);

// The same as a stand, as importStand() tells.
ImportedStand readGltfStand(const std::filesystem::path& path, const std::string& bytes, const ImportRules& rules,
                            const ImageReader& read_image);

}  // namespace sunfleck::detail
