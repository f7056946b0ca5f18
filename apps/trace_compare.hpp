#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/reference/trace_sums.hpp"

namespace sunfleck::apps {

// What a trace found, or another program, by the name of the quantity.
struct NamedEstimate {
  std::string name;
  Estimate estimate;
};

// Figures to compare with, from a CSV file with the header name,value,standard_error. Throws InvalidInput naming file
// and line when it is wrong or a name is not among `names`.
std::vector<NamedEstimate> readReference(const std::string& file, const std::vector<std::string>& names);

// Differences in percent and by the standard errors, and the score of RAMI-IV (R13) with its verdict, of each figure of
// the reference.
nlohmann::ordered_json comparisonJson(const std::vector<NamedEstimate>& found,
                                      const std::vector<NamedEstimate>& reference);
std::string comparisonTable(const std::vector<NamedEstimate>& found, const std::vector<NamedEstimate>& reference);

}  // namespace sunfleck::apps
