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
#include "render/gl/stand_picture.hpp"
#include "render/image_file.hpp"

namespace sunfleck::apps {
namespace {

struct RenderOptions {
  SceneOptions scene;
  CameraOptions camera;
  GeometryEffort effort{.light_resolution = 1024};
  std::string model = "sppg", output;
  DisplayOptions display;
  bool stats = false;
};

int runRender(const RenderOptions& options, const RunOptions& run) {
  requirePictureName(options.output);
  Scene scene = readScene(options.scene);
  apply(options.camera, scene);
  if (std::filesystem::path(options.scene.scene).extension() != ".toml") showGround(scene);  // a scene file says itself
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const Model model = *std::ranges::find(kModels, options.model, nameOf);
  StandGeometry stand(options.effort);
  stand.update(scene, needsOf(model), treesInPicture(scene, cameraOf(scene)),
               terminalProgress("opacity maps and cells", run.quiet));
  const double prepared = seconds();
  const Image image = [&] {
    try {
      return modelPicture(scene, stand, model, terminalProgress("drawing", run.quiet));
    } catch (const gl::TooLarge& e) {
      const std::string what = e.what();
      const bool of_map = what.starts_with("the light's opacity map");
      throw InvalidInput(of_map ? fmt::format("--map = {}: {}", options.effort.light_resolution, what) : what);
    }
  }();
  const double shaded = seconds() - prepared;
  if (interrupted()) throw std::runtime_error("interrupted");
  writeImage(options.output, image, options.display.display());
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
                   "ss: light scattered once; spp: infinite slab; sppg: slab with G-factor (default); nstreamg: a better "
                   "slab with G-factor")
      ->check(CLI::IsMember({"ss", "spp", "sppg", "nstreamg"}));
  addDisplayOptions(*command, render->display);
  command->add_option("--map", render->effort.light_resolution, "Pixels along the light's opacity map (default 1024)")
      ->transform(wholeNumberIn(1., 4096., "a whole number, 1 to 4096"));
  command->add_flag("--stats", render->stats, "Tell what was computed, reused and skipped, and what it took");
  command->callback([render, &options, &status] { status = runRender(*render, options); });
}

}  // namespace sunfleck::apps
