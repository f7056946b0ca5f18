#include "render/compare/forest_bench.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <numeric>

#include "core/elapsed.hpp"
#include "field/large_stand.hpp"
#include "plants/random_leaves.hpp"
#include "render/compare/machine_name.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kPrototypes = 4;
constexpr int kLeaves = 10'000;
constexpr std::size_t kTurns = 16;

double peakMegabytes() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return 1024e-6 * static_cast<double>(used.ru_maxrss);
}

ForestBenchRow measured(const std::vector<std::shared_ptr<const TreeMesh>>& kinds, std::size_t count,
                        std::size_t most_near, const Progress& progress) {
  Stand stand{.trees = {}};
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const glm::vec3 size = leafBounds(*kinds[0]).size();
  const float spacing = 1.05f * std::max(size.x, size.y);
  for (std::size_t i = 0; i < count; ++i)
    stand.trees.push_back(
        {.position = spacing * glm::vec3(static_cast<float>(i % side), static_cast<float>(i / side), 0.f),
         .rotation = 2.f * std::numbers::pi_v<float> * static_cast<float>(i * 7 % kTurns) / static_cast<float>(kTurns),
         .kind = static_cast<std::uint32_t>(i % kPrototypes)});
  std::vector<std::size_t> near(count), far;
  std::iota(near.begin(), near.end(), std::size_t{0});
  const glm::vec3 middle = 0.5f * static_cast<float>(side - 1) * spacing * glm::vec3(1.f, 1.f, 0.f);
  std::ranges::stable_sort(near, {},
                           [&](std::size_t tree) { return glm::length(stand.trees[tree].position - middle); });
  if (count > most_near) {
    far.assign(near.begin() + static_cast<std::ptrdiff_t>(most_near), near.end());
    near.resize(most_near);
  }
  const FieldLighting lighting{
      .suns = {{.along = sunlight(0.7f, 0.5f)}},
      .sky = {},
      .kinds = std::vector<FieldKind>(
          kPrototypes, {.leaf = {LeafOptics{0.08f, 0.06f}, LeafOptics{0.14f, 0.12f}, LeafOptics{0.475f, 0.475f}}}),
      .ground_albedo = glm::vec3(0.f)};
  const Elapsed elapsed;
  LargeStandField field;
  field.setStand(kinds, stand);
  const FieldResult& result = field.solve(lighting, near, far, progress);
  ForestBenchRow row{.trees = count,
                     .near = near.size(),
                     .leaves = static_cast<double>(count) * kLeaves,
                     .cells = field.stats().cells,
                     .elements = field.stats().elements,
                     .cell_iterations = field.stats().cell_iterations,
                     .iterations = result.iterations,
                     .seconds = elapsed.seconds(),
                     .cpu_seconds = elapsed.cpuSeconds(),
                     .megabytes = peakMegabytes()};
  for (const FieldBalance& balance : result.balance)
    row.lost = std::max(row.lost, std::abs(1. - (balance.absorbed_leaves + balance.absorbed_wood +
                                                 balance.absorbed_ground + balance.out_up + balance.out_down) /
                                                    balance.in));
  return row;
}

}  // namespace

ForestBench benchForests(std::size_t most_trees, std::size_t most_near, const Progress& progress) {
  std::vector<std::shared_ptr<const TreeMesh>> kinds;
  for (std::size_t seed = 1; seed <= kPrototypes; ++seed)
    kinds.push_back(std::make_shared<const TreeMesh>(randomCrown({.leaves = kLeaves}, seed)));
  std::vector<std::size_t> counts;
  for (std::size_t count = 16; count <= most_trees; count *= 4)
    counts.push_back(count * 4 > most_trees ? most_trees : count);  // the largest is as large as asked for
  ForestBench bench{.machine = machineName(), .rows = {}};
  const double work = std::accumulate(counts.begin(), counts.end(), 0., [](double sum, std::size_t count) {
    return sum + static_cast<double>(count) + 100.;
  });
  double done = 0.;
  bool goes_on = true;
  const Progress asked = [&](double of_work) { return goes_on = goOn(progress, of_work); };
  try {
    for (const std::size_t count : counts) {
      const double next = done + static_cast<double>(count) + 100.;
      bench.rows.push_back(measured(kinds, count, most_near, partOf(asked, done / work, next / work)));
      done = next;
    }
  } catch (const std::runtime_error&) {
    if (goes_on) throw;
    return {};
  }
  return bench;
}

std::string forestBenchCsv(const ForestBench& bench) {
  std::string csv = "trees,near,leaves,cells,elements,cell_iterations,iterations,wall_s,cpu_s,peak_megabytes,lost\n";
  for (const ForestBenchRow& r : bench.rows)
    csv += fmt::format("{},{},{:.0f},{},{},{},{},{:.4g},{:.4g},{:.4g},{:.2g}\n", r.trees, r.near, r.leaves, r.cells,
                       r.elements, r.cell_iterations, r.iterations, r.seconds, r.cpu_seconds, r.megabytes, r.lost);
  return csv;
}

}  // namespace sunfleck
