#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "grid/deep_opacity_map.hpp"
#include "plants/random_leaves.hpp"
#include "render/gl/context.hpp"
#include "render/gl/tree_renderer.hpp"

namespace {

using namespace sunfleck;

constexpr float kPi = std::numbers::pi_v<float>;

Scene sceneOf(TreeMesh mesh) {
  Scene scene;
  scene.kinds[0].mesh = std::make_shared<TreeMesh>(std::move(mesh));
  scene.camera = Camera{.elevation = 35.f * kPi / 180.f, .azimuth = 20.f * kPi / 180.f, .half_width = 1.7f};
  return scene;
}

gl::SunMap arraysOf(const DeepOpacityMap& map) {
  return {.axes = map.axes(),
          .origin = map.inMap(glm::vec3(0.f)),
          .corner = map.corner(),
          .pixel_size = map.pixelSize(),
          .size = map.size(),
          .first = map.first(),
          .crossings = map.crossings(),
          .wood_depth = map.woodDepth()};
}

double meanRadiance(const Image& image) {
  double sum = 0.;
  for (std::size_t i = 0; i < image.values.size(); i += image.channels.size())
    sum += static_cast<double>(image.values[i]);
  return sum / (image.width * image.height);
}

// One picture of 512 x 512 pixels and 4 samples each, from the camera to floats in memory. G is 1 throughout: its value
// does not change the time.
void picture(benchmark::State& state, Model model) {
  const Scene scene = sceneOf(randomCrown({}, 1));
  const DeepOpacityMap map(*scene.kinds[0].mesh, scene.sun().light(), 512);
  const gl::Context context;
  const std::vector<float> ones(16 * 16 * 16, 1.f);
  const gl::TreeRenderer renderer(
      context, scene, arraysOf(map),
      {.low = glm::vec3(-1.6f), .cell_size = 0.2f, .size = glm::ivec3(16), .values = {ones}});
  // A crown like this one has, by Monte Carlo, a mean radiance of .0208; SS shows under a half of it, and SPP a sixth
  // too much.
  const double mean = meanRadiance(renderer.picture(*scene.camera, model));
  const double expected = model == Model::ss ? 0.0094 : 0.0243;
  if (std::abs(mean / expected - 1.) > 0.05) {
    state.SkipWithError("wrong answer");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(renderer.picture(*scene.camera, model).values.data());
  state.SetLabel(context.renderer());
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(picture, ss, Model::ss)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(picture, spp, Model::spp)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(picture, sppg, Model::sppg)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
