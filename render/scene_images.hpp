#pragma once

#include <filesystem>

#include "render/scene.hpp"

namespace sunfleck {

// Throws InvalidInput where writing `output` would replace an image that the scene was read from: of its leaves, its
// ground or its sky.
void requireNoImageOf(const Scene& scene, const std::filesystem::path& output);

}  // namespace sunfleck
