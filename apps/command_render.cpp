#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "apps/commands.hpp"
#include "apps/pictures.hpp"
#include "apps/product_stats.hpp"
#include "apps/scene_options.hpp"
#include "apps/terminal.hpp"
#include "apps/visible_by_rays.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/gl/opacity_map_store.hpp"
#include "render/gl/stand_picture.hpp"
#include "render/image_file.hpp"
#include "render/scene_images.hpp"
#include "render/stand_field.hpp"

namespace sunfleck::apps {
namespace {

constexpr std::size_t kRaysPerTriangle = 4;  // that are followed in the time in which llvmpipe draws a triangle

struct RenderOptions {
  SceneOptions scene;
  CameraOptions camera;
  GeometryEffort effort{.light_resolution = 1024};
  std::string model = "sppg", output;
  DisplayOptions display;
  int samples = 4;
  float detail = 0.f;
  std::vector<std::string> layers;
  bool stats = false, preview = false;
  std::string maps = "auto", visibility = "auto";
};

// Whether the light's maps are made by the graphics card: by default where there is one.
bool mapsByCard(const RenderOptions& options, const gl::Context& context) {
  return options.maps == "gpu" || (options.maps == "auto" && !context.drawsInSoftware());
}

// Whether what is seen is found by rays: by default where OpenGL draws on the processor, too, and there are more
// triangles than it draws in that time.
bool visibleByRays(const RenderOptions& options, const gl::Context& context, const Scene& scene) {
  if (options.visibility != "auto") return options.visibility == "rays";
  if (!context.drawsInSoftware() || options.detail > 0.f) return false;
  std::size_t triangles = 0;
  for (const Placement& tree : scene.stand.trees) {
    const TreeMesh& mesh = *scene.kindOf(tree).mesh;
    triangles += mesh.leaf_triangles.size() + mesh.wood_triangles.size();
  }
  const Camera camera = cameraOf(scene);
  return kRaysPerTriangle * triangles >
         static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
}

struct Drawn {
  Image image;
  bool maps_by_card, visible_by_rays;
  double prepare_seconds, shade_seconds;
  std::vector<ProductCost> costs;
  struct Field {
    int iterations;
    double error_bound;
  };
  std::optional<Field> field;
};

Drawn drawn(const Scene& scene, gl::PictureEffort picture, const RenderOptions& options, bool quiet) {
  Drawn drawn;
  const gl::Context context;
  drawn.maps_by_card = mapsByCard(options, context);
  drawn.visible_by_rays = visibleByRays(options, context, scene);
  std::optional<gl::OpacityMapStore> maps;
  MapMaker light_map;
  if (drawn.maps_by_card) {
    maps.emplace(context);
    light_map = [&](const std::shared_ptr<const TreeMesh>& mesh, Direction along, int resolution) {
      try {
        return maps->map(mesh, along, resolution).read();
      } catch (const gl::TooLarge&) {
        if (options.maps == "gpu") throw;
        return DeepOpacityMap(*mesh, along, resolution);
      }
    };
  }
  StandGeometry stand(options.effort, light_map);
  const auto seconds = [start = std::chrono::steady_clock::now()] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  GeometryNeeds needs = needsOf(picture.model);
  needs.preview = options.preview;
  stand.update(scene, needs, treesInPicture(scene, cameraOf(scene)), terminalProgress("opacity maps and cells", quiet),
               terminalProgress("light field", quiet));
  if (const StandField* field = stand.field())
    drawn.field = {.iterations = field->result().iterations, .error_bound = field->result().error_bound};
  drawn.prepare_seconds = seconds();
  drawn.costs = stand.costs();

  gl::StandRenderer renderer(context, exactPowerTable);
  const gl::DrawnStand to_draw = gl::drawnStand(scene, stand, maps ? &*maps : nullptr);
  renderer.update(to_draw);
  std::optional<VisibleByRays> rays;
  if (drawn.visible_by_rays) {
    rays.emplace(to_draw);
    picture.visible = std::cref(*rays);
  }
  drawn.image = gl::standPicture(context, renderer, cameraOf(scene), picture, terminalProgress("drawing", quiet));
  drawn.shade_seconds = seconds() - drawn.prepare_seconds;
  return drawn;
}

std::vector<gl::Layer> layersOf(const RenderOptions& options) {
  if (options.layers.empty()) return {};
  if (std::filesystem::path(options.output).extension() == ".png")
    throw InvalidInput("--layers with " + options.output + ": must be left out, as only .exr keeps layers");
  if (std::ranges::find(options.layers, gl::nameOf(gl::Layer::single)) != options.layers.end() &&
      !tellsSingle(*modelNamed(options.model)))
    throw InvalidInput("--layers single with --model " + options.model +
                       ": must be left out, as that model does not tell light scattered once before apart");
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
  if (options.preview && modelNamed(options.model) != Model::field)
    throw InvalidInput("--preview with --model " + options.model + ": must be with --model field");
  const gl::PictureEffort effort{.model = *modelNamed(options.model),
                                 .samples = options.samples,
                                 .piece_pixels = options.detail,
                                 .layers = layersOf(options),
                                 .exact = exactPowerTable};
  Scene scene = readScene(options.scene, Media::refused, Treeless::taken);
  requireNoImageOf(scene, options.output);
  apply(options.camera, scene);
  if (std::filesystem::path(options.scene.scene).extension() != ".toml") showGround(scene);  // a scene file says itself
  const Drawn result = [&] {
    try {
      return drawn(scene, effort, options, run.quiet);
    } catch (const gl::TooLarge& e) {
      throw InvalidInput(e.what_is == gl::TooLarge::What::light_map
                             ? fmt::format("--map = {}: {}", options.effort.light_resolution, e.what())
                             : e.what());
    }
  }();
  if (interrupted()) throw std::runtime_error("interrupted");
  writeImage(options.output, result.image, options.display.display());
  const char* const maps = result.maps_by_card ? "gpu" : "cpu";
  const char* const visibility = result.visible_by_rays ? "rays" : "raster";
  if (run.json) {
    nlohmann::ordered_json json{{"output", options.output},
                                {"model", options.model},
                                {"width", result.image.width},
                                {"height", result.image.height},
                                {"maps", maps},
                                {"visibility", visibility},
                                {"prepare_seconds", result.prepare_seconds},
                                {"shade_seconds", result.shade_seconds}};
    if (result.field)
      json["field"] = {{"by", options.preview ? "cells" : "lines"},
                       {"iterations", result.field->iterations},
                       {"error_bound", result.field->error_bound}};
    if (options.stats) json["products"] = statsJson(result.costs);
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return 0;
  }
  fmt::print("wrote {}: {} x {}, {}, {:.0f} ms to prepare, {:.0f} ms to draw\n", options.output, result.image.width,
             result.image.height, options.model, 1e3 * result.prepare_seconds, 1e3 * result.shade_seconds);
  if (result.field)
    fmt::print("light field {}: {} iterations, error of iteration below {:.2g} %\n",
               options.preview ? "on cells, a preview" : "along lines", result.field->iterations,
               100. * result.field->error_bound);
  if (options.stats) {
    fmt::print("maps by the {}, what is seen by {}\n", result.maps_by_card ? "graphics card" : "processor",
               result.visible_by_rays ? "rays" : "OpenGL");
    fmt::print("\n{}", statsTable(result.costs));
  }
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
                   "ss: light scattered once; spp: infinite slab; sppg: slab with G-factor (default); sppr, nstreamg, "
                   "pp: better slabs with G-factor, refined, by two streams, exact by a table; field: no slab, but "
                   "light that leaves, wood, ground and sky exchange")
      ->check([](const std::string& name) {
        return modelNamed(name) ? std::string() : "model \"" + name + "\": must be one of " + modelNames();
      });
  command->add_flag(
      "--preview", render->preview,
      "With --model field: solve it on the cells of the trees alone, as view does until the field is there; "
      "quicker, and some per cent off");
  addDisplayOptions(*command, render->display);
  command->add_option("--map", render->effort.light_resolution, "Pixels along the light's opacity map (default 1024)")
      ->transform(wholeNumberIn(1., 4096., "a whole number, 1 to 4096"));
  command
      ->add_option(
          "--maps", render->maps,
          "Who makes the light's opacity maps: gpu, cpu or auto (default): the graphics card where there is one")
      ->check(CLI::IsMember({"gpu", "cpu", "auto"}));
  command
      ->add_option(
          "--visibility", render->visibility,
          "What finds which leaf each pixel shows: raster, OpenGL; rays, which draw thousands of trees without a "
          "graphics card, all of their leaves; or auto (default): rays where there is none and the trees are many, "
          "unless --detail asks for fewer leaves")
      ->check(CLI::IsMember({"raster", "rays", "auto"}));
  command
      ->add_option("--samples", render->samples, "Frames averaged, each through other places of the pixels (default 4)")
      ->transform(wholeNumberIn(1., 65536., "a whole number, 1 to 65536"));
  command
      ->add_option(
          "--layers", render->layers,
          "Layers that an .exr holds beside the picture, by their names or all: direct, single, multiple, sky "
          "(parts of the picture: light scattered here alone, once before by ss, spp and sppg, all other, the sky's), "
          "geometry (normal, depth), foliage (leaves before and beyond, visible sun, G), "
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
