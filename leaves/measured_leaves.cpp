#include "leaves/measured_leaves.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "core/detail/toml_file.hpp"
#include "core/require.hpp"
#include "leaves/detail/data_texts.hpp"

namespace sunfleck {
namespace {

double number(const toml::node& node) {
  return node.value<double>().value();
}

std::map<std::string, MeasuredLeaf> readLeaves() {
  std::map<std::string, MeasuredLeaf> leaves;
  detail::readToml(
      detail::dataText("measured_leaves.toml"), "leaves/data/measured_leaves.toml", [&](const toml::table& file) {
        std::vector<WavelengthBand> bands;
        for (const toml::node& band : *file["bands"].as_array()) {
          const toml::array* limits = band.as_array();
          bands.push_back(limits ? WavelengthBand{number(*limits->get(0)), number(*limits->get(1))}
                                 : WavelengthBand{number(band), number(band)});
        }
        for (const auto& [name, node] : file) {
          const toml::table* table = node.as_table();
          if (!table) continue;
          MeasuredLeaf& leaf = leaves[std::string(name.str())];
          leaf.name = name.str();
          leaf.title = (*table)["title"].value_or("");
          leaf.source = (*table)["source"].value_or("");
          leaf.caveat = (*table)["caveat"].value_or("");
          leaf.bands = bands;
          for (std::size_t i = 0; i < bands.size(); ++i)
            leaf.measured.push_back({.reflectance = (*table)["reflectance"][i].value<double>().value(),
                                     .transmittance = (*table)["transmittance"][i].value<double>().value()});
          std::vector<std::pair<std::string, double>> contents;
          for (const auto& [content, value] : *(*table)["contents"].as_table())
            contents.emplace_back(content.str(), number(value));
          setContents(leaf.contents, contents, leaf.name + ": ");
          leaf.fit_rmse = (*table)["fit_rmse"].value<double>().value();
        }
      });
  return leaves;
}

const std::map<std::string, MeasuredLeaf>& allLeaves() {
  static const std::map<std::string, MeasuredLeaf> leaves = readLeaves();
  return leaves;
}

}  // namespace

std::vector<std::string> measuredLeafNames() {
  std::vector<std::string> names;
  for (const auto& [name, leaf] : allLeaves()) names.push_back(name);
  return names;
}

const MeasuredLeaf& measuredLeaf(const std::string& name, const std::string& where) {
  const auto found = allLeaves().find(name);
  if (found == allLeaves().end())
    throw InvalidInput(
        fmt::format("{} = \"{}\": must be one of: {}", where, name, fmt::join(measuredLeafNames(), ", ")));
  return found->second;
}

}  // namespace sunfleck
