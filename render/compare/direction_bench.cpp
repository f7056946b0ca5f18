#include "render/compare/direction_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"
#include "grid/foliage_stand.hpp"
#include "render/compare/log_plot.hpp"
#include "render/stand_geometry.hpp"

namespace sunfleck {
namespace {

constexpr std::array kCounts{8, 16, 22, 32, 48, 64, 96, 192};
constexpr int kReference = 1024, kTurns = 4;

// A turn of the sphere, all alike probable (Shoemake 1992).
glm::quat randomTurn(Random& random) {
  const float split = random.uniform();
  const float a = 2.f * std::numbers::pi_v<float> * random.uniform();
  const float b = 2.f * std::numbers::pi_v<float> * random.uniform();
  const float low = std::sqrt(1.f - split), high = std::sqrt(split);
  return {high * std::cos(b), low * std::sin(a), low * std::cos(a), high * std::sin(b)};
}

// G of the active cells of a scene's first tree, for any axes.
std::vector<float> compensationBy(const Scene& scene, const std::vector<Direction>& axes) {
  const GeometryEffort effort;
  FoliageStand stand({.axes = axes,
                      .sample_resolution = effort.sample_resolution,
                      .light_resolution = effort.light_resolution,
                      .cells = effort.cells});
  for (const TreeKind& kind : scene.kinds) stand.addPrototype(kind.mesh);
  for (const Placement& tree : scene.stand.trees) stand.add(tree.kind, tree.position);
  stand.setPeriod(scene.stand.period);
  const Direction sun = scene.sun().light();
  stand.setLights(std::span(&sun, 1));
  const std::size_t first = 0;
  stand.prepareCompensation(std::span(&first, 1));
  const std::span<const float> found = stand.compensation(first, 0);
  return {found.begin(), found.end()};
}

}  // namespace

std::vector<DirectionBenchPoint> benchDirections(const Scene& scene, std::uint64_t seed, const Progress& progress) {
  requireModelled(scene);
  for (const Placement& tree : scene.stand.trees)
    require(tree.rotation == 0.f, "rotation of a tree [rad]", tree.rotation, "0: the directions are turned instead");
  using Clock = std::chrono::steady_clock;
  const std::vector<float> exact = compensationBy(scene, spreadAxes(kReference / 2));

  double work = kReference, done = kReference;
  for (const int count : kCounts) work += 2. * kTurns * count;
  Random random(seed, 0);
  std::vector<DirectionBenchPoint> points;
  for (const bool spread : {true, false})
    for (const int count : kCounts) {
      DirectionBenchPoint point{.directions = count, .spread = spread};
      double squares = 0.;
      std::size_t cells = 0;
      for (int k = 0; k < kTurns; ++k) {
        if (!goOn(progress, done / work)) return {};
        std::vector<Direction> axes = spreadAxes(count / 2);
        const glm::quat turn = randomTurn(random);
        for (Direction& axis : axes) axis = glm::normalize((spread ? turn : randomTurn(random)) * axis);
        const auto start = Clock::now();
        const std::vector<float> found = compensationBy(scene, axes);
        point.seconds += std::chrono::duration<double>(Clock::now() - start).count() / kTurns;
        for (std::size_t i = 0; i < found.size(); ++i) {
          const double error = double{found[i]} - double{exact[i]};
          squares += error * error;
          point.largest_error = std::max(point.largest_error, std::abs(error));
          ++cells;
        }
        done += count;
      }
      point.rms_error = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(cells, 1)));
      points.push_back(point);
    }
  return points;
}

std::string directionBenchCsv(const std::vector<DirectionBenchPoint>& points) {
  std::string csv = "directions,set,seconds,rms_error,largest_error\n";
  for (const DirectionBenchPoint& p : points)
    csv += fmt::format("{},{},{:.4g},{:.4g},{:.4g}\n", p.directions, p.spread ? "spread" : "random", p.seconds,
                       p.rms_error, p.largest_error);
  return csv;
}

std::string directionBenchPlot(const std::vector<DirectionBenchPoint>& points, const std::string& scene) {
  LogPanel panel{.title = scene + ": G of the cells against 1,024 directions",
                 .x_title = "sample directions",
                 .y_title = "RMS error of G [1]",
                 .curves = {}};
  for (const bool spread : {true, false}) {
    LogCurve curve{
        .label = spread ? "spread axes" : "axes at random", .colour = spread ? "#1b7837" : "#b2182b", .points = {}};
    for (const DirectionBenchPoint& p : points)
      if (p.spread == spread)
        curve.points.push_back({.x = static_cast<double>(p.directions),
                                .y = p.rms_error,
                                .mark = spread ? std::to_string(p.directions) : ""});
    panel.curves.push_back(std::move(curve));
  }
  return logPlot("The G-factor by its number of sample directions", "Each set turned at random four times", {panel}, 1);
}

}  // namespace sunfleck
