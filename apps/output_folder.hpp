#pragma once

#include <filesystem>

namespace sunfleck::apps {

// Makes the folder, and those above it, where it is not there yet. Throws InvalidInput where that cannot be.
void makeFolder(const std::filesystem::path& folder);

}  // namespace sunfleck::apps
