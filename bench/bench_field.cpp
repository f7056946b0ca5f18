#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <ctime>

#include "field/leaf_field.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"

using namespace sunfleck;

namespace {

enum Tree { crown10k, crown24k, cherry };

std::shared_ptr<const TreeMesh> treeOf(Tree tree) {
  if (tree == cherry) return std::make_shared<const TreeMesh>(grow(species("cherry"), 1));
  const int leaves = tree == crown10k ? 10'000 : 24'000;
  return std::make_shared<const TreeMesh>(randomCrown({.leaves = leaves}, 1));
}

FieldLighting lightingOf(float albedo, float zenith) {
  FieldLighting lighting{.suns = {{.along = sunlight(zenith, 0.f)}}, .sky = {}, .kinds = {FieldKind{}}};
  lighting.kinds[0].leaf = {LeafOptics{0.1f, 0.05f}, LeafOptics{0.2f, 0.1f}, LeafOptics{0.5f * albedo, 0.5f * albedo}};
  return lighting;
}

// Whether the light goes somewhere.
bool balances(const FieldResult& result) {
  for (const FieldBalance& balance : result.balance) {
    const double out = balance.absorbed_leaves + balance.absorbed_wood + balance.out_up + balance.out_down;
    if (!(std::abs(balance.in - out) <= 3e-3 * balance.in)) return false;
  }
  return result.converged;
}

// One tree under one sun in three bands, from nothing. CPU is of all threads.
void fromScratch(benchmark::State& state) {
  const auto mesh = treeOf(static_cast<Tree>(state.range(0)));
  const FieldLighting lighting = lightingOf(0.95f, 0.6f);
  for (auto _ : state) {
    LeafField field;
    field.setStand(std::array{mesh}, {});
    if (!balances(field.solve(lighting))) state.SkipWithError("the light does not balance");
  }
}
BENCHMARK(fromScratch)
    ->ArgNames({"tree"})
    ->Arg(crown10k)
    ->Arg(crown24k)
    ->Arg(cherry)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// The same tree when the sun has moved.
void relit(benchmark::State& state) {
  LeafField field;
  field.setStand(std::array{treeOf(static_cast<Tree>(state.range(0)))}, {});
  float zenith = 0.2f;
  if (!balances(field.solve(lightingOf(0.95f, zenith)))) state.SkipWithError("the light does not balance");
  for (auto _ : state)
    benchmark::DoNotOptimize(field.solve(lightingOf(0.95f, zenith = zenith < 1.f ? zenith + 0.01f : 0.2f)));
}
BENCHMARK(relit)
    ->ArgNames({"tree"})
    ->Arg(crown10k)
    ->Arg(crown24k)
    ->Arg(cherry)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
