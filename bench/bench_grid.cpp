#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "core/random.hpp"
#include "core/tree_mesh.hpp"
#include "grid/density_grid.hpp"

using namespace sunfleck;

namespace {

glm::vec3 inUnitBall(Random& random) {
  for (;;) {
    const glm::vec3 p = 2.f * glm::vec3(random.uniform(), random.uniform(), random.uniform()) - 1.f;
    if (glm::dot(p, p) <= 1.f) return p;
  }
}

// A round crown of 10 m, filled evenly with square leaves of 5 cm in random directions.
TreeMesh crown(std::uint32_t leaves) {
  constexpr float radius = 5.f, half_side = 0.025f;  // [m]
  TreeMesh mesh;
  Random random(1, 0);
  for (std::uint32_t i = 0; i < leaves; ++i) {
    const glm::vec3 centre = radius * inUnitBall(random) + glm::vec3(0.f, 0.f, 7.f);
    const glm::vec3 u = half_side * glm::normalize(inUnitBall(random));
    const glm::vec3 v = half_side * glm::normalize(glm::cross(u, inUnitBall(random)));
    for (const glm::vec3& corner : {-u - v, u - v, u + v, v - u}) mesh.vertices.push_back(centre + corner);
    mesh.leaf_triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
    mesh.leaf_triangles.push_back({4 * i, 4 * i + 2, 4 * i + 3});
  }
  finish(mesh, "crown");
  return mesh;
}

double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.;
}

// Leaves into cells; unit: leaf triangles per second of wall time. Arguments: leaves, side of a cell [mm].
void voxelize(benchmark::State& state) {
  const TreeMesh mesh = crown(static_cast<std::uint32_t>(state.range(0)));
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

}  // namespace
