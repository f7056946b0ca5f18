#include "apps/trace_compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/csv_rows.hpp"
#include "apps/trace_output.hpp"
#include "core/require.hpp"
#include "render/compare/rami_score.hpp"

namespace sunfleck::apps {
namespace {

const Estimate& estimateOf(const std::string& name, const std::vector<NamedEstimate>& found) {
  return std::find_if(found.begin(), found.end(), [&](const auto& of) { return of.name == name; })->estimate;
}

}  // namespace

std::vector<NamedEstimate> readReference(const std::string& file, const std::vector<std::string>& names) {
  std::vector<NamedEstimate> reference;
  for (const auto& [where, fields] : readCsvRows(file, "name,value,standard_error")) {
    if (std::find(names.begin(), names.end(), fields[0]) == names.end())
      throw InvalidInput(fmt::format("{}name = {}: must be a figure that this run tells, such as {}", where, fields[0],
                                     names.front()));
    const Estimate estimate{numberAt(fields[1], where), numberAt(fields[2], where)};
    require(std::isfinite(estimate.value), where + "value", estimate.value, "finite");
    require(estimate.standard_error >= 0. && std::isfinite(estimate.standard_error), where + "standard_error",
            estimate.standard_error, "finite and not negative");
    reference.push_back({fields[0], estimate});
  }
  if (reference.empty()) throw InvalidInput(file + ": must have at least one figure");
  return reference;
}

nlohmann::ordered_json comparisonJson(const std::vector<NamedEstimate>& found,
                                      const std::vector<NamedEstimate>& reference) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& [name, expected] : reference) {
    const Estimate& value = estimateOf(name, found);
    const RamiScore score = ramiScore(value, expected);
    rows.push_back({{"name", name},
                    {"value", value.value},
                    {"reference", expected.value},
                    {"percent", known(score.percent)},
                    {"z", known(score.z)},
                    {"z_prime", known(score.z_prime)},
                    {"verdict", nameOf(score.verdict)}});
  }
  return rows;
}

std::string comparisonTable(const std::vector<NamedEstimate>& found, const std::vector<NamedEstimate>& reference) {
  std::string text =
      fmt::format("  {:<24} {:>10} {:>10} {:>9} {:>8} {:>8}\n", "", "found", "reference", "percent", "z", "z'");
  for (const auto& [name, expected] : reference) {
    const Estimate& value = estimateOf(name, found);
    const RamiScore score = ramiScore(value, expected);
    text += fmt::format("  {:<24} {:>10.6f} {:>10.6f} {:>+9.3f} {:>+8.2f} {:>8.3f}  {}\n", name, value.value,
                        expected.value, score.percent, score.z, score.z_prime, nameOf(score.verdict));
  }
  return text;
}

}  // namespace sunfleck::apps
