#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "plants/weber_penn.hpp"

namespace sunfleck {

// The names that `species` knows: those of the files in plants/species, which the program carries within it.
std::vector<std::string> speciesNames();

// The parameters of a species. Throws InvalidInput that lists the names when there is none of that name.
const WeberPenn& species(const std::string& name);

// Its parameter file, to be copied and edited. Throws InvalidInput as above.
std::string_view speciesText(const std::string& name);

// Reads a parameter file: a TOML file with a table [tree], [leaves], [pruning], [level0] .. [level3] of the fields of
// WeberPenn under their names; what is left out keeps its default. Throws InvalidInput("<file>:<line>: <table>.<key> =
// <value>: must be <rule>") on a value that is wrong, and with file and line on an unknown key or broken TOML.
WeberPenn readSpecies(const std::filesystem::path& file);

// The parameters of a species by its name, or by its parameter file where the name ends in .toml.
WeberPenn speciesOrFile(const std::string& name_or_file);

}  // namespace sunfleck
