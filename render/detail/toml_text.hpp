#pragma once

#include <filesystem>
#include <string>

namespace sunfleck::detail {

// The text of a file for toml++, which keeps a table within a table for every dot of a key, without bound; no key of
// ours has more than one. Throws InvalidInput when the file cannot be read or has too many dots.
std::string tomlText(const std::filesystem::path& file);

}  // namespace sunfleck::detail
