#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/run_options.hpp"
#include "core/progress.hpp"

namespace sunfleck::apps {

// What a bench found.
struct BenchReport {
  std::string table;
  nlohmann::ordered_json json;
  std::vector<std::string> files;  // what each of its files holds
};

// Makes the folder, measures, writes the files and tells the table or the JSON, or, where `measure` has nothing because
// it was interrupted, that nothing was written. Returns the exit status. Throws InvalidInput, before it measures, where
// the files cannot be written.
//   names  of the files in the folder
int runBench(const std::string& folder, const std::vector<std::string>& names, const RunOptions& run,
             const std::function<std::optional<BenchReport>(const Progress&)>& measure);

}  // namespace sunfleck::apps
