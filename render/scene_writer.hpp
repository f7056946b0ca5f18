#pragma once

#include <filesystem>
#include <string>

#include "render/scene.hpp"

namespace sunfleck {

// The scene as the text of a scene file in `folder`, from which readScene() reads the same scene back, to the bit of
// each number: kinds by what they were grown or read from, leaves as they are told, media and images by their files,
// whose paths count from the folder. Kinds of which no tree stands are left out, unless none stands at all. Throws
// InvalidInput on what a scene file cannot say: leaves, cells or images that came from no file and no species, a tree
// above or below z = 0, a scene without kinds of trees and without media, and numbers out of the ranges that a file may
// hold.
std::string sceneText(const Scene& scene, const std::filesystem::path& folder);

// Writes it into a .toml file, whole or not at all. Throws InvalidInput as above, on another extension and on a place
// that cannot be written.
void writeScene(const std::filesystem::path& file, const Scene& scene);

}  // namespace sunfleck
