#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/commands.hpp"
#include "apps/pictures.hpp"
#include "apps/product_stats.hpp"
#include "apps/scene_options.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/gl/stand_picture.hpp"
#include "render/image_file.hpp"

namespace sunfleck::apps {
namespace {

struct RenderOptions {
  SceneOptions scene;
  CameraOptions camera;
  GeometryEffort effort{.light_resolution = 1024};
  std::string model = "sppg", output;
  float exposure = kExposure;
  int samples = 4;
  float detail = 0.f;
  std::vector<std::string> layers;
  bool stats = false;
};

std::vector<gl::Layer> layersOf(const RenderOptions& options) {
  if (options.layers.empty()) return {};
  if (std::filesystem::path(options.output).extension() == ".png")
    throw InvalidInput("--layers with " + options.output + ": must be left out, as only .exr keeps layers");
  std::vector<gl::Layer> layers;
  for (const gl::Layer layer : gl::kLayersBesideTotal)
    if (std::ranges::find(options.layers, "all") != options.layers.end() ||
        std::ranges::find(options.layers, gl::nameOf(layer)) != options.layers.end())
      layers.push_back(layer);
  return layers;
}

std::vector<std::string> layerNames() {
  std::vector<std::string> names{"all"};
  for (const gl::Layer layer : gl::kLayersBesideTotal) names.push_back(gl::nameOf(layer));
  return names;
}

int runRender(const RenderOptions& options, const RunOptions& run) {
  requirePictureName(options.output);
  const gl::PictureEffort effort{.model = *std::ranges::find(kModels, options.model, nameOf),
                                 .samples = options.samples,
                                 .piece_pixels = options.detail,
                                 .layers = layersOf(options),
                                 .exact = exactPowerTable};
  Scene scene = readScene(options.scene);
  apply(options.camera, scene);
  if (std::filesystem::path(options.scene.scene).extension() != ".toml") showGround(scene);  // a scene file says itself
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  StandGeometry stand(options.effort);
  stand.update(scene, needsOf(effort.model), treesInPicture(scene, cameraOf(scene)),
               terminalProgress("opacity maps and cells", run.quiet));
  const double prepared = seconds();
  const Image image = [&] {
    try {
      return gl::scenePicture(scene, stand, effort, terminalProgress("drawing", run.quiet));
    } catch (const gl::TooLarge& e) {
      const std::string what = e.what();
      const bool of_map = what.starts_with("the light's opacity map");
      throw InvalidInput(of_map ? fmt::format("--map = {}: {}", options.effort.light_resolution, what) : what);
    }
  }();
  const double shaded = seconds() - prepared;
  if (interrupted()) throw std::runtime_error("interrupted");
  writeImage(options.output, image, options.exposure);
  if (run.json) {
    nlohmann::ordered_json result{{"output", options.output}, {"model", options.model},      {"width", image.width},
                                  {"height", image.height},   {"prepare_seconds", prepared}, {"shade_seconds", shaded}};
    if (options.stats) result["products"] = statsJson(stand.costs());
    fmt::print("{}\n", result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return 0;
  }
  fmt::print("wrote {}: {} x {}, {}, {:.0f} ms to prepare, {:.0f} ms to draw\n", options.output, image.width,
             image.height, options.model, 1e3 * prepared, 1e3 * shaded);
  if (options.stats) fmt::print("\n{}", statsTable(stand.costs()));
  return 0;
}

}  // namespace

void addRender(CLI::App& app, RunOptions& options, int& status) {
  auto render = std::make_shared<RenderOptions>();
  CLI::App* command =
      addCommand(app, options, "render", "Draw a scene on the GPU, or without one in software; needs no display");
  addSceneOptions(*command, render->scene);
  addCameraOptions(*command, render->camera);
  command->add_option("-o,--output", render->output, "Picture to write: .exr (radiances) or .png")->required();
  command
      ->add_option("--model", render->model,
                   "ss: light scattered once; spp: infinite slab; sppg: slab with G-factor (default); sppr: that slab "
                   "refined, with G; nstreamg: a better slab, with G; pp: the exact slab, with G")
      ->check(CLI::IsMember([] {
        std::vector<std::string> names;
        for (const Model model : kModels) names.push_back(nameOf(model));
        return names;
      }()));
  command->add_option("--exposure", render->exposure, "Factor from radiance to brightness in a .png (default 3)")
      ->check(numberIn(1e-6, 1e6, "in [1e-6, 1e6]"));
  command->add_option("--map", render->effort.light_resolution, "Pixels along the light's opacity map (default 1024)")
      ->transform(wholeNumberIn(1., 4096., "a whole number, 1 to 4096"));
  command
      ->add_option("--samples", render->samples, "Frames averaged, each through other places of the pixels (default 4)")
      ->transform(wholeNumberIn(1., 65536., "a whole number, 1 to 65536"));
  command
      ->add_option(
          "--layers", render->layers,
          "Layers that an .exr holds beside the picture, by their names or all: direct, single, multiple, sky "
          "(parts of the picture), geometry (normal, depth), foliage (leaves before and beyond, visible sun, G), "
          "ids (tree, triangle, kind, leaf)")
      ->delimiter(',')
      ->check(CLI::IsMember(layerNames()));
  command
      ->add_option("--detail", render->detail,
                   "Draw fewer leaves and twigs, enlarged to at most so many pixels each; 0: all as they are (default)")
      ->check(numberIn(0., 1e4, "in [0, 1e4] pixels"));
  command->add_flag("--stats", render->stats, "Tell what was computed, reused and skipped, and what it took");
  command->callback([render, &options, &status] { status = runRender(*render, options); });
}

}  // namespace sunfleck::apps
