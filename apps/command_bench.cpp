#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/bench_directions.hpp"
#include "apps/commands.hpp"
#include "apps/output_folder.hpp"
#include "apps/terminal.hpp"
#include "core/whole_file.hpp"
#include "render/compare/slab_bench.hpp"

namespace sunfleck::apps {
namespace {

namespace fs = std::filesystem;

std::string table(const std::vector<SlabBenchPoint>& points) {
  std::string text = fmt::format("{:<10} {:>4} {:>8} {:>12} {:>13} {:>13} {:>15} {:>15}\n", "problem", "N", "delta-M",
                                 "corrections", "flux time", "flux error", "radiance time", "radiance error");
  for (const SlabBenchPoint& p : points)
    text += fmt::format("{:<10} {:>4} {:>8} {:>12} {:>10.3g} us {:>13.2g} {:>12.3g} us {:>15.2g}\n", p.problem,
                        p.settings.streams, p.settings.delta_m ? "on" : "off", p.settings.corrections ? "on" : "off",
                        1e6 * p.flux_seconds, p.flux_error, 1e6 * p.radiance_seconds, p.radiance_error);
  return text;
}

nlohmann::ordered_json json(const std::vector<SlabBenchPoint>& points) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SlabBenchPoint& p : points)
    rows.push_back({{"problem", p.problem},
                    {"streams", p.settings.streams},
                    {"delta_m", p.settings.delta_m},
                    {"corrections", p.settings.corrections},
                    {"flux_seconds", p.flux_seconds},
                    {"flux_error", p.flux_error},
                    {"radiance_seconds", p.radiance_seconds},
                    {"radiance_error", p.radiance_error}});
  return {{"rows", std::move(rows)}};
}

int runBenchSlab(const std::string& folder_name, const RunOptions& run) {
  const fs::path folder(folder_name);
  makeFolder(folder);
  requireWritable(folder / "slab_bench.csv");
  requireWritable(folder / "slab_bench.svg");
  const auto points = benchSlabs(terminalProgress("measuring", run.quiet));
  if (points.empty()) {
    fmt::print(stderr, "sunfleck: interrupted: nothing was written\n");
    return 1;
  }
  writeWhole(folder / "slab_bench.csv", slabBenchCsv(points));
  writeWhole(folder / "slab_bench.svg", slabBenchPlot(points));
  if (run.json)
    fmt::print("{}\n", json(points).dump(2));
  else
    fmt::print("{}\nwrote {} and slab_bench.svg\n", table(points), (folder / "slab_bench.csv").string());
  return 0;
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
      addCommand(*bench, options, "slab", "The plane-parallel solver by its number of streams (default)");
  folderOption(*of_slab, "slab_bench.csv and slab_bench.svg");
  of_slab->callback(slab);

  CLI::App* of_directions =
      addCommand(*bench, options, "directions", "The G-factor of a tree's cells by its number of sample directions");
  folderOption(*of_directions, "direction_bench.csv and direction_bench.svg");
  addSceneOptions(*of_directions, *scene);
  of_directions->callback(
      [scene, folder, &options, &status] { status = runBenchDirections(*scene, *folder, options); });

  folderOption(*bench, "slab_bench.csv and slab_bench.svg");
  bench->require_subcommand(0, 1);
  bench->callback([bench, slab] {
    if (bench->get_subcommands().empty()) slab();
  });
}

}  // namespace sunfleck::apps
