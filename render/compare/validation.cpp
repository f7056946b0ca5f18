#include "render/compare/validation.hpp"

#include <cctype>
#include <chrono>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <numeric>

#include "core/require.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/stand_field.hpp"

namespace sunfleck {
namespace {

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

ModelResult fieldResult(const Scene& scene, int band, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  StandField field;
  field.update(scene, FieldBy::lines, progress);
  ModelResult result{.model = Model::field, .irradiance = leafIrradiance(field.result(), scene, band)};
  const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const ProductCost& cost : field.costs())
    if (cost.name != "field: solutions") result.prepare_seconds += cost.seconds;
  result.shade_seconds = all - result.prepare_seconds;
  return result;
}

}  // namespace

std::vector<std::vector<TraceLight>> traceLightsOfSuns(const Scene& scene, const std::vector<int>& bands) {
  const SunAndSky shining = sunAndSky(scene);
  std::vector<std::size_t> lit;
  for (std::size_t i = 0; i < shining.suns.size(); ++i)
    if (shining.suns[i] != glm::vec3(0.f)) lit.push_back(i);
  const Sun overhead{.irradiance = glm::vec3(0.f)};
  std::vector<std::vector<TraceLight>> suns;
  for (std::size_t i = 0; i < std::max<std::size_t>(lit.size(), 1); ++i) {
    const Sun& sun = lit.empty() ? overhead : scene.suns[lit[i]];
    std::vector<TraceLight>& lights = suns.emplace_back();
    for (const int band : bands) {
      TraceLight& light =
          lights.emplace_back(TraceLight{.sun = sun.light(),
                                         .ground_albedo = scene.ground_albedo[band],
                                         .sun_irradiance = lit.empty() ? 0.f : shining.suns[lit[i]][band],
                                         .sun_diameter = sun.diameter,
                                         .sky = i == 0 ? shining.sky : nullptr,
                                         .sky_band = band});
      if (scene.ground_rpv) light.ground_rpv = (*scene.ground_rpv)[static_cast<std::size_t>(band)];
      light.ground_texture = scene.ground_texture[static_cast<std::size_t>(band)];
      for (const TreeKind& kind : scene.kinds)
        light.of_kinds.push_back({.leaf = kind.leaf[static_cast<std::size_t>(band)],
                                  .wood_reflectance = kind.wood_reflectance[band],
                                  .maps = kind.maps,
                                  .map_band = band});
      for (const SceneMedium& medium : scene.media)
        light.of_media.push_back(medium.optics[static_cast<std::size_t>(band)]);
    }
  }
  return suns;
}

std::vector<TraceLight> traceLights(const Scene& scene, const std::vector<int>& bands) {
  std::vector<std::vector<TraceLight>> suns = traceLightsOfSuns(scene, bands);
  require(suns.size() == 1, (scene.origin.empty() ? "" : scene.origin + ": ") + "number of suns that shine",
          suns.size(), "1 for Monte Carlo (render takes several; light adds up: trace one after the other)");
  return std::move(suns.front());
}

TraceLight traceLight(const Scene& scene, int band) {
  return traceLights(scene, {band}).front();
}

std::string kindOf(const Scene& scene) {
  if (scene.stand.period) return "periodic";
  return scene.stand.trees.size() == 1 ? "single tree" : std::to_string(scene.stand.trees.size()) + " trees";
}

std::string labelOf(Model model) {
  std::string label = nameOf(model);
  for (char& c : label) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return label;
}

namespace {

// The light and the ground that the models of slabs know.
void requireSlabs(const Scene& scene, int band) {
  requireModelled(scene);
  require(scene.ground_albedo[band] == 0.f, "ground albedo", scene.ground_albedo[band],
          "0 for validation: the models know no ground (field does, of stands that repeat)");
}

// Those that the field knows.
void requireForField(const Scene& scene, int band) {
  const std::string from = scene.origin.empty() ? "" : scene.origin + ": ";
  for (const TreeKind& kind : scene.kinds)
    for (const LeafOptics& leaf : kind.leaf)
      require(leaf.gloss == 0.f, from + "leaf gloss", leaf.gloss, "0 for validation of the field");
  for (const Sun& sun : scene.suns)
    require(sun.diameter == 0.f, from + "sun.diameter_deg", glm::degrees(sun.diameter),
            "0 for validation of the field");
  if (!scene.sun().up() || scene.sun().irradiance == glm::vec3(0.f))
    throw InvalidInput(from +
                       "the first sun: must shine from above the horizon: the depth of leaves is that in its light");
  require(scene.stand.trees.size() <= kMostTrees, from + "number of trees in [stand]", scene.stand.trees.size(),
          "at most " + std::to_string(kMostTrees) + " for the models (trace takes any)");
  if (!scene.stand.period)
    require(scene.ground_albedo[band] == 0.f, from + "ground albedo", scene.ground_albedo[band],
            "0 for validation of a stand that does not repeat");
  requireDrawable(scene);
  requireField(scene);
}

// Light of several suns adds up.
ForwardResult tracedAll(const RayScene& rays, const Scene& scene, const ValidationEffort& effort,
                        const Progress& progress) {
  const std::vector<std::vector<TraceLight>> suns = traceLightsOfSuns(scene, {effort.band});
  std::optional<ForwardResult> sum;
  for (std::size_t i = 0; i < suns.size(); ++i) {
    TraceEffort of_sun = effort.trace;
    of_sun.seed += i;
    ForwardResult result = traceForward(rays, suns[i].front(), of_sun, [&](double done) {
      return goOn(progress, (static_cast<double>(i) + done) / static_cast<double>(suns.size()));
    });
    if (!sum) {
      sum = std::move(result);
      continue;
    }
    for (std::size_t leaf = 0; leaf < sum->leaf_irradiance.size(); ++leaf) {
      sum->leaf_irradiance[leaf] += result.leaf_irradiance[leaf];
      sum->leaf_standard_error[leaf] = std::hypot(sum->leaf_standard_error[leaf], result.leaf_standard_error[leaf]);
    }
    sum->paths += result.paths;
    sum->seconds += result.seconds;
    sum->cpu_seconds += result.cpu_seconds;
  }
  return std::move(*sum);
}

}  // namespace

