#include "apps/brf_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "apps/csv_rows.hpp"
#include "apps/number_text.hpp"
#include "apps/run_options.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {
namespace {

constexpr double kDegree = std::numbers::pi / 180.;
constexpr double kMostZenith = 89.;  // [degree]

BrfView viewOf(double zenith_deg, double azimuth_deg, std::string name) {
  return {.zenith_deg = zenith_deg,
          .azimuth_deg = azimuth_deg,
          .name = std::move(name),
          .direction = {.zenith = std::min(std::abs(zenith_deg) * kDegree, kMostViewZenith),
                        .azimuth = azimuth_deg * kDegree + (zenith_deg < 0. ? std::numbers::pi : 0.)}};
}

std::vector<BrfView> principalPlane(const std::string& range, const Scene& scene) {
  std::vector<double> numbers;
  for (const std::string_view field : fieldsOf(range, ":"))
    if (const std::optional<double> number = numberOf(field)) numbers.push_back(*number);
  const bool good = numbers.size() == 3 && std::abs(numbers[0]) <= kMostZenith && std::abs(numbers[1]) <= kMostZenith &&
                    numbers[0] <= numbers[1] && numbers[2] >= 0.01;
  if (!good || fieldsOf(range, ":").size() != 3)
    throw InvalidInput("--brf " + range +
                       ": must be FROM:TO:STEP, zeniths from -89 to 89 and a step of 0.01 or more, degrees");
  const auto [from, to, step] = std::tie(numbers[0], numbers[1], numbers[2]);
  std::vector<BrfView> views;
  const auto steps = static_cast<int>(std::floor((to - from) / step + 1e-6));
  for (int i = 0; i <= steps; ++i) {
    const double zenith = std::round((from + i * step) * 1e6) / 1e6 + 0.;  // no -0
    views.push_back(viewOf(zenith, double{scene.sun().azimuth} / kDegree, fmt::format("brf:{:g}", zenith)));
  }
  return views;
}

std::vector<BrfView> viewsOf(const std::string& file) {
  std::vector<BrfView> views;
  for (const auto& [where, fields] : readCsvRows(file, "zenith_deg,azimuth_deg")) {
    const double zenith = numberAt(fields[0], where), azimuth = numberAt(fields[1], where);
    require(std::abs(zenith) <= kMostZenith, where + "zenith_deg", zenith, "in [-89, 89]");
    require(std::abs(azimuth) <= 360., where + "azimuth_deg", azimuth, "in [-360, 360]");
    views.push_back(viewOf(zenith, azimuth, fmt::format("brf:{:g}:{:g}", zenith, azimuth)));
  }
  if (views.empty()) throw InvalidInput(file + ": must have at least one view");
  return views;
}

}  // namespace

std::vector<BrfView> brfViews(const BrfOptions& options, const Scene& scene) {
  if (options.asked() && !scene.stand.period)
    throw InvalidInput("reflectance factors: must be of a periodic stand, see --period");
  if (!options.range.empty()) return principalPlane(options.range, scene);
  if (!options.views.empty()) return viewsOf(options.views);
  for (const auto& [name, given] : {std::pair{"--brf-csv", !options.csv.empty()},
                                    std::pair{"--mes", !options.mes.empty()}, std::pair{"--only-brf", options.only}})
    if (given) throw InvalidInput(std::string(name) + ": must be with --brf or --brf-views");
  return {};
}

void addBrfOptions(CLI::App& command, BrfOptions& options) {
  CLI::Option* range = command.add_option(
      "--brf", options.range,
      "Tell reflectance factors of a periodic stand for view zeniths FROM:TO:STEP in the principal plane, degrees, "
      "positive on the sun's side; and the albedo");
  command.add_option("--brf-views", options.views, "The same for the views of a CSV file: zenith_deg,azimuth_deg")
      ->excludes(range);
  command.add_option("--brf-paths", options.paths, "Paths to each view (default 1e5)")
      ->check(numberIn(64., 1e13, "in [64, 1e13]"));
  command.add_option("--brf-csv", options.csv, "CSV to write: the reflectance factors and their standard errors");
  command
      .add_option("--mes", options.mes, "File of the form of the RAMI exercises to write (.mes): the same of one band")
      ->excludes("--all-bands");
  command.add_flag("--only-brf", options.only, "Trace the reflectance factors alone")
      ->excludes("--leaves")
      ->excludes("--picture")
      ->excludes("--only-picture");
}

}  // namespace sunfleck::apps
