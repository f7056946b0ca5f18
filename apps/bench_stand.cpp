#include "apps/bench_stand.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/bench_run.hpp"
#include "render/compare/stand_bench.hpp"

namespace sunfleck::apps {
namespace {

std::string table(const StandBench& bench) {
  std::string text = fmt::format(
      "{}\nTimes in ms, the paper's after the slash.\n\n{:<18} {:>9} {:>10} {:>15} {:>11} {:>12} {:>9} {:>9} {:>9} "
      "{:>7}\n",
      bench.machine, "stand", "triangles", "cells", "prepare", "sky", "light map", "turn sun", "move one", "leaf",
      "MB");
  const auto beside = [](double ours, double paper) { return fmt::format("{:.3g} / {:.3g}", 1e3 * ours, 1e3 * paper); };
  const auto alone = [](double ours) { return fmt::format("{:.3g}", 1e3 * ours); };
  for (const StandBenchRow& r : bench.rows) {
    const std::optional<PaperStand> paper = paperStand(r.stand);
    text += fmt::format("{:<18} {:>9.3g} {:>10} {:>15} {:>11} {:>12} {:>9.3g} {:>9.3g} {:>9.3g} {:>7.0f}\n", r.stand,
                        static_cast<double>(r.triangles), r.cells,
                        paper ? beside(r.prepare, paper->prepare) : alone(r.prepare),
                        paper ? beside(r.sky, paper->sky) : alone(r.sky),
                        paper ? beside(r.light_map, paper->light_map) : alone(r.light_map), 1e3 * r.turn_sun,
                        1e3 * r.move_tree, 1e3 * r.change_leaf, r.megabytes);
  }
  return text + R"(
prepare: opacity maps in 22 directions, depths of all cells and their G (steps 2 and 3 of Shinya et al. 2013). sky:
environment light of all cells (step 4). light map: of a prototype (step 5). turn sun: light maps and G of all cells. move
one: depths, G and environment light of all that one moved tree concerns. leaf: other leaf optics. The paper's trees are
its own, on a processor and a graphics card of their time.
)";
}

nlohmann::ordered_json json(const StandBench& bench) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const StandBenchRow& r : bench.rows)
    rows.push_back({{"stand", r.stand},
                    {"prototypes", r.prototypes},
                    {"trees", r.trees},
                    {"triangles", r.triangles},
                    {"cells", r.cells},
                    {"prepare_seconds", r.prepare},
                    {"sky_seconds", r.sky},
                    {"light_map_seconds", r.light_map},
                    {"turn_sun_seconds", r.turn_sun},
                    {"move_tree_seconds", r.move_tree},
                    {"change_leaf_seconds", r.change_leaf},
                    {"megabytes", r.megabytes}});
  return {{"machine", bench.machine}, {"rows", std::move(rows)}};
}

}  // namespace

int runBenchStand(std::size_t most_trees, int rounds, const std::string& folder, const RunOptions& run) {
  const std::vector<std::string> files{"stand_bench.csv", "stand_bench.svg"};
  return runBench(folder, files, run, [&](const Progress& progress) -> std::optional<BenchReport> {
    const StandBench bench = benchStands(most_trees, rounds, progress);
    if (bench.rows.empty()) return std::nullopt;
    return BenchReport{table(bench), json(bench), {standBenchCsv(bench), standBenchPlot(bench)}};
  });
}

}  // namespace sunfleck::apps
