#include <benchmark/benchmark.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "plants/random_leaves.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/visible_surfaces.hpp"

// Monte Carlo on a crown like the reference tree: 9,000 squares of 5 cm, 18,000 triangles, in an ellipsoid of
// 2 x 2 x 3 m with spherical leaf angles, albedo 0.95, sun overhead. One thread, so that time is CPU time.
namespace {
using namespace sunfleck;

const TreeMesh& tree() {
  static const TreeMesh mesh = randomCrown({}, 1);
  return mesh;
}
const RayScene& scene() {
  static const RayScene made(tree(), Stand{}, false);
  return made;
}

// The reference picture's camera: elevation 35 degrees, azimuth 20 degrees, half width 1.7 m.
PixelRays picture() {
  constexpr float kDegree = std::numbers::pi_v<float> / 180.f;
  const Direction sight = sunlight(55.f * kDegree, 20.f * kDegree);
  const glm::vec3 right = glm::normalize(glm::cross(sight, glm::vec3(0.f, 0.f, 1.f)));
  const glm::vec3 up = glm::cross(right, sight);
  constexpr int kSide = 512;
  constexpr float kHalfWidth = 1.7f;
  return {.corner = kHalfWidth * (up - right),
          .right_step = 2.f * kHalfWidth / kSide * right,
          .down_step = -2.f * kHalfWidth / kSide * up,
          .sight = sight,
          .width = kSide,
          .height = kSide};
}

void rate(benchmark::State& state, const char* name, double count) {
  state.counters[name] = benchmark::Counter(count, benchmark::Counter::kIsRate);
}

void forward(benchmark::State& state) {
  const TraceEffort effort{.paths = 1 << 19, .seed = 1, .threads = 1};
  const ForwardResult check = traceForward(scene(), TraceLight{}, effort);
  const double sum = check.reflected.value + check.absorbed_leaves.value + check.arriving_ground.value;
  if (std::abs(sum - 1.) > 1e-9) return state.SkipWithError("energy is not conserved");
  double paths = 0.;
  for (auto _ : state) paths += static_cast<double>(traceForward(scene(), TraceLight{}, effort).paths);
  rate(state, "paths_per_cpu_s", paths);
}
BENCHMARK(forward)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

// The reference tree, another draw of 9,000 such leaves, has a mean radiance of 0.0207856; draws differ by about 1 %.
void camera(benchmark::State& state) {
  const TraceEffort effort{.paths = 1 << 20, .seed = 1, .threads = 1};
  const CameraResult check = traceCamera(scene(), TraceLight{}, picture(), 0.f, effort);
  if (std::abs(check.mean.value - 0.0207856) > 4e-4) return state.SkipWithError("wrong mean radiance");
  double paths = 0.;
  for (auto _ : state) paths += static_cast<double>(traceCamera(scene(), TraceLight{}, picture(), 0.f, effort).paths);
  rate(state, "paths_per_cpu_s", paths);
  state.counters["mean"] = check.mean.value;
  state.counters["standard_error"] = check.mean.standard_error;
}
BENCHMARK(camera)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

// Black leaves under a camera end every path at its first hit: what a primary ray and its shadow cost.
void primaryRays(benchmark::State& state) {
  TraceLight black;
  black.leaf = {.reflectance = 0.f, .transmittance = 0.f};
  const TraceEffort effort{.paths = 1 << 20, .seed = 1, .threads = 1};
  const CameraResult check = traceCamera(scene(), black, picture(), 0.f, effort);
  if (check.mean.value != 0.) return state.SkipWithError("black leaves shine");
  double rays = 0.;
  for (auto _ : state) rays += static_cast<double>(traceCamera(scene(), black, picture(), 0.f, effort).paths);
  rate(state, "rays_per_cpu_s", rays);
}
BENCHMARK(primaryRays)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

// What 512 x 512 lines of sight see in a square stand of that many trees, 2.5 m apart, all in the picture, on all
// threads.
void visible(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  Stand stand{.trees = {}};
  for (int i = 0; i < side * side; ++i)
    stand.trees.push_back(
        {.position = {2.5f * static_cast<float>(i % side), 2.5f * static_cast<float>(i / side), 0.f}});
  const RayScene made(tree(), stand, true);
  const float half = 1.8f * static_cast<float>(side);
  PixelRays rays = picture();
  const glm::vec3 right = glm::normalize(rays.right_step), down = glm::normalize(rays.down_step);
  rays.right_step = half / 256.f * right;
  rays.down_step = half / 256.f * down;
  rays.corner = made.box().centre() - half * (right + down);
  double seen = 0.;  // share of the lines that see a tree
  for (const glm::uvec2& first : visibleSurfaces(made, rays, glm::vec2(0.5f)))
    seen += (first.x != kNothingSeen) / 262144.;
  if (seen < 0.15 || seen > 0.3) return state.SkipWithError("trees are missing");
  for (auto _ : state) benchmark::DoNotOptimize(visibleSurfaces(made, rays, glm::vec2(0.5f)).data());
  state.counters["seen"] = seen;
}
BENCHMARK(visible)->Arg(8)->Arg(32)->Arg(100)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
