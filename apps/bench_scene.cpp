#include "apps/bench_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/output_folder.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/compare/validation.hpp"

namespace sunfleck::apps {
namespace {

namespace fs = std::filesystem;

// The fewest that are traced, which the tracer's own units want.
constexpr double kFewest = static_cast<double>(kLeastUnits);

std::string nameOfRow(const SceneBenchRow& row) {
  return row.setting > 0. ? row.method + " " + countText(row.setting) : row.method;
}

std::string secondsText(double seconds) {
  return seconds < 1. ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} s", seconds);
}

// An error as far as it stands out of the noise.
std::string errorText(double with_noise, double without_noise, double noise) {
  return fmt::format("{}{:.2f} %", noisy(with_noise, noise) ? "~" : "", 100. * without_noise);
}

// Where Monte Carlo and this cross: between its own time and that of Monte Carlo, this is the more accurate.
std::string ahead(double own, const std::optional<double>& monte_carlo) {
  if (!monte_carlo) return "-";
  return *monte_carlo <= own ? "nowhere" : fmt::format("{} .. {}", secondsText(own), secondsText(*monte_carlo));
}

std::string table(const SceneBench& bench) {
  std::string text = fmt::format(
      "{}: {} leaves; {}\nMonte Carlo, the reference: {:.3g} million paths in {:.3g} s, noise {:.2f} % of categories, "
      "{:.2f} % of leaves\n\n{:<22} {:>10} {:>10} {:>9} {:>18} {:>18}   {:<22} {}\n",
      bench.scene, bench.leaves, bench.machine, 1e-6 * static_cast<double>(bench.reference_paths),
      bench.reference_seconds, 100. * bench.category_noise, 100. * bench.leaf_noise, "method", "error", "per leaf",
      "bias", "CPU (wall) time", "sun turned", "crosses Monte Carlo", "by leaves");
  for (const SceneBenchRow& r : bench.rows) {
    const auto times = [](const SceneBenchTime& time) {
      return fmt::format("{} ({})", secondsText(time.cpu), secondsText(time.wall));
    };
    text += fmt::format("{:<22} {:>10} {:>10} {:>+7.2f} % {:>18} {:>18}   {:<22} {}\n", nameOfRow(r),
                        errorText(r.weighted, r.weighted_without_noise, bench.category_noise),
                        errorText(r.leaf, r.leaf_without_noise, bench.leaf_noise), 100. * r.bias, times(r.from_nothing),
                        times(r.sun_turned), ahead(r.from_nothing.cpu, r.monte_carlo),
                        ahead(r.from_nothing.cpu, r.monte_carlo_leaf));
  }
  return text + R"(
Error: RMS over categories of depth, each by its leaves, the reference's noise taken off; ~: that noise is more than a
fifth of it. Times from nothing but the meshes, and again after the sun has turned. Crosses Monte Carlo: the CPU times
between which the method is more accurate than Monte Carlo in the same time, by categories and by single leaves.
)";
}

nlohmann::ordered_json json(const SceneBench& bench) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SceneBenchRow& r : bench.rows) {
    nlohmann::ordered_json& row =
        rows.emplace_back(nlohmann::ordered_json{{"method", r.method},
                                                 {"setting", nullptr},
                                                 {"cpu_seconds", r.from_nothing.cpu},
                                                 {"wall_seconds", r.from_nothing.wall},
                                                 {"sun_turned_cpu_seconds", r.sun_turned.cpu},
                                                 {"sun_turned_wall_seconds", r.sun_turned.wall},
                                                 {"rms_weighted_without_noise", r.weighted_without_noise},
                                                 {"rms_weighted", r.weighted},
                                                 {"rms_category", r.category},
                                                 {"rms_leaf_without_noise", r.leaf_without_noise},
                                                 {"rms_leaf", r.leaf},
                                                 {"bias", r.bias},
                                                 {"monte_carlo_cpu_seconds", nullptr},
                                                 {"monte_carlo_leaf_cpu_seconds", nullptr}});
    if (r.setting > 0.) row["setting"] = r.setting;
    if (r.monte_carlo) row["monte_carlo_cpu_seconds"] = *r.monte_carlo;
    if (r.monte_carlo_leaf) row["monte_carlo_leaf_cpu_seconds"] = *r.monte_carlo_leaf;
  }
  return {{"machine", bench.machine},
          {"scene", bench.scene},
          {"leaves", bench.leaves},
          {"leaves_left_out", bench.leaves_left_out},
          {"reference_paths", bench.reference_paths},
          {"reference_seconds", bench.reference_seconds},
          {"noise_weighted", bench.category_noise},
          {"noise_leaf", bench.leaf_noise},
          {"rows", std::move(rows)}};
}

