#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sunfleck::detail {

// The content of a file. Throws InvalidInput("<path>: cannot be read: ...") when it is missing, a folder, no regular
// file, not permitted, or empty.
std::string readWhole(const std::filesystem::path& path);

// Text of the user's file made fit for a one-line message: at most 200 bytes, without control characters.
std::string shown(std::string_view text);

}  // namespace sunfleck::detail
