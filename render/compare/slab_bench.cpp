#include "render/compare/slab_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>
#include <stdexcept>

#include "render/compare/log_plot.hpp"
#include "render/compare/machine_name.hpp"
#include "render/compare/slab_contestants.hpp"

namespace sunfleck {
namespace {

using Kind = NamedContestant::Kind;
using Answer = SlabContestant::Answer;
constexpr int kReferenceStreams = 128;
constexpr int kRounds = 15;
constexpr double kTurnSeconds = 1e-3;  // far above the clock's grain

void addErrors(const SlabCourse& course, const Answer& found, const Answer& exact, SlabBenchRow& row) {
  double deviation = 0., size = 0.;
  for (std::size_t i = 0; i < exact.powers.size(); ++i) {
    deviation += std::pow(found.powers[i] - exact.powers[i], 2);
    size += std::pow(exact.powers[i], 2);
  }
  row.irradiance_error = std::sqrt(deviation / size);
  row.flux_error = found.flux_up.empty() ? std::numeric_limits<double>::quiet_NaN() : 0.;
  for (std::size_t i = 0; i < found.flux_up.size(); ++i)
    row.flux_error = std::max({row.flux_error, std::abs(found.flux_up[i] - exact.flux_up[i]),
                               std::abs(found.flux_down[i] - exact.flux_down[i])});
  double radiance = 0.;
  for (std::size_t i = 0; i < exact.radiances.size(); ++i)
    radiance += course.sphere.weights[i / course.sphere.phis.size() % course.sphere.mus.size()] *
                std::pow(found.radiances[i] - exact.radiances[i], 2);
  row.radiance_error = std::sqrt(radiance / static_cast<double>(course.places() * course.sphere.phis.size()));
  if (!(row.irradiance_error < 1. && row.radiance_error < 0.2))
    throw std::runtime_error(fmt::format("{}: is no approximation: {:.3g} off in irradiance, {:.3g} in radiance",
                                         row.model, row.irradiance_error, row.radiance_error));
}

// What this thread has had of a processor: other programs do not count.
double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Seconds of one evaluation, by as many as fill a turn; NaN: there is none. The clock, which is slow, is seldom asked.
template <typename Work>
double timedTurn(const Work& work) {
  std::size_t evaluations = 0;
  const double start = threadSeconds();
  for (int times = 1;; times *= 2) {
    for (int i = 0; i < times; ++i) evaluations += work();
    if (evaluations == 0) return std::numeric_limits<double>::quiet_NaN();
    const double seconds = threadSeconds() - start;
    if (seconds >= kTurnSeconds) return seconds / static_cast<double>(evaluations);
  }
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

bool race(std::vector<NamedContestant>& contestants, std::vector<SlabBenchRow>& rows, const Progress& progress) {
  std::vector<std::vector<double>> powers(rows.size()), radiances(rows.size()), batches(rows.size());
  for (int round = -1; round < kRounds; ++round) {  // the first brings memory and caches into place
    for (std::size_t i = 0; i < rows.size(); ++i) {
      SlabContestant& contestant = *contestants[i].contestant;
      const double power = timedTurn([&] { return contestant.evaluatePowers(); });
      const double radiance = timedTurn([&] { return contestant.evaluateRadiances(); });
      const double batch = timedTurn([&] { return contestant.evaluateBatch(); });
      if (round < 0) continue;
      powers[i].push_back(power);
      radiances[i].push_back(radiance);
      batches[i].push_back(batch);
    }
    if (!goOn(progress, static_cast<double>(round + 2) / (kRounds + 1))) return false;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].power_seconds = median(powers[i]);
    rows[i].radiance_seconds = median(radiances[i]);
    rows[i].batch_seconds = median(batches[i]);
  }
  return true;
}

std::string kindName(Kind kind) {
  return kind == Kind::kTier ? "closed form" : kind == Kind::kTable ? "table" : "exact";
}

// What is written beside a point, and the curve it belongs to.
std::string markOf(const SlabBenchRow& row) {
  if (row.kind == "exact") return fmt::format("N = {}", row.streams);
  if (row.azimuth_orders > 0) return fmt::format("n = {}", row.streams);
  static const std::map<std::string, std::string> kNames{
      {"spp", "SPP"}, {"sppr", "SPP, refined"}, {"twostream", "two-stream"}};
  const auto found = kNames.find(row.model);
  return found == kNames.end() ? row.model : found->second;
}
int curveOf(const SlabBenchRow& row, bool radiance) {
  if (row.kind == "exact") return 5;
  if (row.kind == "table") return 4;
  if (row.azimuth_orders == 0) return 0;
  if (!radiance || row.azimuth_orders == 1) return 1;
  return row.azimuth_orders == 2 && row.streams > 1 ? 2 : 3;
}

enum class Shown { kIrradiance, kRadiance, kFluxes };

LogPanel panelOf(const SlabBench& bench, Shown shown) {
  const bool radiance = shown == Shown::kRadiance;
  LogPanel panel{.title = radiance                  ? "Radiance in one direction"
                          : shown == Shown::kFluxes ? "Fluxes up and down"
                                                    : "Irradiance of a leaf (P+ and P-)",
                 .x_title = "time of one evaluation on one thread",
                 .y_title = radiance                  ? "RMS error of radiance, beam of irradiance 1 [1/sr]"
                            : shown == Shown::kFluxes ? "largest error of a flux, relative to what arrives [1]"
                                                      : "RMS error of irradiance, relative [1]",
                 .x_seconds = true,
                 .curves = {{.label = "two halves", .colour = "#b2182b", .joined = false},
                            {.label = radiance ? "n streams, mean over the azimuth" : "n streams of each half",
                             .colour = "#e08214"},
                            {.label = "n streams, two azimuth orders", .colour = "#7b3294"},
                            {.label = "n streams, all azimuth orders", .colour = "#1b7837"},
                            {.label = "table, made once for a medium", .colour = "#666666"},
                            {.label = "exact solver, N streams", .colour = "#2166ac"},
                            {.label = "exact solver, faces of many slabs at once", .colour = "#35978f"}}};
  for (const SlabBenchRow& row : bench.rows) {
    if (!radiance && !row.own_powers) continue;
    if (shown == Shown::kFluxes && std::isnan(row.flux_error)) continue;
    panel.curves[static_cast<std::size_t>(curveOf(row, radiance))].points.push_back(
        {.x = radiance ? row.radiance_seconds : row.power_seconds,
         .y = radiance                  ? row.radiance_error
              : shown == Shown::kFluxes ? row.flux_error
                                        : row.irradiance_error,
         .mark = markOf(row)});
    if (shown == Shown::kFluxes && row.kind == "exact")
      panel.curves.back().points.push_back({.x = row.batch_seconds, .y = row.flux_error, .mark = markOf(row)});
  }
  std::erase_if(panel.curves, [](const LogCurve& curve) { return curve.points.empty(); });
  return panel;
}

std::string orEmpty(double value) {
  return std::isnan(value) ? "" : fmt::format("{:.4g}", value);
}

}  // namespace

SlabBench benchSlabs(const Progress& progress) {
  const SlabCourse course = slabCourse();
  constexpr double kMaking = 0.6;  // share of the time that tables take
  std::vector<NamedContestant> contestants =
      slabContestants(course, [&](double done) { return goOn(progress, kMaking * done); });
  if (contestants.empty()) return {};
  const Answer exact = exactContestant(course, kReferenceStreams)->answer();
  SlabBench bench{.machine = machineName(), .rows = {}};
  for (NamedContestant& entry : contestants) {
    bench.rows.push_back({.model = entry.name,
                          .kind = kindName(entry.kind),
                          .streams = entry.streams,
                          .azimuth_orders = entry.azimuth_orders,
                          .own_powers = entry.own_powers});
    addErrors(course, entry.contestant->answer(), exact, bench.rows.back());
  }
  if (!race(contestants, bench.rows, [&](double done) { return goOn(progress, kMaking + (1. - kMaking) * done); }))
    return {};
  return bench;
}

std::string slabBenchCsv(const SlabBench& bench) {
  std::string csv =
      "model,kind,streams,azimuth_orders,power_seconds,irradiance_error,flux_error,radiance_seconds,radiance_error,"
      "batch_seconds\n";
  for (const SlabBenchRow& row : bench.rows)
    csv += fmt::format("{},{},{},{},{:.4g},{:.4g},{},{:.4g},{:.4g},{}\n", row.model, row.kind, row.streams,
                       row.azimuth_orders, row.power_seconds, row.irradiance_error, orEmpty(row.flux_error),
                       row.radiance_seconds, row.radiance_error, orEmpty(row.batch_seconds));
  return csv;
}

std::string slabBenchPlot(const SlabBench& bench) {
  return logPlot(
      "Light in a slab: run time against error",
      fmt::format(
          "Twelve slabs (omega 0.95; g 0, 0.5; thickness 1, 4, 16; mu0 1, 0.5), five depths each; {}.\n"
          "Closed forms: an evaluation within arrays of places of one medium and beam (SIMD), whose constants are "
          "at hand. Tables: a look-up. Exact: a solution for each evaluation.",
          bench.machine),
      {panelOf(bench, Shown::kIrradiance), panelOf(bench, Shown::kRadiance), panelOf(bench, Shown::kFluxes)}, 2);
}

}  // namespace sunfleck
