#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
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
  if (folder_name.empty()) throw InvalidInput("-o: must not be empty");
  const fs::path folder(folder_name);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw InvalidInput(folder_name + ": cannot be made: " + failure.message());
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
  CLI::App* command = addCommand(app, options, "bench", "Run time against error, as a table, CSV and a plot");
  auto what = std::make_shared<std::string>("slab"), folder = std::make_shared<std::string>("sunfleck-bench");
  command->add_option("WHAT", *what, "slab: the plane-parallel solver by its number of streams (default)")
      ->check(CLI::IsMember({"slab"}));
  command->add_option("-o", *folder, "Folder for slab_bench.csv and slab_bench.svg (default sunfleck-bench)");
  command->callback([what, folder, &options, &status] { status = runBenchSlab(*folder, options); });
}

}  // namespace sunfleck::apps
