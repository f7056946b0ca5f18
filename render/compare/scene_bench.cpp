#include "render/compare/scene_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "core/require.hpp"
#include "render/compare/log_plot.hpp"
#include "render/compare/machine_name.hpp"
#include "render/compare/validation.hpp"

namespace sunfleck {
namespace {

const std::string kMonteCarlo = "monte_carlo", kField = "field", kGrid = "grid";

double secondsBy(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <typename Work>
SceneBenchTime timeOf(const Work& work) {
  const double cpu = secondsBy(CLOCK_PROCESS_CPUTIME_ID), wall = secondsBy(CLOCK_MONOTONIC);
  work();
  return {secondsBy(CLOCK_PROCESS_CPUTIME_ID) - cpu, secondsBy(CLOCK_MONOTONIC) - wall};
}

SceneBenchTime median(std::vector<SceneBenchTime> times) {
  const std::size_t middle = times.size() / 2;
  SceneBenchTime result;
  std::ranges::sort(times, {}, &SceneBenchTime::cpu);
  result.cpu = times[middle].cpu;
  std::ranges::sort(times, {}, &SceneBenchTime::wall);
  result.wall = times[middle].wall;
  return result;
}

double without(double squares, double noise) {
  return std::sqrt(std::max(squares - noise * noise, 0.));
}

// Of several answers.
class ErrorSums {
 public:
  void add(const ModelErrors& errors) {
    category_ += std::pow(*errors.rms_category, 2);
    weighted_ += std::pow(*errors.rms_weighted, 2);
    leaf_ += std::pow(*errors.rms_leaf, 2);
    bias_ += *errors.bias;
    ++count_;
  }
  void tell(const SceneBench& bench, SceneBenchRow& row) const {
    row.category = std::sqrt(category_ / count_);
    row.weighted = std::sqrt(weighted_ / count_);
    row.leaf = std::sqrt(leaf_ / count_);
    row.bias = bias_ / count_;
    row.weighted_without_noise = without(weighted_ / count_, bench.category_noise);
    row.leaf_without_noise = without(leaf_ / count_, bench.leaf_noise);
  }

 private:
  double category_ = 0., weighted_ = 0., leaf_ = 0., bias_ = 0.;
  int count_ = 0;
};

void addCrossings(std::vector<SceneBenchRow>& rows) {
  const auto course = [&](double SceneBenchRow::*error) {
    std::vector<TracePoint> points;
    for (const SceneBenchRow& row : rows)
      if (row.method == kMonteCarlo && row.*error > 0.)
        points.push_back({.paths = row.setting, .seconds = row.from_nothing.cpu, .error = row.*error});
    return points.empty() ? std::nullopt : std::optional(traceCourse(points));
  };
  const auto by_category = course(&SceneBenchRow::weighted_without_noise);
  const auto by_leaf = course(&SceneBenchRow::leaf_without_noise);
  for (SceneBenchRow& row : rows) {
    if (row.method == kMonteCarlo) continue;
    if (by_category && row.weighted_without_noise > 0.)
      row.monte_carlo = by_category->timeOf(row.weighted_without_noise);
    if (by_leaf && row.leaf_without_noise > 0.) row.monte_carlo_leaf = by_leaf->timeOf(row.leaf_without_noise);
  }
}

std::string orEmpty(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "";
}

std::size_t curveOf(const SceneBenchRow& row) {
  if (row.method == kMonteCarlo) return 1;
  if (row.method == kGrid) return 3;
  return row.method == kField ? 2 : 0;
}

struct Shown {
  const char *title, *x_title, *y_title;
  SceneBenchTime SceneBenchRow::*time;
  double SceneBenchTime::*clock;
  double SceneBenchRow::*error;
};

LogPanel panelOf(const SceneBench& bench, const Shown& shown) {
  LogPanel panel{.title = shown.title,
                 .x_title = shown.x_title,
                 .y_title = shown.y_title,
                 .x_seconds = true,
                 .curves = {{.label = "closed forms and single scattering", .colour = "#b2182b", .joined = false},
                            {.label = "Monte Carlo, by its paths", .colour = "#2166ac"},
                            {.label = "light field, by its axes", .colour = "#1b7837"},
                            {.label = "field on cells alone, by their number along the tree", .colour = "#e08214"}}};
  for (const SceneBenchRow& row : bench.rows)
    panel.curves[curveOf(row)].points.push_back({.x = row.*shown.time.*shown.clock,
                                                 .y = row.*shown.error,
                                                 .mark = row.setting > 0. ? countText(row.setting) : row.method});
  std::erase_if(panel.curves, [](const LogCurve& curve) { return curve.points.empty(); });
  return panel;
}

}  // namespace

std::string countText(double count) {
  if (count < 1e3) return fmt::format("{:.3g}", count);
  return count < 1e6 ? fmt::format("{:.3g} k", 1e-3 * count) : fmt::format("{:.3g} M", 1e-6 * count);
}

// (F25)
TraceCourse traceCourse(const std::vector<TracePoint>& points) {
  const auto [fewest, most] = std::ranges::minmax_element(points, {}, &TracePoint::paths);
  TraceCourse course;
  if (most->paths > fewest->paths)
    course.by_path = std::max((most->seconds - fewest->seconds) / (most->paths - fewest->paths), 0.);
  if (course.by_path == 0.) course.by_path = most->seconds / most->paths;
  course.start = std::max(most->seconds - most->paths * course.by_path, 0.);
  double sum = 0.;
  for (const TracePoint& point : points) sum += point.paths * point.error * point.error;
  course.one_path = std::sqrt(sum / static_cast<double>(points.size()));
  return course;
}

SceneBench benchScene(const Scene& scene, const SceneBenchEffort& effort, const Progress& progress) {
  const std::vector<Model> models = judgedModels(scene, effort.band);
  std::vector<NamedSceneContestant> contestants =
      sceneContestants(scene, models, effort.geometry, effort.paths, effort.reference, effort.band, effort.with_wood);
  const auto reference_work = static_cast<double>(effort.reference.paths);
  double work = reference_work, done = 0.;
  for (const NamedSceneContestant& one : contestants) work += effort.rounds * one.work;
  // Of a part of the work, whose own progress counts to where that is told.
  const auto part = [&](double of_work) {
    return Progress([&, of_work](double share) { return goOn(progress, (done + share * of_work) / work); });
  };
  const Progress still = part(0.);

  SceneBench bench{.machine = machineName(), .scene = scene.name};
  std::vector<Category> by_depth;
  {
    StandGeometry stand(effort.geometry);
    stand.update(scene, needsOf(Model::ss), std::nullopt, still);
    by_depth = categories(meanDepths(leafGeometry(scene, stand, still)));
  }
  for (const TreeKind& kind : scene.kinds) bench.leaves += kind.mesh->leaf_count;
  bench.leaves_left_out = bench.leaves;
  for (const Category& category : by_depth) bench.leaves_left_out -= category.leaves.size();
  const ForwardResult reference = traceForward(RayScene(meshes(scene), scene.stand, effort.with_wood),
                                               traceLight(scene, effort.band), effort.reference, part(reference_work));
  done += reference_work;
  if (!goOn(progress, done / work)) return {};
  bench.reference_paths = reference.paths;
  bench.reference_seconds = reference.seconds;
  const std::optional<double> noise = categoryNoise(reference.leaf_irradiance, reference.leaf_standard_error, by_depth);
  if (!noise)
    throw InvalidInput((scene.origin.empty() ? "" : scene.origin + ": ") +
                       "leaves = dark or in categories of fewer than 5: must be lit, and be enough to compare");
  bench.category_noise = *noise;
  bench.leaf_noise = *referenceNoise(reference.leaf_irradiance, reference.leaf_standard_error);

  std::vector<ErrorSums> errors(contestants.size());
  std::vector<std::vector<SceneBenchTime>> from_nothing(contestants.size()), sun_turned(contestants.size());
  for (int round = 0; round < effort.rounds; ++round)
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      SceneContestant& contestant = *contestants[i].contestant;
      std::vector<float> first, second;
      from_nothing[i].push_back(timeOf([&] { first = contestant.fromNothing(round, still); }));
      if (!goOn(progress, (done + 0.5 * contestants[i].work) / work)) return {};
      contestant.turnAway(still);
      sun_turned[i].push_back(timeOf([&] { second = contestant.sunTurned(round, still); }));
      done += contestants[i].work;
      if (!goOn(progress, done / work)) return {};
      for (const std::vector<float>& answer : {first, second})
        errors[i].add(modelErrors(answer, reference.leaf_irradiance, by_depth));
    }
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    SceneBenchRow& row = bench.rows.emplace_back();
    row.method = contestants[i].method;
    row.setting = contestants[i].setting;
    row.from_nothing = median(from_nothing[i]);
    row.sun_turned = median(sun_turned[i]);
    errors[i].tell(bench, row);
  }
  addCrossings(bench.rows);
  return bench;
}

