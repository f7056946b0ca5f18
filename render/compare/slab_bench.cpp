#include "render/compare/slab_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "render/compare/log_plot.hpp"
#include "render/compare/slab_models.hpp"

namespace sunfleck {
namespace {

constexpr std::array kMus{-1., -0.6, -0.2, 0.2, 0.6, 1.};
constexpr std::array kPhis{0., 0.5 * std::numbers::pi, std::numbers::pi};
constexpr int kReferenceStreams = 256;

struct SlabProblem {
  const char* name;
  pp::SlabCase slab;
};
constexpr std::array kProblems{
    SlabProblem{"forward", {.asymmetry = 0.85, .albedo = 0.99, .thickness = 10., .mu0 = 0.5}},
    SlabProblem{"isotropic", {.asymmetry = 0., .albedo = 0.99, .thickness = 10., .mu0 = 0.5}},
};

struct SlabValues {
  double reflectance = 0., transmittance = 0.;
  std::vector<double> radiances = std::vector<double>(3 * kMus.size() * kPhis.size());
};

void solveFluxes(pp::Solver& solver, const pp::Problem& problem, SlabValues& values) {
  solver.solve(problem);
  values.reflectance = solver.reflectance();
  values.transmittance = solver.transmittance();
}

void solveRadiances(pp::Solver& solver, const pp::Problem& problem, SlabValues& values) {
  const double thickness = problem.layers.front().thickness;
  const std::array depths{0., 0.5 * thickness, thickness};
  solver.solve(problem);
  solver.radiances(depths, kMus, kPhis, values.radiances);
}

// Seconds that `work` takes: the median of at least 5 and at most 51 repeats within a tenth of a second, after one that
// brings memory and caches into place. Short work is repeated within a repeat, to be far above the clock's grain.
template <typename Work>
double medianSeconds(const Work& work) {
  using Clock = std::chrono::steady_clock;
  const auto timed = [&](int times) {
    const auto start = Clock::now();
    for (int i = 0; i < times; ++i) work();
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const double first = std::min(timed(1), timed(1));
  const int times = first < 2e-4 ? static_cast<int>(2e-4 / std::max(first, 1e-7)) + 1 : 1;
  std::vector<double> seconds;
  for (double spent = 0.; seconds.size() < 5 || (spent < 0.1 && seconds.size() < 51);) {
    seconds.push_back(timed(times) / times);
    spent += seconds.back() * times;
  }
  std::ranges::nth_element(seconds, seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2));
  return seconds[seconds.size() / 2];
}

double relativeRms(const std::vector<double>& values, const std::vector<double>& exact) {
  double deviation = 0., size = 0.;
  for (std::size_t i = 0; i < values.size(); ++i) {
    deviation += (values[i] - exact[i]) * (values[i] - exact[i]);
    size += exact[i] * exact[i];
  }
  return std::sqrt(deviation / size);
}

SlabBenchPoint measured(const SlabProblem& given, const pp::Settings& settings, const SlabValues& exact) {
  const pp::Problem problem = homogeneousSlab(given.slab).problem;
  pp::Solver solver(settings);
  SlabValues values;
  SlabBenchPoint point{.problem = given.name, .slab = given.slab, .settings = settings};
  point.flux_seconds = medianSeconds([&] { solveFluxes(solver, problem, values); });
  point.radiance_seconds = medianSeconds([&] { solveRadiances(solver, problem, values); });
  point.flux_error =
      std::max(std::abs(values.reflectance - exact.reflectance), std::abs(values.transmittance - exact.transmittance));
  point.radiance_error = relativeRms(values.radiances, exact.radiances);
  return point;
}

const char* onOff(bool on) {
  return on ? "on" : "off";
}

// Errors of rounding alone would stretch the axis without telling anything.
constexpr double kFloor = 1e-16;

LogPanel panelOf(const std::vector<SlabBenchPoint>& points, const SlabProblem& problem, bool radiance) {
  struct Way {
    bool delta_m, corrections;
    const char *label, *colour;
  };
  static constexpr std::array ways{Way{true, true, "delta-M and corrections", "#1b7837"},
                                   Way{true, false, "delta-M", "#2166ac"}, Way{false, true, "corrections", "#e08214"},
                                   Way{false, false, "neither", "#b2182b"}};
  LogPanel panel{
      .title = fmt::format("{}, {} (g {:g}, omega {:g}, thickness {:g}, mu0 {:g})", radiance ? "Radiance" : "Fluxes",
                           problem.name, problem.slab.asymmetry, problem.slab.albedo, problem.slab.thickness,
                           problem.slab.mu0),
      .x_title = "time of one solution on one thread [s]",
      .y_title = radiance ? "RMS error of radiance, relative [1]" : "error of reflectance, transmittance [1]",
      .curves = {}};
  for (const Way& way : ways) {
    if (!radiance && !way.corrections) continue;  // fluxes do not know of corrections
    LogCurve curve{.label = way.label, .colour = way.colour, .dashed = !way.corrections, .points = {}};
    for (const SlabBenchPoint& p : points)
      if (p.problem == problem.name && p.settings.delta_m == way.delta_m && p.settings.corrections == way.corrections)
        curve.points.push_back({.x = radiance ? p.radiance_seconds : p.flux_seconds,
                                .y = std::max(kFloor, radiance ? p.radiance_error : p.flux_error),
                                .mark = way.delta_m && way.corrections ? std::to_string(p.settings.streams) : ""});
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
  return panel;
}

}  // namespace

std::vector<SlabBenchPoint> benchSlabs(const Progress& progress) {
  std::vector<SlabBenchPoint> points;
  double done = 0.;
  constexpr double kSteps = 2. + 5. * 7.;
  for (const SlabProblem& given : kProblems) {
    const pp::Problem problem = homogeneousSlab(given.slab).problem;
    pp::Solver reference({.streams = kReferenceStreams});
    SlabValues exact;
    solveFluxes(reference, problem, exact);
    solveRadiances(reference, problem, exact);
    if (!goOn(progress, ++done / kSteps)) return {};
    for (const bool delta_m : {true, false})
      for (const bool corrections : {true, false})
        for (int streams = 2; streams <= 128; streams *= 2) {
          if (given.slab.asymmetry == 0. && !(delta_m && corrections)) continue;
          points.push_back(
              measured(given, {.streams = streams, .delta_m = delta_m, .corrections = corrections}, exact));
          if (!goOn(progress, ++done / kSteps)) return {};
        }
  }
  return points;
}

std::string slabBenchCsv(const std::vector<SlabBenchPoint>& points) {
  std::string csv =
      "problem,g,omega,thickness,mu0,model,streams,delta_m,corrections,flux_seconds,flux_error,radiance_seconds,"
      "radiance_error\n";
  for (const SlabBenchPoint& p : points)
    csv +=
        fmt::format("{},{},{},{},{},pp,{},{},{},{:.4g},{:.4g},{:.4g},{:.4g}\n", p.problem, p.slab.asymmetry,
                    p.slab.albedo, p.slab.thickness, p.slab.mu0, p.settings.streams, onOff(p.settings.delta_m),
                    onOff(p.settings.corrections), p.flux_seconds, p.flux_error, p.radiance_seconds, p.radiance_error);
  return csv;
}

std::string slabBenchPlot(const std::vector<SlabBenchPoint>& points) {
  std::vector<LogPanel> panels;
  for (const SlabProblem& problem : kProblems)
    for (const bool radiance : {false, true}) panels.push_back(panelOf(points, problem, radiance));
  return logPlot("Exact plane-parallel solver: run time against error; numbers are streams N; reference N = 256",
                 panels, 2);
}

}  // namespace sunfleck