void requireValidatable(const Scene& scene, Model model, int band) {
  if (model == Model::field)
    requireForField(scene, band);
  else
    requireSlabs(scene, band);
}

std::vector<Model> judgedModels(const Scene& scene, int band) {
  std::vector<Model> judged;
  std::optional<InvalidInput> why;
  for (const Model model : kModels) try {
      requireValidatable(scene, model, band);
      judged.push_back(model);
    } catch (const InvalidInput& wrong) {
      if (!why) why = wrong;
    }
  if (judged.empty()) throw *why;
  return judged;
}

std::vector<LeafOptics> Validation::optics() const {
  std::vector<LeafOptics> of_kinds;
  for (const TreeKind& kind : scene.kinds) of_kinds.push_back(kind.leaf[static_cast<std::size_t>(effort.band)]);
  return of_kinds;
}

double Validation::albedo() const {
  double sum = 0., area = 0.;
  for (const TreeKind& kind : scene.kinds) {
    const double of_kind = leafArea(*kind.mesh);
    sum += of_kind * double{kind.leaf[static_cast<std::size_t>(effort.band)].albedo()};
    area += of_kind;
  }
  return sum / area;
}

Validation validate(const Scene& scene, const StandGeometry& stand, const ValidationEffort& effort,
                    const Progress& progress, const Progress& field_progress) {
  const std::vector<Model> models = judgedModels(scene, effort.band);
  const auto band = effort.band;
  Validation result{.scene = scene, .effort = effort};
  const LeafGeometry geometry = leafGeometry(scene, stand, [&](double) { return goOn(progress, 0.); });
  result.depths = meanDepths(geometry);
  result.mean_depth = mean(result.depths.depth);
  result.mean_thickness = mean(result.depths.thickness);
  for (const TreeKind& kind : scene.kinds) {
    result.leaves += kind.mesh->leaf_count;
    result.leaf_triangles += kind.mesh->leaf_triangles.size();
    result.leaf_area += leafArea(*kind.mesh);
  }

  const RayScene rays(meshes(scene), scene.stand, effort.with_wood);
  result.reference = tracedAll(rays, scene, effort, progress);
  result.reference_noise = referenceNoise(result.reference.leaf_irradiance, result.reference.leaf_standard_error);

  result.categories = categories(result.depths);
  result.leaves_left_out = result.leaves;
  for (const Category& category : result.categories) result.leaves_left_out -= category.leaves.size();
  result.category_noise =
      categoryNoise(result.reference.leaf_irradiance, result.reference.leaf_standard_error, result.categories);

  const Scene scattering = effort.with_wood ? scene : withoutWood(scene);
  for (const Model model : models) {
    if (model == Model::field) {
      if (!goOn(field_progress, 0.)) continue;
      try {
        result.models.push_back(fieldResult(scattering, band, field_progress));
      } catch (const std::runtime_error&) {
        if (goOn(field_progress, 1.)) throw;
        continue;
      }
      result.models.back().errors =
          modelErrors(result.models.back().irradiance, result.reference.leaf_irradiance, result.categories);
      continue;
    }
    ModelResult& of_model = result.models.emplace_back();
    of_model.model = model;
    const auto start = std::chrono::steady_clock::now();
    of_model.irradiance = leafIrradiance(model, geometry, result.optics(), exactPowerTable);
    of_model.shade_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    of_model.prepare_seconds =
        stand.lightSeconds() + geometry.depth_seconds +
        (needsCompensation(model) ? stand.compensationSeconds() + geometry.compensation_seconds : 0.);
    of_model.errors = modelErrors(of_model.irradiance, result.reference.leaf_irradiance, result.categories);
  }
  return result;
}

}  // namespace sunfleck
