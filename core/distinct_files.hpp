#pragma once

#include <filesystem>

namespace sunfleck {

// Throws InvalidInput where writing `output` would replace `other`, which is read or written as well. Either may be
// empty: none.
void requireOther(const std::filesystem::path& output, const std::filesystem::path& other);

}  // namespace sunfleck
