#include "apps/bench_forest.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/bench_run.hpp"
#include "render/compare/forest_bench.hpp"

namespace sunfleck::apps {
namespace {

std::string table(const ForestBench& bench) {
  std::string text =
      fmt::format("{}\n\n{:>7} {:>7} {:>10} {:>9} {:>10} {:>11} {:>8} {:>8} {:>7} {:>9}\n", bench.machine, "trees",
                  "near", "leaves", "cells", "elements", "iterations", "wall s", "CPU s", "MB", "lost");
  for (const ForestBenchRow& r : bench.rows)
    text += fmt::format("{:>7} {:>7} {:>10.3g} {:>9} {:>10} {:>11} {:>8.3g} {:>8.3g} {:>7.0f} {:>9.1e}\n", r.trees,
                        r.near, r.leaves, r.cells, r.elements, fmt::format("{} + {}", r.cell_iterations, r.iterations),
                        r.seconds, r.cpu_seconds, r.megabytes, r.lost);
  return text + R"(
The light field of stands of four prototypes, random crowns of 10,000 leaves, from their meshes on, one sun, three bands.
near: trees whose leaves are solved one by one, in the middle; of the others what cells tell. cells: that hold something;
elements: leaves in a cell that face alike. iterations: in cells, and of the trees. MB: the most that the process has had
so far. lost: share of the light that the balance of the cells misses.
)";
}

nlohmann::ordered_json json(const ForestBench& bench) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ForestBenchRow& r : bench.rows)
    rows.push_back({{"trees", r.trees},
                    {"near", r.near},
                    {"leaves", r.leaves},
                    {"cells", r.cells},
                    {"elements", r.elements},
                    {"cell_iterations", r.cell_iterations},
                    {"iterations", r.iterations},
                    {"wall_seconds", r.seconds},
                    {"cpu_seconds", r.cpu_seconds},
                    {"peak_megabytes", r.megabytes},
                    {"lost", r.lost}});
  return {{"machine", bench.machine}, {"rows", std::move(rows)}};
}

}  // namespace

int runBenchForest(std::size_t most_trees, std::size_t most_near, const std::string& folder, const RunOptions& run) {
  return runBench(folder, {"forest_bench.csv"}, run, [&](const Progress& progress) -> std::optional<BenchReport> {
    const ForestBench bench = benchForests(most_trees, most_near, progress);
    if (bench.rows.empty()) return std::nullopt;
    return BenchReport{table(bench), json(bench), {forestBenchCsv(bench)}};
  });
}

}  // namespace sunfleck::apps
