#include "render/compare/scene_contestants.hpp"

#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "field/large_stand.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/compare/validation.hpp"
#include "render/leaf_models.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/stand_field.hpp"

namespace sunfleck {
namespace {

// The same with the sun elsewhere, above the horizon.
Scene turned(const Scene& scene) {
  constexpr float kTurn = 0.1f;
  Scene other = scene;
  Sun& sun = other.suns.front();
  sun.zenith += sun.zenith > 0.5f ? -kTurn : kTurn;
  return other;
}

std::vector<LeafOptics> opticsOf(const Scene& scene, int band) {
  std::vector<LeafOptics> optics;
  for (const TreeKind& kind : scene.kinds) optics.push_back(kind.leaf[static_cast<std::size_t>(band)]);
  return optics;
}

class ModelContestant final : public SceneContestant {
 public:
  ModelContestant(const Scene& scene, Model model, const GeometryEffort& effort, int band)
      : scene_(scene), turned_(turned(scene)), optics_(opticsOf(scene, band)), model_(model), effort_(effort) {}

  std::vector<float> fromNothing(int /*round*/, const Progress& progress) override {
    stand_.emplace(effort_);
    tables_.clear();
    return answer(progress);
  }
  void turnAway(const Progress& progress) override { stand_->update(turned_, needsOf(model_), std::nullopt, progress); }
  std::vector<float> sunTurned(int /*round*/, const Progress& progress) override { return answer(progress); }

 private:
  std::vector<float> answer(const Progress& progress) {
    stand_->update(scene_, needsOf(model_), std::nullopt, progress);
    // Tables of the exact solution hang on optics alone.
    const auto exact = [this](const LeafOptics& optics) {
      const std::pair key(optics.reflectance, optics.transmittance);
      const auto found = tables_.find(key);
      return found != tables_.end() ? found->second : tables_.emplace(key, exactPowerTable(optics)).first->second;
    };
    return leafIrradiance(model_, leafGeometry(scene_, *stand_, progress), optics_, exact);
  }

  const Scene& scene_;
  const Scene turned_;
  const std::vector<LeafOptics> optics_;
  const Model model_;
  const GeometryEffort effort_;
  std::optional<StandGeometry> stand_;
  std::map<std::pair<float, float>, spp::PowerTable> tables_;
};

class FieldContestant final : public SceneContestant {
 public:
  //   number  of axes of lines, or of cells along a tree
  FieldContestant(const Scene& scene, FieldBy by, int number, int band)
      : scene_(scene), turned_(turned(scene)), band_(band), by_(by), number_(number) {}

  std::vector<float> fromNothing(int /*round*/, const Progress& progress) override {
    field_.emplace(FieldEffort{.exchange = {.axes = number_}}, CellFieldEffort{.cells = {.cells = number_}});
    return answer(progress);
  }
  void turnAway(const Progress& progress) override { field_->update(turned_, by_, progress); }
  std::vector<float> sunTurned(int /*round*/, const Progress& progress) override { return answer(progress); }

 private:
  std::vector<float> answer(const Progress& progress) {
    field_->update(scene_, by_, progress);
    return leafIrradiance(field_->result(), scene_, band_);
  }

  const Scene scene_, turned_;
  const int band_;
  const FieldBy by_;
  const int number_;
  std::optional<StandField> field_;
};

// A stand's trees each by itself, in the light that comes from the others in cells.
class StandContestant final : public SceneContestant {
 public:
  StandContestant(const Scene& scene, int cells, int band)
      : scene_(scene),
        turned_(turned(scene)),
        band_(band),
        effort_{.cells_along = cells},
        all_(scene.stand.trees.size()) {
    std::iota(all_.begin(), all_.end(), std::size_t{0});
    for (const TreeKind& kind : scene.kinds) meshes_.push_back(kind.mesh);
  }