SceneBenchEffort effortOf(const SceneBenchOptions& options, const RunOptions& run) {
  SceneBenchEffort effort = options.effort;
  effort.reference = {.paths = static_cast<std::uint64_t>(options.reference), .seed = run.seed, .threads = run.threads};
  constexpr int kRuns = 5;
  double paths = options.reference;
  for (int i = 0; i < kRuns && options.paths.empty() && paths / 4. >= kFewest; ++i)
    effort.paths.insert(effort.paths.begin(), static_cast<std::uint64_t>(paths /= 4.));
  for (const double given : options.paths) effort.paths.push_back(static_cast<std::uint64_t>(given));
  std::ranges::sort(effort.paths);
  for (std::size_t i = 0; i < effort.paths.size(); ++i) {
    require(effort.paths[i] < effort.reference.paths, "--paths", effort.paths[i],
            "fewer than the reference's, --reference");
    require(i == 0 || effort.paths[i] != effort.paths[i - 1], "--paths", effort.paths[i], "given once");
  }
  return effort;
}

}  // namespace

void addSceneBenchOptions(CLI::App& command, SceneBenchOptions& options) {
  addSceneOptions(command, options.scene);
  command
      .add_option("--reference", options.reference,
                  "Paths of Monte Carlo that all are held against (default 1.6e7; the noise goes with their root)")
      ->check(numberIn(64., 1e13, "in [64, 1e13]"));
  command
      .add_option(
          "--paths", options.paths,
          "Paths of Monte Carlo as one of those that are judged, one or more numbers (default: a quarter of the "
          "reference's, a quarter of that, five times)")
      ->check(numberIn(64., 1e13, "in [64, 1e13]"));
  command
      .add_option("--rounds", options.effort.rounds,
                  "Rounds in which each has its turn; the median time is told (default 3)")
      ->transform(wholeNumberIn(1., 1000., "a whole number, 1 to 1000"));
  command
      .add_option("--band", options.effort.band,
                  "Band of the scene's optics: 0, 1 or 2, red, green or blue (default 0)")
      ->transform(wholeNumberIn(0., 2., "0, 1 or 2"));
  command.add_flag("--with-wood", options.effort.with_wood,
                   "Let wood stop light in Monte Carlo and in the field; the other models know leaves only");
}

int runBenchScene(const SceneBenchOptions& options, const std::string& folder_name, const RunOptions& run) {
  const SceneBenchEffort effort = effortOf(options, run);
  const Scene scene = readScene(options.scene);
  judgedModels(scene, effort.band);
  const fs::path folder(folder_name);
  const OutputFolder made(folder);
  const auto csv = folder / "scene_bench.csv", svg = folder / "scene_bench.svg";
  requireWritable(csv);
  requireWritable(svg);
  SceneBench bench;
  try {
    bench = benchScene(scene, effort, terminalProgress("measuring " + scene.name, run.quiet));
  } catch (const std::runtime_error&) {
    if (!interrupted()) throw;
  }
  if (bench.rows.empty()) {
    fmt::print(stderr, "sunfleck: interrupted: nothing was written\n");
    return 1;
  }
  writeWhole(csv, sceneBenchCsv(bench));
  writeWhole(svg, sceneBenchPlot(bench));
  if (run.json)
    fmt::print("{}\n", json(bench).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  else
    fmt::print("{}\nwrote {} and {}\n", table(bench), csv.string(), svg.filename().string());
  return 0;
}

}  // namespace sunfleck::apps
