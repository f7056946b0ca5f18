#include "plants/species.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "core/require.hpp"
#include "plants/detail/species_table.hpp"
#include "plants/detail/species_texts.hpp"

namespace sunfleck {
namespace {

std::string nameOf(const detail::SpeciesText& text) {
  return std::filesystem::path(text.path).stem().string();
}

const detail::SpeciesText& textOf(const std::string& name) {
  const auto all = detail::speciesTexts();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& text) { return nameOf(text) == name; });
  if (found == all.end()) {
    std::string names;
    for (const std::string& known : speciesNames()) names += (names.empty() ? "" : ", ") + known;
    require(false, "species", name, "one of " + names);
  }
  return *found;
}

}  // namespace

std::vector<std::string> speciesNames() {
  std::vector<std::string> names;
  for (const detail::SpeciesText& text : detail::speciesTexts()) names.push_back(nameOf(text));
  std::sort(names.begin(), names.end());
  return names;
}

const WeberPenn& species(const std::string& name) {
  static const std::map<std::string, WeberPenn> all = [] {
    std::map<std::string, WeberPenn> read;
    for (const detail::SpeciesText& text : detail::speciesTexts())
      read[nameOf(text)] = detail::parseSpecies(text.text, std::string(text.path));
    return read;
  }();
  const auto found = all.find(name);
  return found != all.end() ? found->second : all.at(nameOf(textOf(name)));
}

std::string_view speciesText(const std::string& name) {
  return textOf(name).text;
}

WeberPenn speciesOrFile(const std::string& name_or_file) {
  return std::filesystem::path(name_or_file).extension() == ".toml" ? readSpecies(name_or_file) : species(name_or_file);
}

}  // namespace sunfleck
