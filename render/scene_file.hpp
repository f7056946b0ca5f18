#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "plants/import.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// Reads a scene: a TOML file, a mesh file (.obj, .ply) that stands alone, or the name of a built-in scene or species.
// `rules` says how a mesh file that is the scene itself is read; a TOML file brings its own. Throws InvalidInput with
// file, line and key on anything that is wrong.
Scene readScene(const std::string& name_or_file, const ImportRules& rules = {});

// Whether a .toml file holds what a scene does and a species' parameters do not. Of a file that cannot be read: no.
bool isSceneFile(const std::filesystem::path& file);

// A kind of trees of a species, named after it. Throws InvalidInput on a species that is not known.
TreeKind grownKind(const std::string& species_name, std::uint64_t seed);

// Names that readScene() knows without a file.
std::vector<std::string> builtinScenes();

// Every key of a scene file with its unit, range and default, for people.
std::string sceneFileHelp();

// Side lengths of the rectangle in which the widest trees touch their own copies: those of their leaves' box, and no
// less than a seventh of its longest; without trees those of the media's boxes, or 1 where they have no end [m].
glm::vec2 touchingPeriod(const Scene& scene);

}  // namespace sunfleck