  std::vector<float> fromNothing(int /*round*/, const Progress& progress) override {
    field_.emplace(effort_);
    field_->setStand(meshes_, scene_.stand);
    return answer(progress);
  }
  void turnAway(const Progress& progress) override { field_->solve(fieldLighting(turned_), all_, {}, progress); }
  std::vector<float> sunTurned(int /*round*/, const Progress& progress) override { return answer(progress); }

 private:
  std::vector<float> answer(const Progress& progress) {
    return leafIrradiance(field_->solve(fieldLighting(scene_), all_, {}, progress), scene_, band_);
  }

  const Scene scene_, turned_;
  const int band_;
  const LargeStandEffort effort_;
  std::vector<std::size_t> all_;
  std::vector<std::shared_ptr<const TreeMesh>> meshes_;
  std::optional<LargeStandField> field_;
};

class TraceContestant final : public SceneContestant {
 public:
  TraceContestant(const Scene& scene, const TraceEffort& effort, std::uint64_t seeds_apart, int band, bool with_wood)
      : scene_(scene), light_(traceLight(scene, band)), effort_(effort), apart_(seeds_apart), with_wood_(with_wood) {}

  std::vector<float> fromNothing(int round, const Progress& progress) override {
    rays_.emplace(meshes(scene_), scene_.stand, with_wood_);
    return traced(2 * round, progress);
  }
  void turnAway(const Progress& /*progress*/) override {}
  std::vector<float> sunTurned(int round, const Progress& progress) override { return traced(2 * round + 1, progress); }

 private:
  std::vector<float> traced(int turn, const Progress& progress) {
    TraceEffort effort = effort_;
    effort.seed += static_cast<std::uint64_t>(turn) * apart_;
    const ForwardResult result = traceForward(*rays_, light_, effort, progress);
    return {result.leaf_irradiance.begin(), result.leaf_irradiance.end()};
  }

  const Scene& scene_;
  const TraceLight light_;
  const TraceEffort effort_;
  const std::uint64_t apart_;
  const bool with_wood_;
  std::optional<RayScene> rays_;
};

}  // namespace

std::vector<NamedSceneContestant> sceneContestants(const Scene& scene, const std::vector<Model>& models,
                                                   const GeometryEffort& geometry,
                                                   const std::vector<std::uint64_t>& paths, const TraceEffort& trace,
                                                   int band, bool with_wood) {
  std::vector<NamedSceneContestant> all;
  const Scene scattering = with_wood ? scene : withoutWood(scene);
  for (const Model model : models) {
    if (model != Model::field) {
      all.push_back({.method = nameOf(model),
                     .work = needsCompensation(model) ? 4e5 : 5e4,
                     .contestant = std::make_unique<ModelContestant>(scene, model, geometry, band)});
      continue;
    }
    for (const int axes : {10, 20, 40, 80})
      all.push_back({.method = nameOf(model),
                     .setting = static_cast<double>(axes),
                     .work = 1e4 * axes,
                     .contestant = std::make_unique<FieldContestant>(scattering, FieldBy::lines, axes, band)});
    for (const int cells : {4, 8, 16})
      if (scene.stand.trees.size() > 1)
        all.push_back({.method = "stand",
                       .setting = static_cast<double>(cells),
                       .work = 5e5,
                       .contestant = std::make_unique<StandContestant>(scattering, cells, band)});
    for (const int cells : {8, 16, 24, 32})
      all.push_back({.method = "grid",
                     .setting = static_cast<double>(cells),
                     .work = 1e5,
                     .contestant = std::make_unique<FieldContestant>(scattering, FieldBy::cells, cells, band)});
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    TraceEffort effort = trace;
    effort.paths = paths[i];
    effort.seed = trace.seed + 1 + i;
    all.push_back({.method = "monte_carlo",
                   .setting = static_cast<double>(paths[i]),
                   .work = static_cast<double>(2 * paths[i]),
                   .contestant = std::make_unique<TraceContestant>(scene, effort, paths.size(), band, with_wood)});
  }
  return all;
}

}  // namespace sunfleck
