#pragma once

#include <string>

namespace sunfleck {

// The text as a basic string of TOML, in quotes.
std::string tomlString(const std::string& text);

}  // namespace sunfleck
