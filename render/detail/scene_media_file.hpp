#pragma once

#include <filesystem>

#include "leaves/light_bands.hpp"
#include "render/detail/scene_table.hpp"
#include "render/scene.hpp"

namespace sunfleck::detail {

// Adds to a scene what a table [medium], or the tables [[medium]], of its file say. `optics`, and how they are
// told: of leaves, unless they have their own, by species in these bands. Throws InvalidInput as readScene() does.
void readMedia(Scene& scene, const toml::node& node, const TreeKind& optics, const std::filesystem::path& file);

}  // namespace sunfleck::detail
