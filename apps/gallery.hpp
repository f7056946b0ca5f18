#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/run_options.hpp"
#include "plants/import.hpp"

namespace sunfleck::apps {

// Draws every species, grown with the seed, and the trees of mesh files and scenes (.toml, their first) on one sheet, a
// .png: each with its name, its leaves, their area and its height. Throws InvalidInput on a file that cannot be read
// and a place that cannot be written; false, with nothing written, when it was interrupted.
bool writeGallery(const std::filesystem::path& sheet, const std::vector<std::string>& files, const ImportRules& rules,
                  const RunOptions& run);

}  // namespace sunfleck::apps
