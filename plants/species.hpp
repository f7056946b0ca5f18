#pragma once

#include <string>
#include <vector>

#include "plants/weber_penn.hpp"

namespace sunfleck {

// The names that `species` knows.
std::vector<std::string> speciesNames();

// The parameters of a species. Throws InvalidInput that lists the names when there is none of that name.
const WeberPenn& species(const std::string& name);

}  // namespace sunfleck
