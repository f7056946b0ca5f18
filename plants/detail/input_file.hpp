#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sunfleck::detail {

// The content of a file. Throws InvalidInput("<path>: cannot be read: ...") when it is missing, a folder, no regular
// file, not permitted, or empty.
std::string readWhole(const std::filesystem::path& path);

// Text of the user's file made fit for a one-line message: some 200 bytes at most, without control characters
// and bytes that are not UTF-8.
std::string shown(std::string_view text);

}  // namespace sunfleck::detail
