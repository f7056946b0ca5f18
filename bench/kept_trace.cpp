#include "bench/kept_trace.hpp"

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>

#include "grid/density_grid.hpp"
#include "plants/random_leaves.hpp"
#include "render/reference/trace_goal.hpp"
#include "render/reference/trace_store.hpp"

namespace sunfleck {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kSecondsBetweenWrites = 30.;

// Every bit of what the tracer finds of leaves and wood, alone and periodic.
std::string fingerprint() {
  TreeMesh mesh = randomCrown({.size = {1.f, 1.f, 1.f}, .leaf_side = 0.1f, .leaves = 100}, 1);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{-.1f, 0.f, -.5f}, {.1f, 0.f, -.5f}, {0.f, 0.02f, .5f}});
  mesh.wood_triangles.emplace_back(first, first + 1, first + 2);
  std::vector<double> found;
  for (const Stand& stand : {Stand{}, Stand{.period = glm::vec2(1.f, 1.f)}}) {
    const RayScene rays(mesh, stand, true);
    const Direction sun = sunlight(0.5f, 0.2f);
    for (const ForwardResult& band :
         traceForwardBands(rays, {{.sun = sun, .leaf = {0.6f, 0.3f}}, {.sun = sun, .leaf = {0.3f, 0.2f}}},
                           {.paths = kLeastUnits * 32})) {
      found.insert(found.end(), band.leaf_irradiance.begin(), band.leaf_irradiance.end());
      found.push_back(band.absorbed_wood.value);
    }
  }
  const std::string_view bytes(reinterpret_cast<const char*>(found.data()), found.size() * sizeof(double));
  return fmt::format("{:016x}", std::hash<std::string_view>()(bytes));
}

}  // namespace

std::vector<ForwardResult> keptTrace(const TreeMesh& mesh, const Stand& stand, const std::vector<TraceLight>& bands,
                                     std::uint64_t paths, const std::filesystem::path& folder) {
  const RayScene rays(mesh, stand, true);
  if (folder.empty()) return traceForwardBands(rays, bands, {.paths = paths, .seed = kSeed});
  static const std::string tracer = fingerprint();
  const ForwardJob job(rays, bands, pathsPerUnit(paths));
  const TreeMesh* const kind = &mesh;
  const TraceIdentity run{{"tracer", tracer}, {"hash of trees and places", standHash({&kind, 1}, stand)}};
  std::string all;
  for (const TraceIdentity& part : {run, job.identity()})
    for (const auto& [name, value] : part) all += fmt::format("{} = {}\n", name, value);
  std::filesystem::create_directories(folder);
  TraceStore store(folder / fmt::format("{:016x}.trace", std::hash<std::string>()(all)), kSecondsBetweenWrites, run);
  TraceSection& section = store.section("light", job);
  pursue(allOf(UnitRanges(0, unitsOf(paths, pathsPerUnit(paths)))), job, section, store, kSeed, 0);
  return job.results(section.sums);
}

}  // namespace sunfleck
