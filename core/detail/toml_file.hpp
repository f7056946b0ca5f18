#pragma once

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace sunfleck::detail {

// Parses a TOML file and passes it to `read`. Throws InvalidInput when the file cannot be read or is no TOML; whatever
// is wrong, also with what `read` finds, the message begins with the file.
void readToml(const std::filesystem::path& file, const std::function<void(const toml::table&)>& read);

// The same of a text that is there already; `source` stands for the file.
void readToml(std::string_view text, const std::string& source, const std::function<void(const toml::table&)>& read);

}  // namespace sunfleck::detail
