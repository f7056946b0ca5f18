#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <memory>
#include <string>

#include "render/compare/exact_powers.hpp"
#include "render/gl/context.hpp"
#include "render/gl/stand_picture.hpp"
#include "render/gl/stand_renderer.hpp"
#include "render/scene_file.hpp"

namespace {

using namespace sunfleck;

constexpr std::array kTimed{Model::ss, Model::spp, Model::sppg, Model::nstreamg, Model::pp, Model::field};
constexpr std::size_t kMostWithField =
    64;                         // trees: the field of more takes minutes; their frames have direct light alone
constexpr float kDetail = 6.f;  // pixels that enlarged leaves cover at most

// A stand that is ready to be drawn, from somewhat above. G is what it is.
struct Ready {
  Scene scene;
  StandGeometry geometry;
  std::unique_ptr<gl::Context> context = std::make_unique<gl::Context>();
  std::unique_ptr<gl::StandRenderer> renderer = std::make_unique<gl::StandRenderer>(*context, exactPowerTable);
  gl::View view;

  explicit Ready(const std::string& name) : scene(readScene(name)) {
    scene.ground_albedo = glm::vec3(0.16f);
    prepare();
  }
  void prepare() {
    geometry.update(scene, {.sky_light = false, .field = scene.stand.trees.size() <= kMostWithField});
    renderer->update(gl::drawnStand(scene, geometry));
    Camera camera = kOverview;
    camera.elevation = 0.5f;
    view.camera = showingAll(scene, camera);
  }
};

// `rows` x `rows` cherries, each as far from the next as in the built-in stands.
Ready& cherries(int rows) {
  static std::array<std::unique_ptr<Ready>, 33> all;
  std::unique_ptr<Ready>& ready = all[static_cast<std::size_t>(rows)];
  if (!ready) {
    ready = std::make_unique<Ready>(rows == 4 ? "cherry16" : rows == 8 ? "cherry64" : "cherry1");
    if (rows > 8) {
      const glm::vec2 period = touchingPeriod(ready->scene);
      ready->scene.stand.trees.clear();
      for (int i = 0; i < rows * rows; ++i)
        ready->scene.stand.trees.push_back({.position = {period * glm::vec2(i % rows, i / rows), 0.f}});
      ready->prepare();
    }
  }
  return *ready;
}

double meanRadiance(const gl::FrameTarget& target) {
  const std::vector<float> values = target.read(gl::Layer::total);
  double sum = 0.;
  for (std::size_t i = 0; i < values.size(); i += 4) sum += static_cast<double>(values[i]);
  return 4. * sum / static_cast<double>(values.size());
}

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// Frames of 512 x 512 pixels, one sample each, by all models in turn, so that what else the machine does falls on all
// alike. The time is that of a frame by SPPG. Counters: the pass that finds what is seen, frames of the models by that
// of SS, and the processors' time, of all threads together, which a busy machine tells more truly.
void frame(benchmark::State& state, int rows, float piece_pixels) {
  Ready& ready = cherries(rows);
  gl::FrameTarget target({ready.view.camera.width, ready.view.camera.height});
  ready.view.piece_pixels = piece_pixels;
  ready.renderer->timePasses(true);
  const auto draw = [&](Model model) {
    ready.view.model = model;
    return ready.renderer->draw(ready.view, target);
  };
  for (const Model model : kTimed) draw(model);
  // Leaves of albedo .95 send more than light scattered once, and less than falls on them.
  draw(Model::ss);
  const double single = meanRadiance(target);
  draw(Model::sppg);
  const double all = meanRadiance(target);
  if (!(single > 0.001 && all > 1.1 * single && all < 0.3)) {
    state.SkipWithError("wrong answer");
    return;
  }
  struct Times {
    double visible = 0., shading = 0., cpu = 0.;
    double all() const { return visible + shading; }
  };
  std::array<Times, kTimed.size()> times{};
  gl::FrameCost cost;
  for (auto _ : state)
    for (std::size_t i = 0; i < kTimed.size(); ++i) {
      const double start = cpuSeconds();
      cost = draw(kTimed[i]);
      times[i].cpu += cpuSeconds() - start;
      times[i].visible += cost.visible_seconds;
      times[i].shading += cost.shading_seconds;
      if (kTimed[i] == Model::sppg) state.SetIterationTime(cost.visible_seconds + cost.shading_seconds);
    }
  const auto milliseconds = [&](double sum) { return 1e3 * sum / static_cast<double>(state.iterations()); };
  const auto of = [&](Model model) {
    return times[static_cast<std::size_t>(std::ranges::find(kTimed, model) - kTimed.begin())];
  };
  const Times ss = of(Model::ss), sppg = of(Model::sppg), nstreamg = of(Model::nstreamg), pp = of(Model::pp);
  state.counters["visible_ms"] = milliseconds(sppg.visible);
  state.counters["cpu_ms"] = milliseconds(sppg.cpu);
  state.counters["ss_cpu_ms"] = milliseconds(ss.cpu);
  state.counters["sppg/ss"] = sppg.all() / ss.all();
  state.counters["nstreamg/ss"] = nstreamg.all() / ss.all();
  state.counters["spp/ss_cpu"] = of(Model::spp).cpu / ss.cpu;
  state.counters["sppg/ss_cpu"] = sppg.cpu / ss.cpu;
  state.counters["nstreamg/ss_cpu"] = nstreamg.cpu / ss.cpu;
  state.counters["pp/ss_cpu"] = pp.cpu / ss.cpu;
  state.counters["field/ss"] = of(Model::field).all() / ss.all();
  state.counters["field/ss_cpu"] = of(Model::field).cpu / ss.cpu;
  state.counters["triangles"] = static_cast<double>(cost.triangles);
  state.counters["calls"] = static_cast<double>(cost.draw_calls);
  state.SetLabel(ready.context->renderer());
}

BENCHMARK_CAPTURE(frame, cherry1, 1, kDetail)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(frame, cherry16, 4, kDetail)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(frame, cherry16_full, 4, 0.f)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(frame, cherry64, 8, kDetail)->Unit(benchmark::kMillisecond)->UseManualTime();

}  // namespace

// Stands of 1,024 trees take seconds to prepare: they are measured when asked for, by
// --benchmark_filter=frame/cherry1024.
int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]).find("cherry1024") != std::string::npos)
      benchmark::RegisterBenchmark("frame/cherry1024", [](benchmark::State& state) { frame(state, 32, kDetail); })
          ->Unit(benchmark::kMillisecond)
          ->UseManualTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
