// Times of the field on cells: one tree's preview and what it rests on, and stands of trees whose leaves are solved one
// by one. Each checks that no light is lost.
#include <benchmark/benchmark.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "field/clumping.hpp"
#include "field/grid_field.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"

using namespace sunfleck;

namespace {

struct Tree {
  TreeMesh mesh;
  FieldElements elements;
  float omega = 1.f;

  explicit Tree(TreeMesh of) : mesh(std::move(of)) {
    mesh.wood_triangles.clear();
    elements = fieldElements(mesh, {.least_flatness = 0.f, .largest_extent = 1e9f});
    omega = clumping(mesh, medium());
  }
  CellMedium medium() const {
    const PlacedElements tree{&mesh, &elements};
    return cellMedium({&tree, 1});
  }
};

const Tree& tree(const benchmark::State& state) {
  static const Tree random(randomCrown({.leaves = 10'000}, 1)), cherry(grow(species("cherry"), 1));
  return state.range(0) == 0 ? random : cherry;
}

GridLight sunlit(const GridField& field, std::size_t kinds) {
  const float dark = 0.f;
  return {.optics = {std::vector<GridOptics>(kinds, {.leaf = {0.475f, 0.475f}})},
          .direct = field.sunThroughCells({0.f, 0.f, -1.f}).direct,
          .entering = field.evenSky({&dark, 1}, {&dark, 1}, {})};
}

void check(benchmark::State& state, const GridSolution& solution) {
  // The share of light that the last iteration still moved: the error asked for is 0.005.
  if (!(std::abs(solution.balance[0].residual()) < 0.005)) state.SkipWithError("light is lost");
  state.counters["iterations"] = solution.iterations;
}

void medium(benchmark::State& state) {
  const Tree& of = tree(state);
  for (auto _ : state) benchmark::DoNotOptimize(of.medium());
}

void clumpingOf(benchmark::State& state) {
  const Tree& of = tree(state);
  const CellMedium cells = of.medium();
  for (auto _ : state) benchmark::DoNotOptimize(clumping(of.mesh, cells));
}

void preview(benchmark::State& state) {
  const Tree& of = tree(state);
  GridField field(of.medium(), std::vector<float>{of.omega});
  const GridLight light = sunlit(field, 1);
  GridSolution solution;
  for (auto _ : state) solution = field.solve(light);
  check(state, solution);
}

// Trees of four prototypes in rows, from their meshes on.
void stand(benchmark::State& state) {
  static const std::vector<Tree> kinds = [] {
    std::vector<Tree> made;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) made.emplace_back(randomCrown({.leaves = 10'000}, seed));
    return made;
  }();
  std::vector<PlacedElements> trees;
  std::vector<float> omega;
  for (const Tree& of : kinds) omega.push_back(of.omega);
  const auto side = static_cast<int>(state.range(0));
  for (int i = 0; i < side * side; ++i) {
    const auto kind = static_cast<std::uint32_t>(i % 4);
    trees.push_back({&kinds[kind].mesh,
                     &kinds[kind].elements,
                     {.position = {2.5f * static_cast<float>(i % side), 2.5f * static_cast<float>(i / side), 0.f},
                      .rotation = static_cast<float>(i),
                      .kind = kind}});
  }
  GridSolution solution;
  for (auto _ : state) {
    GridField field(cellMedium(trees), omega);
    solution = field.solve(sunlit(field, 4));
  }
  check(state, solution);
}

BENCHMARK(medium)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(clumpingOf)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(preview)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(stand)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
