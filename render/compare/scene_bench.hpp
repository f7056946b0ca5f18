#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "render/compare/category_errors.hpp"
#include "render/compare/scene_contestants.hpp"

namespace sunfleck {

struct SceneBenchEffort {
  TraceEffort reference{.paths = 16'000'000};
  std::vector<std::uint64_t> paths{};  // of Monte Carlo as a contestant, kLeastUnits or more each
  GeometryEffort geometry{};
  int rounds = 3;
  int band = 0;  // of the scene's optics, 0 .. kBands - 1
  bool with_wood = false;
};

struct SceneBenchTime {
  double cpu = 0.;   // of all threads [s]
  double wall = 0.;  // [s]
};

// (F25) What a way to compute the irradiance of a scene's leaves costs and how far it is off.
struct SceneBenchRow {
  std::string method;
  double setting = 0.;  // as NamedSceneContestant has it
  SceneBenchTime from_nothing, sun_turned;
  // RMS over the rounds of errors against the reference as (R6) has them, with the reference's noise in them ...
  double category = 0., weighted = 0., leaf = 0.;
  double bias = 0.;  // the mean of the rounds
  // ... and without it; 0: nothing is left of the error.
  double weighted_without_noise = 0., leaf_without_noise = 0.;
  // Where Monte Carlo is as accurate as this by categories, and by single leaves [CPU s from nothing]; none: for Monte
  // Carlo itself, or where nothing is left of the error.
  std::optional<double> monte_carlo, monte_carlo_leaf;
};

struct SceneBench {
  std::string machine;
  std::string scene;
  std::size_t leaves = 0, leaves_left_out = 0;  // in categories of fewer than 5
  std::uint64_t reference_paths = 0;
  double reference_seconds = 0.;                // wall
  double category_noise = 0., leaf_noise = 0.;  // of the reference: what a perfect model's errors would be
  std::vector<SceneBenchRow> rows;
};

// The noise that makes a figure too uncertain to tell: above a fifth of it.
inline bool noisy(double with_noise, double noise) {
  return noise > 0.2 * with_noise;
}

// Every contestant against a run of Monte Carlo, on one scene, in rounds in which each has its turn, so that what else
// the machine does falls on all alike; medians of times are told. Ended early by `progress`: no rows; some of the work
// ends by std::runtime_error("interrupted") then. Throws InvalidInput as judgedModels() does, on a scene of several
// suns,, and on a scene whose leaves no path of the reference meets.
SceneBench benchScene(const Scene& scene, const SceneBenchEffort& effort, const Progress& progress = {});

std::string sceneBenchCsv(const SceneBench& bench);
std::string sceneBenchPlot(const SceneBench& bench);  // SVG

std::string countText(double count);  // as "16 k" or "2.5 M"

// (F25) Run time of Monte Carlo by its error: start + by_path (one_path / error)^2.
struct TraceCourse {
  double start = 0.;     // until the first path [s]
  double by_path = 0.;   // of each path [s]
  double one_path = 0.;  // error of one path, if it were alone [1]
  double timeOf(double error) const { return start + by_path * (one_path / error) * (one_path / error); }
};
struct TracePoint {
  double paths, seconds, error;
};
//   points  at least one, each of another number of paths, more than 0
TraceCourse traceCourse(const std::vector<TracePoint>& points);

}  // namespace sunfleck
