#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/bench_directions.hpp"
#include "apps/bench_forest.hpp"
#include "apps/bench_pictures.hpp"
#include "apps/bench_run.hpp"
#include "apps/bench_scene.hpp"
#include "apps/bench_stand.hpp"
#include "apps/commands.hpp"
#include "render/compare/slab_bench.hpp"

namespace sunfleck::apps {
namespace {

std::string table(const SlabBench& bench) {
  std::string text =
      fmt::format("{}\n\n{:<14} {:>14} {:>14} {:>12} {:>14} {:>14} {:>14}\n", bench.machine, "model", "P+, P- time",
                  "irradiance err", "flux err", "radiance time", "radiance err", "batch time");
  for (const SlabBenchRow& row : bench.rows)
    text += fmt::format("{:<14} {:>11.4g} us {:>14.2g} {:>12} {:>11.4g} us {:>14.2g} {:>14}\n", row.model,
                        1e6 * row.power_seconds, row.irradiance_error,
                        std::isnan(row.flux_error) ? "-" : fmt::format("{:.2g}", row.flux_error),
                        1e6 * row.radiance_seconds, row.radiance_error,
                        std::isnan(row.batch_seconds) ? "-" : fmt::format("{:.4g} us", 1e6 * row.batch_seconds));
  return text + R"(
Times are of one evaluation at one depth, one thread, median of rounds in which all take turns. Closed forms: single
precision, within arrays of places of one medium and beam (SIMD), whose constants are at hand; depth and thickness are
new. Tables: a look-up. pp:N: a solution for each evaluation; batch time: for each slab, of the fluxes at the faces of
many slabs solved together. Errors are over the places that the plot names, against the exact solver with N = 128: of
irradiance relative, RMS; of fluxes the largest, over the flux that arrives; of radiance RMS over all directions [1/sr],
for a beam of irradiance 1.
)";
}

nlohmann::ordered_json json(const SlabBench& bench) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SlabBenchRow& row : bench.rows) {
    rows.push_back({{"model", row.model},
                    {"kind", row.kind},
                    {"streams", row.streams},
                    {"azimuth_orders", row.azimuth_orders},
                    {"power_seconds", row.power_seconds},
                    {"irradiance_error", row.irradiance_error},
                    {"flux_error", nullptr},
                    {"radiance_seconds", row.radiance_seconds},
                    {"radiance_error", row.radiance_error},
                    {"batch_seconds", nullptr}});
    if (!std::isnan(row.flux_error)) rows.back()["flux_error"] = row.flux_error;
    if (!std::isnan(row.batch_seconds)) rows.back()["batch_seconds"] = row.batch_seconds;
  }
  return {{"machine", bench.machine}, {"rows", std::move(rows)}};
}

int runBenchSlab(const std::string& folder, const RunOptions& run) {
  const std::vector<std::string> files{"slab_bench.csv", "slab_bench.svg"};
  return runBench(folder, files, run, [](const Progress& progress) -> std::optional<BenchReport> {
    const SlabBench bench = benchSlabs(progress);
    if (bench.rows.empty()) return std::nullopt;
    return BenchReport{table(bench), json(bench), {slabBenchCsv(bench), slabBenchPlot(bench)}};
  });
}

}  // namespace

void addBench(CLI::App& app, RunOptions& options, int& status) {
  CLI::App* bench = addCommand(app, options, "bench", "Run time against error, as a table, CSV and a plot");
  auto folder = std::make_shared<std::string>("sunfleck-bench");
  auto scene = std::make_shared<SceneOptions>();
  const auto folderOption = [&](CLI::App& command, const std::string& files) {
    command.add_option("-o", *folder, "Folder for " + files + " (default sunfleck-bench)");
  };
  const auto slab = [folder, &options, &status] { status = runBenchSlab(*folder, options); };

  CLI::App* of_slab =
      addCommand(*bench, options, "slab", "Closed forms, tables and the exact solver of a slab (default)");
  folderOption(*of_slab, "slab_bench.csv and slab_bench.svg");
  of_slab->callback(slab);

  CLI::App* of_directions =
      addCommand(*bench, options, "directions", "The G-factor of a tree's cells by its number of sample directions");
  folderOption(*of_directions, "direction_bench.csv and direction_bench.svg");
  addSceneOptions(*of_directions, *scene);
  of_directions->callback(
      [scene, folder, &options, &status] { status = runBenchDirections(*scene, *folder, options); });

  auto trees = std::make_shared<std::size_t>(1024);
  auto rounds = std::make_shared<int>(3);
  CLI::App* of_stand = addCommand(*bench, options, "stand",
                                  "What stands of trees cost to prepare and to change, beside the paper's Table 4");
  folderOption(*of_stand, "stand_bench.csv and stand_bench.svg");
  of_stand->add_option("--trees", *trees, "Trees of the largest stand, 16 to 50000 (default 1024; 10000 take 1.3 GB)")
      ->transform(wholeNumberIn(16., 5e4, "a whole number, 16 to 50000"));
  of_stand
      ->add_option("--rounds", *rounds, "Rounds of stands of up to 64 trees, of which the median is told (default 3)")
      ->transform(wholeNumberIn(1., 100., "a whole number, 1 to 100"));
  of_stand->callback(
      [trees, rounds, folder, &options, &status] { status = runBenchStand(*trees, *rounds, *folder, options); });

  auto forest = std::make_shared<std::size_t>(1024);
  auto near = std::make_shared<std::size_t>(1000);
  CLI::App* of_forest =
      addCommand(*bench, options, "forest", "What the light field of stands of very many trees costs: time and memory");
  folderOption(*of_forest, "forest_bench.csv");
  of_forest->add_option("--trees", *forest, "Trees of the largest stand, 16 to 50000 (default 1024)")
      ->transform(wholeNumberIn(16., 5e4, "a whole number, 16 to 50000"));
  of_forest->add_option("--near", *near, "Trees whose leaves are solved one by one, 1 to 50000 (default 1000)")
      ->transform(wholeNumberIn(1., 5e4, "a whole number, 1 to 50000"));
  of_forest->callback(
      [forest, near, folder, &options, &status] { status = runBenchForest(*forest, *near, *folder, options); });

  auto pictures = std::make_shared<PictureBenchOptions>();
  CLI::App* of_pictures = addCommand(*bench, options, "pictures",
                                     "Pictures by each model against pictures by Monte Carlo, with their errors");
  folderOption(*of_pictures, "picture_bench.csv and a sheet of pictures for each scene");
  addPictureBenchOptions(*of_pictures, *pictures);
  of_pictures->callback(
      [pictures, folder, &options, &status] { status = runBenchPictures(*pictures, *folder, options); });

  auto of_light = std::make_shared<SceneBenchOptions>();
  CLI::App* of_scene = addCommand(*bench, options, "scene",
                                  "The light on a scene's leaves by each model and by Monte Carlo: run time and error");
  folderOption(*of_scene, "scene_bench.csv and scene_bench.svg");
  addSceneBenchOptions(*of_scene, *of_light);
  of_scene->callback([of_light, folder, &options, &status] { status = runBenchScene(*of_light, *folder, options); });

  folderOption(*bench, "slab_bench.csv and slab_bench.svg");
  bench->require_subcommand(0, 1);
  bench->callback([bench, slab] {
    if (bench->get_subcommands().empty()) slab();
  });
}

}  // namespace sunfleck::apps
