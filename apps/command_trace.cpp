#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/pictures.hpp"
#include "apps/scene_options.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/compare/validation.hpp"
#include "render/image_file.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"

namespace sunfleck::apps {
namespace {

struct TraceOptions {
  SceneOptions scene;
  CameraOptions camera;
  double paths = 4e6;
  int samples = 64;
  int band = 0;
  float exposure = kExposure;
  bool without_wood = false, only_picture = false;
  std::string leaves, picture;
};

struct Row {
  const char* name;
  const char* meaning;
  Estimate estimate;
};

std::vector<Row> rowsOf(const ForwardResult& r) {
  return {{"reflected", "back to the sky", r.reflected},
          {"absorbed_leaves", "absorbed by leaves", r.absorbed_leaves},
          {"absorbed_wood", "absorbed by wood", r.absorbed_wood},
          {"arriving_ground", "arriving at the ground", r.arriving_ground},
          {"arriving_ground_direct", "  without meeting a leaf", r.arriving_ground_direct},
          {"absorbed_ground", "absorbed by the ground", r.absorbed_ground}};
}

// Leaves of several kinds are told apart by the kind's name in a first column.
void writeLeaves(const std::string& file, const Scene& scene, const ForwardResult& result) {
  const bool several = scene.kinds.size() > 1;
  std::string text = several ? "kind," : "";
  text += "leaf,area_m2,irradiance,standard_error\n";
  std::size_t i = 0;
  for (const TreeKind& kind : scene.kinds) {
    const std::vector<double> areas = leafAreas(*kind.mesh);
    for (std::size_t leaf = 0; leaf < areas.size(); ++leaf, ++i) {
      if (several) text += kind.name + ",";
      text += fmt::format("{},{:.9g},{:.9g},{:.4g}\n", leaf, areas[leaf], result.leaf_irradiance[i],
                          result.leaf_standard_error[i]);
    }
  }
  writeWhole(file, text);
}

// JSON has no infinity: an error that is not known is null.
nlohmann::ordered_json known(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

int runTrace(const TraceOptions& options, const RunOptions& run) {
  if (!options.leaves.empty()) requireNamed(options.leaves, ".csv");
  if (!options.picture.empty()) requirePictureName(options.picture);
  Scene scene = readScene(options.scene);
  apply(options.camera, scene);
  const bool pictured = scene.camera || !options.picture.empty() || options.only_picture;

  const RayScene rays(meshes(scene), scene.stand, !options.without_wood);
  const TraceLight light = traceLight(scene, options.band);
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (!options.only_picture) {
    const TraceEffort effort{
        .paths = static_cast<std::uint64_t>(options.paths), .seed = run.seed, .threads = run.threads};
    const ForwardResult result = traceForward(rays, light, effort, terminalProgress("tracing light", run.quiet));
    if (!options.leaves.empty()) writeLeaves(options.leaves, scene, result);
    for (const Row& row : rowsOf(result)) {
      json[row.name] = row.estimate.value;
      json["standard_errors"][row.name] = known(row.estimate.standard_error);
    }
    json["paths"] = result.paths;
    json["seconds"] = result.seconds;
    json["cpu_seconds"] = result.cpu_seconds;
    if (!run.json) {
      fmt::print("{}: share of the incident light\n", scene.name);
      for (const Row& row : rowsOf(result))
        fmt::print("  {:<26} {:.6f} +- {:.6f}\n", row.meaning, row.estimate.value, row.estimate.standard_error);
      fmt::print("  {} paths in {:.1f} s, {:.2f} million per CPU second\n", result.paths, result.seconds,
                 static_cast<double>(result.paths) * 1e-6 / result.cpu_seconds);
    }
  }
  if (pictured && !interrupted()) {
    const PixelRays pixels = pixelRays(scene);
    const auto samples = static_cast<std::uint64_t>(options.samples) * static_cast<std::uint64_t>(pixels.width) *
                         static_cast<std::uint64_t>(pixels.height);
    const TraceEffort effort{.paths = samples, .seed = run.seed, .threads = run.threads};
    const CameraResult result = traceCamera(rays, light, pixels, bounds(scene).low.z, effort,
                                            terminalProgress("tracing the picture", run.quiet));
    if (!options.picture.empty()) writeImage(options.picture, result.radiance, options.exposure);
    json["image_mean"] = result.mean.value;
    json["image_mean_se"] = known(result.mean.standard_error);
    json["image_paths"] = result.paths;
    json["image_cpu_seconds"] = result.cpu_seconds;
    if (!run.json)
      fmt::print(
          "picture {} x {}: mean radiance {:.7f} +- {:.7f}; {} paths in {:.1f} s, {:.2f} million per CPU second\n",
          pixels.width, pixels.height, result.mean.value, result.mean.standard_error, result.paths, result.seconds,
          static_cast<double>(result.paths) * 1e-6 / result.cpu_seconds);
  }
  if (run.json) fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  for (const std::string& file : {options.leaves, options.picture})
    if (!file.empty() && !run.json && !interrupted()) fmt::print("wrote {}\n", file);
  if (interrupted()) fmt::print(stderr, "sunfleck: ended early: what is told rests on the paths done\n");
  return interrupted() ? 1 : 0;
}

}  // namespace

void addTrace(CLI::App& app, RunOptions& options, int& status) {
  auto trace = std::make_shared<TraceOptions>();
  CLI::App* command =
      addCommand(app, options, "trace",
                 "Monte Carlo: where the sun's light ends up, leaf by leaf, with standard errors; and what a "
                 "camera sees of it");
  addSceneOptions(*command, trace->scene);
  addCameraOptions(*command, trace->camera);
  command->add_option("--paths", trace->paths, "Paths of light from the sun (default 4e6)")
      ->check(numberIn(64., 1e15, "in [64, 1e15]"));
  command->add_option("--samples", trace->samples, "Paths through each pixel of the picture (default 64)")
      ->check(numberIn(1., 1e6, "a whole number, 1 to 1e6"));
  command->add_option("--band", trace->band, "Band of the scene's optics: 0, 1 or 2, red, green or blue (default 0)")
      ->check(numberIn(0., 2., "0, 1 or 2"));
  command->add_option("-o,--leaves", trace->leaves, "CSV to write: irradiance of each leaf and its standard error");
  command->add_option("--picture", trace->picture, "Picture to write: .exr (radiances) or .png");
  command->add_flag("--only-picture", trace->only_picture, "Trace the picture alone")->excludes("--leaves");
  command->add_option("--exposure", trace->exposure, "Factor from radiance to brightness in a .png (default 3)")
      ->check(numberIn(1e-6, 1e6, "in [1e-6, 1e6]"));
  command->add_flag("--without-wood", trace->without_wood, "Leave the wood out");
  command->callback([trace, &options, &status] { status = runTrace(*trace, options); });
}

}  // namespace sunfleck::apps
