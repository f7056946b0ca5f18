#include "apps/bench_pictures.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/output_folder.hpp"
#include "apps/pictures.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/compare/picture_sheet.hpp"
#include "render/compare/pixel_rays.hpp"
#include "render/compare/validation.hpp"
#include "render/image_file.hpp"
#include "render/model.hpp"

namespace sunfleck::apps {
namespace {

namespace fs = std::filesystem;

struct BenchedScene {
  std::string name;
  Image sheet;
  std::vector<ComparedPicture> pictures;
};

struct Reference {
  Image radiance, standard_error;
};

// Of three bands, red, green and blue.
Reference traced(const Scene& scene, const PictureBenchOptions& options, const RunOptions& run) {
  const PixelRays pixels = pixelRays(scene);
  const auto paths = static_cast<std::uint64_t>(options.samples) * static_cast<std::uint64_t>(pixels.width) *
                     static_cast<std::uint64_t>(pixels.height);
  const std::vector<CameraResult> bands = traceCameraBands(
      RayScene(meshes(scene), scene.stand, true), traceLights(scene, {0, 1, 2}), pixels, bounds(scene).low.z,
      {.paths = paths, .seed = run.seed, .threads = run.threads}, terminalProgress("tracing " + scene.name, run.quiet));
  Reference reference;
  reference.radiance = {.width = pixels.width, .height = pixels.height, .channels = {"R", "G", "B"}, .values = {}};
  reference.standard_error = reference.radiance;
  for (std::size_t pixel = 0; pixel < bands.front().standard_error.values.size(); ++pixel)
    for (const CameraResult& band : bands) {
      reference.radiance.values.push_back(band.radiance.values[2 * pixel]);
      reference.standard_error.values.push_back(band.standard_error.values[pixel]);
    }
  return reference;
}

// None when it was interrupted.
std::optional<BenchedScene> benched(Scene scene, const PictureBenchOptions& options, const RunOptions& run) {
  BenchedScene result{.name = scene.name, .sheet = {}, .pictures = {}};
  StandGeometry stand(GeometryEffort{.light_resolution = 1024});
  for (const Model model : kModels) {
    stand.update(scene, needsOf(model), treesInPicture(scene, cameraOf(scene)),
                 terminalProgress("opacity maps and cells of " + scene.name, run.quiet));
    if (interrupted()) return std::nullopt;
    const std::string label = "drawing " + scene.name + ", " + nameOf(model);
    result.pictures.push_back(
        {nameOf(model), modelPicture(scene, stand, model, terminalProgress(label, run.quiet), options.samples), {}});
  }
  const Reference reference = traced(scene, options, run);
  if (interrupted()) return std::nullopt;
  for (ComparedPicture& of : result.pictures)
    of.error = pictureError(of.picture, reference.radiance, &reference.standard_error);
  result.sheet = pictureSheet(reference.radiance, result.pictures, options.display.display());
  return result;
}

std::string table(const std::vector<BenchedScene>& scenes) {
  std::string text = fmt::format("{:<14} {:<10} {:>20} {:>10} {:>10} {:>10}\n", "scene", "model", "RMS without noise",
                                 "with it", "noise", "bias");
  for (const BenchedScene& scene : scenes)
    for (const ComparedPicture& of : scene.pictures)
      text +=
          fmt::format("{:<14} {:<10} {:>20} {:>8.2f} % {:>8.2f} % {:>+8.2f} %\n", scene.name, of.model,
                      fmt::format("{:.2f} +- {:.2f} %", 100. * of.error.without_noise, 100. * of.error.standard_error),
                      100. * of.error.rms, 100. * of.error.noise, 100. * of.error.bias);
  return text + R"(
RMS over pixels and bands of the difference of radiances, relative to that of Monte Carlo, weighted by coverage. Noise: of
Monte Carlo; it is taken off the squares. Bias: of the sum of all radiance.
)";
}

nlohmann::ordered_json json(const std::vector<BenchedScene>& scenes) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const BenchedScene& scene : scenes)
    for (const ComparedPicture& of : scene.pictures)
      rows.push_back({{"scene", scene.name},
                      {"model", of.model},
                      {"rms_without_noise", of.error.without_noise},
                      {"standard_error", of.error.standard_error},
                      {"rms", of.error.rms},
                      {"noise_of_reference", of.error.noise},
                      {"bias", of.error.bias}});
  return {{"rows", std::move(rows)}};
}

}  // namespace

void addPictureBenchOptions(CLI::App& command, PictureBenchOptions& options) {
  command.add_option("scenes", options.scenes, "Scenes, built-in or files (default cherry16 and maple16)");
  command.add_option("--samples", options.samples, "Of each pixel, by the models and by Monte Carlo (default 64)")
      ->transform(wholeNumberIn(2., 65536., "a whole number, 2 to 65536"));
  addCameraOptions(command, options.camera);
  addDisplayOptions(command, options.display);
}

int runBenchPictures(const PictureBenchOptions& options, const std::string& folder_name, const RunOptions& run) {
  const fs::path folder(folder_name);
  std::vector<Scene> scenes;
  for (const std::string& name : options.scenes) {
    SceneOptions of;
    of.scene = name;
    Scene& scene = scenes.emplace_back(readScene(of));
    apply(options.camera, scene);
    requireDrawable(scene);
    traceLights(scene, {0, 1, 2});  // refuses light that cannot be traced, before long work
    for (std::size_t i = 0; i + 1 < scenes.size(); ++i)
      if (scenes[i].name == scene.name) throw InvalidInput("scene \"" + scene.name + "\": must be named once");
  }
  const OutputFolder made(folder);
  const auto sheetFile = [&](const std::string& name) { return folder / ("picture_bench_" + name + ".png"); };
  const fs::path csv = folder / "picture_bench.csv";
  requireWritable(csv);
  for (const Scene& scene : scenes) requireWritable(sheetFile(scene.name));

  std::vector<BenchedScene> all;
  for (const Scene& scene : scenes) {
    std::optional<BenchedScene> one;
    try {
      one = benched(scene, options, run);
    } catch (const std::runtime_error&) {
      if (!interrupted()) throw;
    }
    if (!one) {
      fmt::print(stderr, "sunfleck: interrupted: nothing was written\n");
      return 1;
    }
    all.push_back(std::move(*one));
  }
  std::string rows = pictureErrorHeader();
  for (const BenchedScene& scene : all) rows += pictureErrorRows(scene.name, scene.pictures);
  for (const BenchedScene& scene : all) writeImage(sheetFile(scene.name), scene.sheet, 1.f);
  writeWhole(csv, rows);
  if (run.json) {
    fmt::print("{}\n", json(all).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return 0;
  }
  fmt::print("{}\nwrote {}", table(all), csv.string());
  for (const BenchedScene& scene : all) fmt::print(", {}", sheetFile(scene.name).filename().string());
  fmt::print("\n");
  return 0;
}

}  // namespace sunfleck::apps
