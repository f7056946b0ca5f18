#pragma once

#include <string>
#include <string_view>

#include "plants/weber_penn.hpp"

namespace sunfleck::detail {

// The parameters in the text of a parameter file, which messages call `source`. Throws InvalidInput as readSpecies().
WeberPenn parseSpecies(std::string_view text, const std::string& source);

}  // namespace sunfleck::detail
