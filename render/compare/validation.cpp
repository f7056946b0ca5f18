#include "render/compare/validation.hpp"

#include <cctype>
#include <chrono>
#include <cmath>
#include <numeric>

#include "core/require.hpp"
#include "render/compare/exact_powers.hpp"

namespace sunfleck {
namespace {

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
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
        light.of_kinds.push_back({kind.leaf[static_cast<std::size_t>(band)], kind.wood_reflectance[band]});
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

void requireValidatable(const Scene& scene, int band) {
  requireModelled(scene);
  require(scene.ground_albedo[band] == 0.f, "ground albedo", scene.ground_albedo[band],
          "0 for validation: the models know no ground");
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
                    const Progress& progress) {
  requireValidatable(scene, effort.band);
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
  result.reference = traceForward(rays, traceLight(scene, band), effort.trace, progress);
  result.reference_noise = referenceNoise(result.reference.leaf_irradiance, result.reference.leaf_standard_error);

  result.categories = categories(result.depths);
  result.leaves_left_out = result.leaves;
  for (const Category& category : result.categories) result.leaves_left_out -= category.leaves.size();
  result.category_noise =
      categoryNoise(result.reference.leaf_irradiance, result.reference.leaf_standard_error, result.categories);

  for (const Model model : kModels) {
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
