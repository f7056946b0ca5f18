#pragma once

#include <span>
#include <string_view>

namespace sunfleck::detail {

// A parameter file of plants/species that the program carries within it.
struct SpeciesText {
  std::string_view path;  // from the repository's root
  std::string_view text;
};
std::span<const SpeciesText> speciesTexts();

}  // namespace sunfleck::detail
