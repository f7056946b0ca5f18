#include "apps/bench_directions.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/output_folder.hpp"
#include "apps/terminal.hpp"
#include "core/whole_file.hpp"
#include "render/compare/direction_bench.hpp"

namespace sunfleck::apps {
namespace {

const char* setOf(const DirectionBenchPoint& point) {
  return point.spread ? "spread" : "random";
}

std::string table(const std::vector<DirectionBenchPoint>& points) {
  std::string text =
      fmt::format("{:>10} {:>8} {:>10} {:>10} {:>14}\n", "directions", "set", "time", "RMS error", "largest error");
  for (const DirectionBenchPoint& p : points)
    text += fmt::format("{:>10} {:>8} {:>7.0f} ms {:>10.4f} {:>14.3f}\n", p.directions, setOf(p), 1e3 * p.seconds,
                        p.rms_error, p.largest_error);
  return text;
}

nlohmann::ordered_json json(const std::vector<DirectionBenchPoint>& points) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const DirectionBenchPoint& p : points)
    rows.push_back({{"directions", p.directions},
                    {"set", setOf(p)},
                    {"seconds", p.seconds},
                    {"rms_error", p.rms_error},
                    {"largest_error", p.largest_error}});
  return {{"rows", std::move(rows)}};
}

}  // namespace

int runBenchDirections(const SceneOptions& options, const std::string& folder_name, const RunOptions& run) {
  const Scene scene = readScene(options);
  const std::filesystem::path folder(folder_name);
  const OutputFolder made(folder);
  const auto csv = folder / "direction_bench.csv", svg = folder / "direction_bench.svg";
  requireWritable(csv);
  requireWritable(svg);
  const auto points = benchDirections(scene, run.seed, terminalProgress("measuring", run.quiet));
  if (points.empty()) {
    fmt::print(stderr, "sunfleck: interrupted: nothing was written\n");
    return 1;
  }
  writeWhole(csv, directionBenchCsv(points));
  writeWhole(svg, directionBenchPlot(points, scene.name));
  if (run.json)
    fmt::print("{}\n", json(points).dump(2));
  else
    fmt::print("{}\nwrote {} and {}\n", table(points), csv.string(), svg.filename().string());
  return 0;
}

}  // namespace sunfleck::apps
