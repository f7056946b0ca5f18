#pragma once

#include <filesystem>

#include "render/detail/scene_table.hpp"
#include "render/scene.hpp"

namespace sunfleck::detail {

// What a table [sun], or the tables [[sun]], and a table [sky] of a scene's file say. Throw InvalidInput as readScene()
// does.
void readSuns(Scene& scene, const toml::node* node, const std::filesystem::path& file);
//   folder  in which the sky's image is looked for
void readSky(Scene& scene, SceneTable sky, const std::filesystem::path& folder);

}  // namespace sunfleck::detail
