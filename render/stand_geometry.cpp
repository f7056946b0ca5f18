#include "render/stand_geometry.hpp"

#include <chrono>
#include <stdexcept>
#include <string>

#include "core/require.hpp"
#include "grid/neighbours.hpp"

namespace sunfleck {

void requireModelled(const Scene& scene) {
  const Stand& stand = scene.stand;
  require(stand.trees.size() <= kMostTrees, "number of trees", stand.trees.size(),
          "at most " + std::to_string(kMostTrees) + " for the models (trace takes any)");
  for (const Placement& tree : stand.trees)
    require(tree.rotation == 0.f, "rotation of a tree", tree.rotation,
            "0 for the models: their maps serve translated copies only (trace takes any)");
  periodsAround(stand, leafBounds(*scene.tree));
}

StandGeometry standGeometry(const Scene& scene, const GeometryEffort& effort, const Progress& progress) {
  requireModelled(scene);
  using Clock = std::chrono::steady_clock;
  const auto secondsSince = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };

  const TreeMesh& mesh = *scene.tree;
  const auto start = Clock::now();
  StandGeometry stand{.light = DeepOpacityMap(mesh, scene.sun(), effort.light_resolution)};
  stand.light_seconds = secondsSince(start);

  const auto start_compensation = Clock::now();
  const std::size_t trees = scene.stand.trees.size();
  const std::vector<DeepOpacityMap> maps =
      deepOpacityMaps(mesh, spreadAxes(effort.sample_directions / 2), effort.sample_resolution);
  stand.cells = cellGrid(mesh, effort.cells);
  for (std::size_t tree = 0; tree < trees; ++tree) {
    const std::vector<glm::vec3> neighbours = neighbourDisplacements(scene.stand, stand.cells.leaves, tree);
    const std::vector<float> depths = cellDepths(stand.cells, maps, neighbours);
    stand.compensation.push_back(cellCompensation(stand.cells, maps, depths, stand.light, neighbours));
    if (!goOn(progress, static_cast<double>(tree + 1) / static_cast<double>(trees)))
      throw std::runtime_error("interrupted");
  }
  stand.compensation_seconds = secondsSince(start_compensation);
  return stand;
}

}  // namespace sunfleck
