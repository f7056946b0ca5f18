#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace sunfleck {

// A file is written whole or not at all: `write` fills a temporary file beside `path` (with the same extension), which
// then takes the place of `path` in one step. When `write` throws, nothing is left behind. Throws InvalidInput when the
// place cannot be written.
void writeWhole(const std::filesystem::path& path, const std::function<void(const std::filesystem::path&)>& write);
void writeWhole(const std::filesystem::path& path, std::string_view text);

// Folders to be removed when the program is ended by a signal and they are empty, innermost first; none: no longer. At
// most 4 kB of names are kept.
void removeWhenEmpty(std::span<const std::filesystem::path> folders);

// Removes the temporary file of a write under way, if there is one, and then those folders that are empty: for the
// handler of a signal that ends the program.
void removeUnfinished() noexcept;

// Throws InvalidInput unless a file could be written at `path`: to be asked before long work, not after it.
void requireWritable(const std::filesystem::path& path);

// The same, and unless `path` has this extension, such as ".csv".
void requireNamed(const std::filesystem::path& path, std::string_view extension);

}  // namespace sunfleck
