#pragma once

#include <span>
#include <string_view>

namespace sunfleck::detail {

// A file of leaves/data that the program carries within it.
struct DataText {
  std::string_view path;  // from the repository's root
  std::string_view text;
};
std::span<const DataText> dataTexts();

// The text of leaves/data/<name>, which must be there.
std::string_view dataText(std::string_view name);

}  // namespace sunfleck::detail