std::string sceneBenchCsv(const SceneBench& bench) {
  std::string csv =
      "method,setting,cpu_s,wall_s,sun_turned_cpu_s,sun_turned_wall_s,rms_weighted_without_noise,rms_weighted,"
      "rms_category,rms_leaf_without_noise,rms_leaf,bias,noise_weighted,noise_leaf,monte_carlo_cpu_s,"
      "monte_carlo_leaf_cpu_s\n";
  for (const SceneBenchRow& r : bench.rows)
    csv += fmt::format(
        "{},{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{},{}\n", r.method,
        r.setting > 0. ? fmt::format("{:.15g}", r.setting) : "", r.from_nothing.cpu, r.from_nothing.wall,
        r.sun_turned.cpu, r.sun_turned.wall, r.weighted_without_noise, r.weighted, r.category, r.leaf_without_noise,
        r.leaf, r.bias, bench.category_noise, bench.leaf_noise, orEmpty(r.monte_carlo), orEmpty(r.monte_carlo_leaf));
  return csv;
}

std::string sceneBenchPlot(const SceneBench& bench) {
  const char* const by_category = "RMS error of categories, by leaves [1]";
  const char* const cpu = "CPU time, all threads together";
  return logPlot(
      fmt::format("Light on the leaves of {}: run time against error", bench.scene),
      fmt::format(
          "{} leaves; {}.\nErrors against Monte Carlo of {:.3g} million paths, whose noise of {:.2g} % "
          "({:.2g} % of single leaves) is taken off. Beside points: paths of Monte Carlo, axes of the field's lines.",
          bench.leaves, bench.machine, 1e-6 * static_cast<double>(bench.reference_paths), 100. * bench.category_noise,
          100. * bench.leaf_noise),
      {panelOf(bench, {"From nothing but the meshes", cpu, by_category, &SceneBenchRow::from_nothing,
                       &SceneBenchTime::cpu, &SceneBenchRow::weighted_without_noise}),
       panelOf(bench, {"After the sun has turned", cpu, by_category, &SceneBenchRow::sun_turned, &SceneBenchTime::cpu,
                       &SceneBenchRow::weighted_without_noise}),
       panelOf(bench, {"Single leaves, from nothing", cpu, "RMS error of leaves [1]", &SceneBenchRow::from_nothing,
                       &SceneBenchTime::cpu, &SceneBenchRow::leaf_without_noise}),
       panelOf(bench, {"From nothing, by the clock", "wall time", by_category, &SceneBenchRow::from_nothing,
                       &SceneBenchTime::wall, &SceneBenchRow::weighted_without_noise})},
      2);
}

}  // namespace sunfleck
