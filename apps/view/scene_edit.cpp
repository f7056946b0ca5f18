#include "apps/view/scene_edit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/require.hpp"
#include "sky/preetham.hpp"

namespace sunfleck::view {
namespace {

constexpr float kFarthest = 1e6f;        // of a tree from the origin [m]
constexpr float kMostIrradiance = 10.f;  // of a sun, as in scene files
constexpr double kMostSkyIrradiance = 1000.;
constexpr int kMostSampleDirections = 200, kMostResolution = 4096, kMostCells = 64;

void requireShares(const glm::vec3& values, const std::string& what) {
  for (int band = 0; band < kBands; ++band)
    require(values[band] >= 0.f && values[band] <= 1.f, what, values[band], "in [0, 1]");
}

void requireTree(const Document& document, std::size_t tree) {
  const std::size_t trees = document.scene.stand.trees.size();
  require(tree < trees, "tree", tree + 1, "one of the stand's trees, 1 to " + std::to_string(trees));
}

void requirePlace(const glm::vec3& position) {
  for (int axis = 0; axis < 3; ++axis)
    require(std::abs(position[axis]) <= kFarthest, "place of the tree", position[axis], "in [-1e6, 1e6] m");
}

struct Apply {
  Document& document;

  void operator()(const SetSuns& edit) const {
    require(!edit.suns.empty() && edit.suns.size() <= kMostSuns, "number of suns", edit.suns.size(),
            "1 to " + std::to_string(kMostSuns));
    for (const Sun& sun : edit.suns) {
      require(sun.zenith >= 0.f && sun.zenith <= std::numbers::pi_v<float>, "zenith of the sun [rad]", sun.zenith,
              "in [0, pi]");
      require(std::isfinite(sun.azimuth), "azimuth of the sun [rad]", sun.azimuth, "finite");
      require(sun.diameter >= 0.f && sun.diameter <= 1.05f, "diameter of the sun [rad]", sun.diameter, "in [0, 1.05]");
      for (int band = 0; band < kBands; ++band)
        require(sun.irradiance[band] >= 0.f && sun.irradiance[band] <= kMostIrradiance, "irradiance of the sun",
                sun.irradiance[band], "in [0, 10]");
    }
    document.scene.suns = edit.suns;
  }
  void operator()(const SetSky& edit) const {
    require(edit.sky.turbidity >= kLeastTurbidity && edit.sky.turbidity <= kMostTurbidity, "turbidity",
            edit.sky.turbidity, "in [1.7, 10]");
    if (edit.sky.irradiance)
      for (int band = 0; band < kBands; ++band)
        require((*edit.sky.irradiance)[band] >= 0. && (*edit.sky.irradiance)[band] <= kMostSkyIrradiance,
                "irradiance of the sky", (*edit.sky.irradiance)[band], "in [0, 1000]");
    if (edit.sky.kind == SceneSky::Kind::image && !edit.sky.image)
      throw InvalidInput("a sky of kind image: must have an image");
    document.scene.sky = edit.sky;
    sunAndSky(document.scene);  // refuses a sky that cannot be
  }
  void operator()(const SetGround& edit) const {
    requireShares(edit.albedo, "albedo of the ground");
    document.scene.ground_albedo = edit.albedo;
    document.scene.ground_rpv.reset();
    document.scene.ground_texture.fill(nullptr);
  }
  void operator()(const SetOptics& edit) const {
    require(edit.kind < document.scene.kinds.size(), "kind", edit.kind + 1, "one of the scene's kinds");
    for (const LeafOptics& leaf : edit.leaf) validate(leaf);
    requireShares(edit.wood_reflectance, "reflectance of wood");
    TreeKind kind = document.scene.kinds[edit.kind];
    kind.description = edit.description;
    if (edit.textures) kind.textures = *edit.textures;
    kind.wood_reflectance = edit.wood_reflectance;
    setLeaves(kind, document.scene.bands, edit.leaf);
    document.scene.kinds[edit.kind] = std::move(kind);
  }
  void operator()(const SetModel& edit) const { document.model = edit.model; }
  void operator()(const SetEffort& edit) const {
    const GeometryEffort& e = edit.effort;
    require(e.sample_directions >= 2 && e.sample_directions <= kMostSampleDirections && e.sample_directions % 2 == 0,
            "directions", e.sample_directions, "an even number, 2 to 200");
    for (const int resolution : {e.light_resolution, e.sample_resolution})
      require(resolution >= 1 && resolution <= kMostResolution, "map resolution [pixel]", resolution, "in [1, 4096]");
    require(e.cells >= 1 && e.cells <= kMostCells, "cells along a tree", e.cells, "in [1, 64]");
    document.effort = e;
  }
  void operator()(const MoveTree& edit) const {
    requireTree(document, edit.tree);
    requirePlace(edit.position);
    document.scene.stand.trees[edit.tree].position = edit.position;
  }
  void operator()(const TurnTree& edit) const {
    requireTree(document, edit.tree);
    require(std::isfinite(edit.rotation), "rotation of the tree [rad]", edit.rotation, "finite");
    // One of equal trees must be turned to the bit alike, to share their maps.
    document.scene.stand.trees[edit.tree].rotation = std::remainder(edit.rotation, 2.f * std::numbers::pi_v<float>);
  }
  void operator()(const AddTrees& edit) const {
    require(!edit.trees.empty(), "number of trees to add", edit.trees.size(), "at least 1");
    for (const Placement& tree : edit.trees) {
      requirePlace(tree.position);
      require(tree.kind < document.scene.kinds.size(), "kind", tree.kind + 1, "one of the scene's kinds");
    }
    auto& trees = document.scene.stand.trees;
    trees.insert(trees.end(), edit.trees.begin(), edit.trees.end());
    document.selected = trees.size() - 1;
  }
  void operator()(const RemoveTrees& edit) const {
    auto& trees = document.scene.stand.trees;
    std::vector<std::size_t> removed = edit.trees;
    std::ranges::sort(removed, std::greater{});
    removed.erase(std::unique(removed.begin(), removed.end()), removed.end());
    for (const std::size_t tree : removed) requireTree(document, tree);
    for (const std::size_t tree : removed) trees.erase(trees.begin() + static_cast<std::ptrdiff_t>(tree));
    document.selected.reset();
  }
  void operator()(const AddKind& edit) const {
    requirePlace(edit.position);
    TreeKind kind = edit.kind;
    const auto taken = [&](const std::string& name) {
      return std::ranges::any_of(document.scene.kinds, [&](const TreeKind& other) { return other.name == name; });
    };
    setLeaves(kind, document.scene.bands, kind.told());
    for (int number = 2; taken(kind.name); ++number) kind.name = edit.kind.name + " " + std::to_string(number);
    document.scene.kinds.push_back(std::move(kind));
    document.scene.stand.trees.push_back(
        {.position = edit.position, .kind = static_cast<std::uint32_t>(document.scene.kinds.size() - 1)});
    document.selected = document.scene.stand.trees.size() - 1;
  }
  void operator()(const SaveCamera& edit) const {
    require(!edit.camera.name.empty() && edit.camera.name.size() <= kLongestCameraName, "name of the camera",
            edit.camera.name, "1 to 64 characters");
    const auto found = std::ranges::find(document.scene.saved_cameras, edit.camera.name, &SavedCamera::name);
    if (found == document.scene.saved_cameras.end())
      document.scene.saved_cameras.push_back(edit.camera);
    else
      found->camera = edit.camera.camera;
  }
  void operator()(const ForgetCamera& edit) const {
    const auto found = std::ranges::find(document.scene.saved_cameras, edit.name, &SavedCamera::name);
    if (found == document.scene.saved_cameras.end())
      throw InvalidInput("camera \"" + edit.name + "\": must be a saved one");
    document.scene.saved_cameras.erase(found);
  }
};

struct Name {
  const char* operator()(const SetSuns&) const { return "sun"; }
  const char* operator()(const SetSky&) const { return "sky"; }
  const char* operator()(const SetGround&) const { return "ground"; }
  const char* operator()(const SetOptics&) const { return "leaf and wood"; }
  const char* operator()(const SetModel&) const { return "model"; }
  const char* operator()(const SetEffort&) const { return "quality"; }
  const char* operator()(const MoveTree&) const { return "move tree"; }
  const char* operator()(const TurnTree&) const { return "turn tree"; }
  const char* operator()(const AddTrees& edit) const { return edit.trees.size() == 1 ? "add tree" : "paint trees"; }
  const char* operator()(const RemoveTrees& edit) const {
    return edit.trees.size() == 1 ? "delete tree" : "delete trees";
  }
  const char* operator()(const AddKind&) const { return "add kind"; }
  const char* operator()(const SaveCamera&) const { return "save camera"; }
  const char* operator()(const ForgetCamera&) const { return "forget camera"; }
};

}  // namespace

std::string nameOf(const SceneEdit& edit) {
  return std::visit(Name{}, edit);
}

namespace {

bool placesTrees(const SceneEdit& edit) {
  return std::holds_alternative<MoveTree>(edit) || std::holds_alternative<AddTrees>(edit) ||
         std::holds_alternative<AddKind>(edit);
}

}  // namespace

bool changesStand(const SceneEdit& edit) {
  return !std::holds_alternative<SetModel>(edit) && !std::holds_alternative<SaveCamera>(edit) &&
         !std::holds_alternative<ForgetCamera>(edit);
}

Document edited(Document document, const SceneEdit& edit) {
  std::visit(Apply{document}, edit);
  if (!placesTrees(edit)) return document;
  intoOnePeriod(document.scene.stand);
  requireDrawable(document.scene);
  return document;
}

}  // namespace sunfleck::view
