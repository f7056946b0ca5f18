#include "apps/sweep_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/nil_generator.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "apps/run_identity.hpp"
#include "apps/trace_output.hpp"
#include "core/csv_field.hpp"
#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/compare/validation.hpp"
#include "render/leaf_models.hpp"
#include "render/radians.hpp"
#include "render/reference/trace_goal.hpp"
#include "render/scene_file.hpp"

namespace sunfleck::apps {
namespace {

constexpr double kPaths = 4e6, kMostPaths = 1e15;
constexpr GeometryEffort kGeometry{};  // that of validate

std::string hashOf(const std::string& text) {
  return to_string(boost::uuids::name_generator_sha1(boost::uuids::nil_uuid())(text));
}

std::string textOf(const TraceIdentity& identity) {
  std::string text;
  for (const auto& [name, value] : identity) text += fmt::format("{}: {}\n", name, value);
  return text;
}

template <typename T>
std::string orNothing(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

// The optics that all kinds of trees share; nothing where they differ.
template <typename Optics>
auto shared(const Scene& scene, const Optics& of) -> std::optional<decltype(of(scene.kinds[0]))> {
  const auto first = of(scene.kinds[0]);
  const bool same =
      std::all_of(scene.kinds.begin(), scene.kinds.end(), [&](const auto& kind) { return of(kind) == first; });
  return same ? std::optional(first) : std::nullopt;
}

}  // namespace

std::string sweepHeader() {
  std::string header =
      "scene,sun_zenith_deg,sun_azimuth_deg,band,leaf_reflectance,leaf_transmittance,wood_reflectance,ground_albedo,"
      "wood,seed,paths_asked,target,model,paths";
  for (const NamedEstimate& figure : figuresOf(ForwardResult())) header += fmt::format(",{0},{0}_se", figure.name);
  return header + ",rms_noise,rms_category,rms_weighted,rms_leaf,bias";
}

SweepScene::SweepScene(const SweepFile& sweep, std::size_t scene, std::uint64_t seed)
    : sweep_(sweep),
      name_(sweep.scenes[scene]),
      seed_(seed),
      scene_(readScene(sweep.sceneFile(scene))),
      identity_(textOf(runIdentity(scene_, sweep.with_wood)) +
                fmt::format("seed {}, paths {}, target {}, maps {} {} {} {}\n", seed, orNothing(sweep.paths),
                            orNothing(sweep.target), kGeometry.light_resolution, kGeometry.sample_directions,
                            kGeometry.sample_resolution, kGeometry.cells)),
      rays_(meshes(scene_), scene_.stand, sweep.with_wood),
      stand_(kGeometry) {
  for (const TreeKind& kind : (sweep.with_wood ? scene_ : withoutWood(scene_)).kinds)
    field_meshes_.push_back(kind.mesh);
}

// The scene in one row. Optics stand in the band that they are of.
Scene SweepScene::sceneOf(const SweepTask& task, const SweepOptics& optics) const {
  Scene scene = scene_;
  if (task.sun.zenith_deg) scene.suns.front().zenith = radiansOf(*task.sun.zenith_deg);
  if (task.sun.azimuth_deg) scene.suns.front().azimuth = radiansOf(*task.sun.azimuth_deg);
  for (TreeKind& kind : scene.kinds) {
    if (optics.leaf && kind.maps)
      throw InvalidInput(name_ + ": leaves with maps: must be without other optics of leaves in the sweep");
    if (optics.leaf) kind.leaf[static_cast<std::size_t>(optics.band)] = *optics.leaf;
    if (optics.wood_reflectance) kind.wood_reflectance[optics.band] = *optics.wood_reflectance;
  }
  if (optics.ground_albedo) scene.ground_albedo[optics.band] = *optics.ground_albedo;
  return scene;
}

std::uint64_t SweepScene::pathsPerUnit() const {
  return sunfleck::pathsPerUnit(static_cast<std::uint64_t>(sweep_.paths.value_or(sweep_.target ? kMostPaths : kPaths)));
}

ForwardJob SweepScene::jobOf(const SweepTask& task) const {
  std::vector<TraceLight> bands;
  for (const SweepOptics& optics : task.optics) bands.push_back(traceLight(sceneOf(task, optics), optics.band));
  return ForwardJob(rays_, std::move(bands), pathsPerUnit());
}

std::vector<SweepRow> SweepScene::rows(const SweepTask& task) const {
  std::vector<SweepRow> rows;
  try {
    const std::string shared_identity = identity_ + textOf(jobOf(task).identity());
    for (std::size_t i = 0; i < task.optics.size(); ++i) {
      const SweepOptics& optics = task.optics[i];
      const Scene scene = sceneOf(task, optics);
      const auto leaf =
          shared(scene, [&](const TreeKind& kind) { return kind.leaf[static_cast<std::size_t>(optics.band)]; });
      const auto wood = shared(scene, [&](const TreeKind& kind) { return kind.wood_reflectance[optics.band]; });
      const std::string inputs = fmt::format(
          "{},{:.6g},{:.6g},{},{},{},{},{},{},{},{},{},", csvField(name_), glm::degrees(scene.sun().zenith),
          glm::degrees(scene.sun().azimuth), optics.leaf ? "" : std::to_string(optics.band),
          leaf ? fmt::format("{}", leaf->reflectance) : "", leaf ? fmt::format("{}", leaf->transmittance) : "",
          orNothing(wood), scene.ground_albedo[optics.band], sweep_.with_wood ? "with" : "without", seed_,
          sweep_.target ? orNothing(sweep_.paths) : fmt::format("{}", sweep_.paths.value_or(kPaths)),
          orNothing(sweep_.target));
      const auto add = [&](const std::string& model) {
        rows.push_back(
            {.key = hashOf(fmt::format("{}row {} of {}", shared_identity, i, model)), .inputs = inputs + model});
      };
      if (sweep_.monte_carlo) add("mc");
      for (const Model model : sweep_.models) requireValidatable(scene, model, optics.band);
      for (const Model model : sweep_.models) add(nameOf(model));
    }
  } catch (const InvalidInput& e) {
    const std::string message = e.what();
    throw InvalidInput(message.starts_with(name_) ? message : name_ + ": " + message);
  }
  return rows;
}

std::optional<std::vector<std::string>> SweepScene::figures(const SweepTask& task, int threads,
                                                            const Progress& progress) {
  const ForwardJob job = jobOf(task);
  TraceStore in_memory;
  TraceSection& section = in_memory.section("light", job);
  const auto units =
      unitsOf(static_cast<std::uint64_t>(sweep_.paths.value_or(sweep_.target ? kMostPaths : kPaths)), pathsPerUnit());
  const TraceGoal goal =
      sweep_.target ? until(
                          *sweep_.target, [&](const TraceSums& sums) { return job.relativeError(sums); }, units)
                    : allOf({0, units});
  if (!pursue(goal, job, section, in_memory, seed_, threads, progress)) return std::nullopt;
  const std::vector<ForwardResult> results = job.results(section.sums);

  LeafGeometry geometry;
  std::vector<Category> of_depths;
  if (!sweep_.models.empty()) {
    const Scene scene = sceneOf(task, task.optics[0]);
    try {
      stand_.update(scene, {}, std::nullopt, [&](double) { return goOn(progress, 1.); });
      geometry = leafGeometry(scene, stand_, [&](double) { return goOn(progress, 1.); });
    } catch (const std::runtime_error&) {
      if (!goOn(progress, 1.)) return std::nullopt;
      throw;
    }
    of_depths = categories(meanDepths(geometry));
  }

  std::vector<std::string> rows;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const ForwardResult& result = results[i];
    const std::string noise = orNothing(referenceNoise(result.leaf_irradiance, result.leaf_standard_error));
    std::string mc = std::to_string(result.paths), empty = mc;
    for (const NamedEstimate& figure : figuresOf(result)) {
      mc += fmt::format(",{},{}", figure.estimate.value, figure.estimate.standard_error);
      empty += ",,";
    }
    if (sweep_.monte_carlo) rows.push_back(fmt::format("{},{},,,,", mc, noise));
    const SweepOptics& optics = task.optics[i];
    std::vector<LeafOptics> leaf;
    for (const TreeKind& kind : sceneOf(task, optics).kinds)
      leaf.push_back(kind.leaf[static_cast<std::size_t>(optics.band)]);
    for (const Model model : sweep_.models) {
      std::vector<float> irradiance;
      try {
        irradiance = model == Model::field ? fieldIrradiance(sceneOf(task, optics), optics.band, progress)
                                           : leafIrradiance(model, geometry, leaf, exactPowerTable);
      } catch (const std::runtime_error&) {
        if (!goOn(progress, 1.)) return std::nullopt;
        throw;
      }
      const ModelErrors errors = modelErrors(irradiance, result.leaf_irradiance, of_depths);
      rows.push_back(fmt::format("{},{},{},{},{},{}", empty, noise, orNothing(errors.rms_category),
                                 orNothing(errors.rms_weighted), orNothing(errors.rms_leaf), orNothing(errors.bias)));
    }
  }
  return rows;
}

std::vector<float> SweepScene::fieldIrradiance(Scene scene, int band, const Progress& progress) {
  for (std::size_t kind = 0; kind < scene.kinds.size(); ++kind) scene.kinds[kind].mesh = field_meshes_[kind];
  field_.update(scene, FieldBy::lines, [&](double) { return goOn(progress, 1.); });
  return leafIrradiance(field_.result(), scene, band);
}

double SweepScene::guessedSeconds(const SweepTask& task) const {
  constexpr double kPilotSeconds = 0.2;
  const ForwardJob job = jobOf(task);
  TraceStore in_memory;
  TraceSection& section = in_memory.section("light", job);
  const Elapsed elapsed;
  TraceGoal pilot = allOf({0, kLeastUnits});
  pilot.seconds = kPilotSeconds;
  pursue(pilot, job, section, in_memory, seed_, 1);
  const auto units = static_cast<double>(section.sums.units());
  if (units == 0.) return 0.;
  const auto per_unit = static_cast<double>(pathsPerUnit());
  double wanted = std::ceil(sweep_.paths.value_or(sweep_.target ? kMostPaths : kPaths) / per_unit);
  // Errors fall with the root of the paths.
  if (sweep_.target) {
    const double more = std::pow(job.relativeError(section.sums) / *sweep_.target, 2.);
    wanted = std::min(wanted, std::max(static_cast<double>(kLeastUnits), units * more));
  }
  return elapsed.cpuSeconds() / units * wanted;
}

}  // namespace sunfleck::apps
