#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/run_options.hpp"
#include "apps/scene_options.hpp"
#include "render/compare/scene_bench.hpp"

namespace sunfleck::apps {

struct SceneBenchOptions {
  SceneOptions scene;
  SceneBenchEffort effort;
  double reference = 16e6;    // paths
  std::vector<double> paths;  // of Monte Carlo as a contestant; empty: from the reference's, by factors of four
};
void addSceneBenchOptions(CLI::App& command, SceneBenchOptions& options);

// (F25) Run time against error of every way to compute a scene's light, as a table, CSV and a plot. Returns the exit
// status.
int runBenchScene(const SceneBenchOptions& options, const std::string& folder, const RunOptions& run);

}  // namespace sunfleck::apps
