#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "grid/deep_opacity_map.hpp"
#include "grid/density_grid.hpp"
#include "grid/foliage_stand.hpp"
#include "grid/leaf_depth.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"

using namespace sunfleck;

namespace {

// A round crown of 10 m, filled evenly with square leaves of 5 cm in random directions.
TreeMesh crown(int leaves) {
  return randomCrown({.size = glm::vec3(10.f), .leaf_side = 0.05f, .leaves = leaves}, 1);
}

double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.;
}

// Leaves into cells; unit: leaf triangles per second of wall time. Arguments: leaves, side of a cell [mm].
void voxelize(benchmark::State& state) {
  const TreeMesh mesh = crown(static_cast<int>(state.range(0)));
  const float cell_size = static_cast<float>(state.range(1)) * 1e-3f;
  const double area = leafArea(mesh);
  {
    const double before = peakMegabytes();
    const DensityGrid grid = DensityGrid::voxelize(mesh, cell_size);
    if (!(std::abs(grid.leafArea() - area) <= 1e-5 * area)) {
      state.SkipWithError("the grid does not hold the area of the leaves");
      return;
    }
    // Of the whole program so far, the mesh included: a figure of this case when it is run alone.
    state.counters["peak_MB"] = peakMegabytes();
    state.counters["peak_MB_before"] = before;
    state.counters["grid_MB"] = static_cast<double>(grid.memoryBytes()) / 1048576.;
    state.counters["cells"] = static_cast<double>(grid.occupiedCells());
  }
  for (auto _ : state) benchmark::DoNotOptimize(DensityGrid::voxelize(mesh, cell_size));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.leaf_triangles.size()));
}
BENCHMARK(voxelize)
    ->ArgNames({"leaves", "cell_mm"})
    ->Args({10'000, 100})
    ->Args({500'000, 200})
    ->Args({500'000, 50})
    ->Args({500'000, 20})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

constexpr int kDirections = 22;  // of the G-factor
constexpr Direction kDown{0.f, 0.f, -1.f};

// Whether a map's crossings times a pixel's area are the leaves' projected area, to the 1 % that pixels along their
// edges allow.
bool holdsProjectedArea(const DeepOpacityMap& map, const TreeMesh& mesh) {
  const std::vector<float> projections = leafProjections(mesh, map.along());
  const std::vector<double> areas = leafAreas(mesh);
  double expected = 0.;
  for (std::size_t leaf = 0; leaf < areas.size(); ++leaf) expected += areas[leaf] * double{projections[leaf]};
  const double counted =
      static_cast<double>(map.crossings().size()) * double{map.pixelSize()} * double{map.pixelSize()};
  return std::abs(counted - expected) <= 1e-2 * expected;
}

// A tree's map along the light, wood included; unit: maps/s of wall time. Argument: pixels along the longer side.
void lightMap(benchmark::State& state, const char* name) {
  const TreeMesh mesh = grow(species(name), 1);
  const int resolution = static_cast<int>(state.range(0));
  if (!holdsProjectedArea(DeepOpacityMap(mesh, kDown, resolution), mesh))
    return state.SkipWithError("the map does not hold the area of the leaves");
  for (auto _ : state) benchmark::DoNotOptimize(DeepOpacityMap(mesh, kDown, resolution));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(lightMap, cherry, "cherry")
    ->ArgName("pixels")
    ->Arg(256)
    ->Arg(512)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(lightMap, maple, "maple")
    ->ArgName("pixels")
    ->Arg(256)
    ->Arg(512)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// The cherry's 11 deep opacity maps, which serve 22 directions; unit: maps/s of wall time. Argument: pixels along the
// longer side.
void opacityMaps(benchmark::State& state) {
  const TreeMesh mesh = grow(species("cherry"), 1);
  const std::vector<Direction> directions = spreadAxes(kDirections / 2);
  const int resolution = static_cast<int>(state.range(0));
  for (const Direction& along : directions)
    if (!holdsProjectedArea(DeepOpacityMap(mesh, along, resolution, DeepOpacityMap::Wood::none), mesh))
      return state.SkipWithError("a map does not hold the area of the leaves");
  for (auto _ : state)
    for (const Direction& along : directions)
      benchmark::DoNotOptimize(DeepOpacityMap(mesh, along, resolution, DeepOpacityMap::Wood::none));
  state.SetItemsProcessed(state.iterations() * kDirections / 2);
}
BENCHMARK(opacityMaps)->ArgName("pixels")->Arg(128)->Arg(256)->UseRealTime()->Unit(benchmark::kMillisecond);

// Everything that 64 cherries need for SPPG under one sun: opacity maps, depths of their cells, and G (steps 2, 3 and 5
// of Shinya et al. 2013, Table 4); unit: active cells/s of wall time.
void prepareStand(benchmark::State& state) {
  const auto tree = std::make_shared<const TreeMesh>(grow(species("cherry"), 1));
  const glm::vec3 size = leafBounds(*tree).size();
  const auto side = static_cast<int>(state.range(0));
  std::int64_t cells = 0;
  for (auto _ : state) {
    FoliageStand stand;
    stand.addPrototype(tree);
    for (int i = 0; i < side * side; ++i)
      stand.add(0, {static_cast<float>(i % side) * size.x, static_cast<float>(i / side) * size.y, 0.f});
    stand.setLights(std::span(&kDown, 1));
    stand.prepareCompensation(stand.allInstances());
    for (const std::size_t i : stand.allInstances()) {
      for (const float g : stand.compensation(i, 0))
        if (!(g >= 0.f && g <= 1.f)) return state.SkipWithError("a G-factor is no share");
      cells += static_cast<std::int64_t>(stand.compensation(i, 0).size());
    }
  }
  state.SetItemsProcessed(cells);
}
BENCHMARK(prepareStand)->ArgName("side")->Arg(1)->Arg(8)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
