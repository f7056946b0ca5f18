#include <benchmark/benchmark.h>

#include <algorithm>

#include "grid/deep_opacity_map.hpp"
#include "plants/random_leaves.hpp"
#include "render/gl/opacity_maps.hpp"

// Deep opacity maps of a crown of 9,000 leaves, 18,000 triangles, by the processor and by the graphics card.
namespace {

using namespace sunfleck;

// The light's map of that many pixels along its side, in the memory of whoever made it.
void mapOfProcessor(benchmark::State& state) {
  const TreeMesh mesh = randomCrown({}, 1);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        DeepOpacityMap(mesh, spreadAxes(7)[2], static_cast<int>(state.range(0))).crossings().data());
}
void mapOfGraphicsCard(benchmark::State& state) {
  const TreeMesh mesh = randomCrown({}, 1);
  const gl::Context context;
  const gl::OpacityMapMaker maker(context);
  const gl::MappedTree tree(mesh);
  const auto make = [&] { return maker.make(tree, spreadAxes(7)[2], static_cast<int>(state.range(0))); };
  const DeepOpacityMap expected(mesh, spreadAxes(7)[2], static_cast<int>(state.range(0)));
  if (!std::ranges::equal(make().read().first(), expected.first())) return state.SkipWithError("wrong answer");
  for (auto _ : state) {
    const gl::OpacityMap map = make();
    context.finish();
  }
  state.SetLabel(context.renderer());
}

BENCHMARK(mapOfProcessor)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(mapOfGraphicsCard)
    ->Arg(512)
    ->Arg(1024)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
