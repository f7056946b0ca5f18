#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "grid/deep_opacity_map.hpp"
#include "grid/density_grid.hpp"
#include "grid/instance_cells.hpp"
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

// The cherry's 11 deep opacity maps of 256 x 256 pixels, which serve 22 directions; unit: maps/s of wall time.
void opacityMaps(benchmark::State& state) {
  const TreeMesh mesh = grow(species("cherry"), 1);
  const std::vector<Direction> directions = spreadAxes(kDirections / 2);
  for (const DeepOpacityMap& map : deepOpacityMaps(mesh, directions, 256))
    if (!holdsProjectedArea(map, mesh)) return state.SkipWithError("a map does not hold the area of the leaves");
  for (auto _ : state) benchmark::DoNotOptimize(deepOpacityMaps(mesh, directions, 256));
  state.SetItemsProcessed(state.iterations() * kDirections / 2);
}
BENCHMARK(opacityMaps)->UseRealTime()->Unit(benchmark::kMillisecond);

// Depths and G of the cherry's 16^3 cells from its maps; unit: active cells/s of wall time.
void compensation(benchmark::State& state) {
  const TreeMesh mesh = grow(species("cherry"), 1);
  const std::vector<DeepOpacityMap> maps = deepOpacityMaps(mesh, spreadAxes(kDirections / 2), 256);
  const DeepOpacityMap light(mesh, kDown, 512);
  const CellGrid cells = cellGrid(mesh, 16);
  const auto g = [&] { return cellCompensation(cells, maps, cellDepths(cells, maps, {}), light, {}); };
  for (const float value : g())
    if (!(value >= 0.f && value <= 1.f)) return state.SkipWithError("a G-factor is no share");
  for (auto _ : state) benchmark::DoNotOptimize(g());
  state.SetItemsProcessed(state.iterations() * std::count(cells.active.begin(), cells.active.end(), true));
}
BENCHMARK(compensation)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
