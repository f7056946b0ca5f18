#include "apps/bench_directions.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/bench_run.hpp"
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

int runBenchDirections(const SceneOptions& options, const std::string& folder, const RunOptions& run) {
  const Scene scene = readScene(options);
  const std::vector<std::string> files{"direction_bench.csv", "direction_bench.svg"};
  return runBench(folder, files, run, [&](const Progress& progress) -> std::optional<BenchReport> {
    const auto points = benchDirections(scene, run.seed, progress);
    if (points.empty()) return std::nullopt;
    return BenchReport{
        table(points), json(points), {directionBenchCsv(points), directionBenchPlot(points, scene.name)}};
  });
}

}  // namespace sunfleck::apps
