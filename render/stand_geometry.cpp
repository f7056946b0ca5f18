#include "render/stand_geometry.hpp"

#include <cmath>
#include <glm/trigonometric.hpp>
#include <string>

#include "core/require.hpp"
#include "grid/neighbours.hpp"

namespace sunfleck {

void requireWholeLeaves(const Scene& scene, const std::string& what) {
  for (const TreeKind& kind : scene.kinds)
    if (!kind.mesh->leaf_cuts.empty())
      throw InvalidInput((scene.origin.empty() ? "" : scene.origin + ": ") + "\"" + kind.name +
                         "\" has leaves that masks cut out (map_d): must be whole for " + what +
                         " (trace alone takes masks)");
}

void requireModelled(const Scene& scene) {
  const Stand& stand = scene.stand;
  const std::string from = scene.origin.empty() ? "" : scene.origin + ": ";
  requireWholeLeaves(scene, "the models");
  for (const TreeKind& kind : scene.kinds)
    for (const LeafOptics& leaf : kind.leaf)
      require(leaf.gloss == 0.f, from + "leaf gloss", leaf.gloss,
              "0 for the models, whose leaves scatter by Lambert's law (trace takes any)");
  if (scene.ground_rpv || scene.ground_texture[0])
    throw InvalidInput(from + "ground.kind = " + (scene.ground_rpv ? "\"rpv\"" : "\"texture\"") +
                       ": must be \"lambert\" for the models (trace takes any)");
  require(scene.kinds.size() == 1, from + "number of kinds of trees", scene.kinds.size(),
          "1 for the models, which know one leaf alone (trace and voxelize --stand take any)");
  require(stand.trees.size() <= kMostTrees, from + "number of trees in [stand]", stand.trees.size(),
          "at most " + std::to_string(kMostTrees) + " for the models (trace takes any)");
  for (std::size_t i = 0; i < stand.trees.size(); ++i)
    require(stand.trees[i].rotation == 0.f, from + "stand.positions: rotation_deg of tree " + std::to_string(i + 1),
            std::round(glm::degrees(stand.trees[i].rotation) * 1e4f) / 1e4f,
            "0 for the models: their maps serve translated copies only (trace takes any)");
  if (scene.sky.kind != SceneSky::Kind::none || scene.sun_irradiance != glm::vec3(1.f) || scene.sun_diameter != 0.f)
    throw InvalidInput(
        from +
        "[sky], sun.irradiance and sun.diameter_deg: must be left out for the models, which know the sun "
        "as a point of irradiance 1 alone (trace takes any)");
  const Bounds box = leafBounds(*scene.kinds[0].mesh);
  periodsAround(stand, box);
  requireApart(stand, box);
}

StandGeometry::StandGeometry(const GeometryEffort& effort)
    : effort_(effort),
      stand_(std::make_unique<FoliageStand>(FoliageEffort{.axes = spreadAxes(effort.sample_directions / 2),
                                                          .sample_resolution = effort.sample_resolution,
                                                          .light_resolution = effort.light_resolution,
                                                          .cells = effort.cells})) {}

void StandGeometry::update(const Scene& scene, Model model, std::optional<std::span<const std::size_t>> trees,
                           const Progress& progress) {
  requireModelled(scene);
  if (!tree_)
    stand_->addPrototype(scene.kinds[0].mesh);
  else if (tree_ != scene.kinds[0].mesh) {
    stand_->setPeriod(std::nullopt);  // the former scene's may not suit the tree
    stand_->replacePrototype(0, scene.kinds[0].mesh);
  }
  tree_ = scene.kinds[0].mesh;
  stand_->setPeriod(scene.stand.period);
  const std::size_t before = stand_->instances(), now = scene.stand.trees.size();
  for (std::size_t i = 0; i < now; ++i)
    if (i < before)
      stand_->move(i, scene.stand.trees[i].position);
    else
      stand_->add(0, scene.stand.trees[i].position);
  for (std::size_t i = now; i < before; ++i) stand_->remove(i);
  const Direction sun = scene.sun();
  stand_->setLights(std::span(&sun, 1));

  light_seconds_ = compensation_seconds_ = 0.;
  cells_ = &stand_->cells(0);
  {
    const Stopwatch watch(light_seconds_);
    light_ = &stand_->lightMap(0, 0);
  }
  compensation_.clear();
  if (!needsCompensation(model)) return;
  const Stopwatch watch(compensation_seconds_);
  const std::vector<std::size_t> all = stand_->allInstances();
  const std::span<const std::size_t> wanted = trees.value_or(all);
  stand_->prepareCompensation(wanted, progress);
  compensation_.assign(now, std::vector<float>(cells_->count(), 0.f));
  for (const std::size_t i : wanted) compensation_[i] = spread(*cells_, stand_->compensation(i, 0));
}

}  // namespace sunfleck
