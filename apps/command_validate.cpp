#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/commands.hpp"
#include "apps/output_folder.hpp"
#include "apps/pictures.hpp"
#include "apps/product_stats.hpp"
#include "apps/scene_options.hpp"
#include "apps/terminal.hpp"
#include "apps/version.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "plants/species.hpp"
#include "render/compare/paper_table.hpp"
#include "render/compare/pixel_rays.hpp"
#include "render/compare/report_html.hpp"
#include "render/compare/report_json.hpp"
#include "render/compare/validation.hpp"
#include "render/image_file.hpp"
#include "render/scene_file.hpp"
#include "render/stand_field.hpp"

namespace sunfleck::apps {
namespace {

namespace fs = std::filesystem;

struct ValidateOptions {
  SceneOptions scene;
  CameraOptions camera;
  GeometryEffort geometry;
  ValidationEffort effort;
  double paths = 4e6;
  int samples = 64;
  std::string stand = "auto", folder = "sunfleck-report";
  bool stats = false;
  bool no_pictures = false;
};

// A lone tree is validated alone and repeated, as in the paper; a scene that says how its trees stand, as it says.
std::vector<Scene> scenesOf(const ValidateOptions& options, const Scene& given) {
  const fs::path path(options.scene.scene);
  const std::vector<std::string> species = speciesNames();
  const bool lone = std::find(species.begin(), species.end(), options.scene.scene) != species.end() ||
                    (path.has_extension() && path.extension() != ".toml");
  const std::string stand = options.stand != "auto" ? options.stand
                            : lone                  ? (given.stand.period ? "periodic" : "both")
                                                    : "given";
  if (stand == "given") return {given};
  Scene single = given, periodic = given;
  single.stand = Stand{};
  periodic.stand = {.period = given.stand.period.value_or(touchingPeriod(given))};
  if (stand == "single") return {single};
  if (stand == "periodic") return {periodic};
  return {single, periodic};
}

std::string percent(const std::optional<double>& fraction, const char* sign = "") {
  return fraction ? fmt::format("{}{:.1f} %", *fraction > 0. ? sign : "", 100. * *fraction) : "-";
}

// Ours and the paper's Table 3. Its tree is a cherry too, but not this one.
std::string table(std::span<const Validation> validations) {
  const Validation& first = validations.front();
  const std::size_t leaves = first.leaves, triangles = first.leaf_triangles;
  std::string text =
      fmt::format("{}: {} {} ({} {}), {:.4g} m2, albedo {:.3g}, sun {:.3g} degrees from the zenith\n", first.scene.name,
                  leaves, leaves == 1 ? "leaf" : "leaves", triangles, triangles == 1 ? "triangle" : "triangles",
                  first.leaf_area, first.albedo(), first.scene.sun().zenith * 57.29578f);
  for (const Validation& v : validations) {
    text += fmt::format("\n{:<12} RMS error against Monte Carlo, mean depth {:.2f} in {:.2f}\n", kindOf(v.scene),
                        v.mean_depth, v.mean_thickness);
    text += fmt::format("  {:<8} {:>12} {:>8} {:>12} {:>10} {:>12} {:>12}\n", "model", "by category", "paper",
                        "by leaves", "per leaf", "total light", "time");
    for (const ModelResult& m : v.models) {
      const std::optional<double> paper = paperError(v, m.model);
      text += fmt::format("  {:<8} {:>12} {:>8} {:>12} {:>10} {:>12} {:>9.0f} ms\n", labelOf(m.model),
                          percent(m.errors.rms_category), paper ? fmt::format("{:.3g} %", 100. * *paper) : "-",
                          percent(m.errors.rms_weighted), percent(m.errors.rms_leaf), percent(m.errors.bias, "+"),
                          1e3 * (m.prepare_seconds + m.shade_seconds));
    }
    text +=
        fmt::format("  {:<8} {:>12} {:>8} {:>12} {:>10} {:>12} {:>10.1f} s   ({:.3g} million paths)\n", "noise", "", "",
                    v.category_noise ? fmt::format("{:.2f} %", 100. * *v.category_noise) : "-",
                    percent(v.reference_noise), "", v.reference.seconds, static_cast<double>(v.reference.paths) * 1e-6);
    if (!v.reference_noise) text += "  no path of Monte Carlo lit a leaf: there is nothing to compare with\n";
    if (v.leaves_left_out > 0)
      text += fmt::format("  {} leaves are in categories of fewer than 5 and left out of the first and third column\n",
                          v.leaves_left_out);
  }
  if (validations.size() > 1) text += "\ntime: of the second stand without the maps that the first has left it\n";
  if (paperError(first, Model::ss))
    text += "\npaper: Table 3 of Shinya et al. 2013, for a cherry of its own; to be held against \"by category\"\n";
  return text;
}

std::vector<ReportPicture> makePictures(const ValidateOptions& options, const RunOptions& run, const Scene& given,
                                        const StandGeometry& stand) {
  Scene scene = given;
  showGround(scene);
  apply(options.camera, scene);
  if (!scene.camera) {
    Camera camera = kOverview;
    camera.width = camera.height = 480;
    scene.camera = showingAll(scene, camera);
  }
  const fs::path folder(options.folder);
  std::vector<ReportPicture> pictures;
  const auto keep = [&](const std::string& name, const std::string& caption, const Image& image) {
    writeImage(folder / (name + ".png"), image, kExposure);
    writeImage(folder / (name + ".exr"), image, kExposure);
    pictures.push_back({caption, pngBytes(image, kExposure)});
  };
  const auto by = [&](Model model) {
    return modelPicture(scene, stand, model, terminalProgress("drawing, " + labelOf(model), run.quiet));
  };
  keep("ss", "SS: light scattered once", by(Model::ss));
  keep("spp", "SPP: every leaf in an infinite slab", by(Model::spp));
  keep("sppg", "SPPG: the slab compensated for the crown's edge", by(Model::sppg));
  if (stand.field()) keep("field", "The light field: light that leaves exchange", by(Model::field));
  const PixelRays pixels = pixelRays(scene);
  const auto paths = static_cast<std::uint64_t>(options.samples) * static_cast<std::uint64_t>(pixels.width) *
                     static_cast<std::uint64_t>(pixels.height);
  const CameraResult traced = traceCamera(
      RayScene(meshes(scene), scene.stand, true), traceLight(scene, options.effort.band), pixels, bounds(scene).low.z,
      {.paths = paths, .seed = run.seed, .threads = run.threads}, terminalProgress("tracing the picture", run.quiet));
  keep("monte_carlo", "Monte Carlo: the reference", traced.radiance);
  return pictures;
}

// Pictures are worth having, but the figures do not hang on them: without OpenGL the report goes without.
std::vector<ReportPicture> picturesIfPossible(const ValidateOptions& options, const RunOptions& run, const Scene& scene,
                                              StandGeometry& stand) {
  try {
    stand.update(scene, {.field = fieldFits(scene)}, std::nullopt,
                 terminalProgress("opacity maps and cells", run.quiet), terminalProgress("light field", run.quiet));
    return makePictures(options, run, scene, stand);
  } catch (const InvalidInput&) {
    throw;
  } catch (const std::runtime_error& e) {
    if (!interrupted()) fmt::print(stderr, "sunfleck: no pictures: {}\n", e.what());
    return {};
  }
}

int runValidate(ValidateOptions& options, const RunOptions& run) {
  require(options.geometry.sample_directions % 2 == 0, "--directions", options.geometry.sample_directions, "even");
  options.effort.trace = {.paths = static_cast<std::uint64_t>(options.paths), .seed = run.seed, .threads = run.threads};
  const Scene given = readScene(options.scene);
  const std::vector<Scene> scenes = scenesOf(options, given);
  for (const Scene& scene : scenes) judgedModels(scene, options.effort.band);
  const OutputFolder made(options.folder);
  requireWritable(fs::path(options.folder) / "report.html");
  std::vector<Validation> validations;
  std::vector<ReportPicture> pictures;
  StandGeometry stand(options.geometry);
  for (const Scene& scene : scenes) {
    if (interrupted()) break;
    stand.update(scene, {}, std::nullopt, terminalProgress("opacity maps and cells", run.quiet));
    validations.push_back(validate(scene, stand, options.effort,
                                   terminalProgress("Monte Carlo, " + kindOf(scene), run.quiet),
                                   terminalProgress("light field, " + kindOf(scene), run.quiet)));
    const bool plain = scene.kinds.size() == 1 && std::ranges::all_of(scene.stand.trees, [](const Placement& tree) {
                         return tree.rotation == 0.f;
                       });
    const bool one_sun = traceLightsOfSuns(scene, {options.effort.band}).size() == 1;  // as the tracer's pictures have
    if (plain && one_sun && pictures.empty() && !options.no_pictures && !interrupted()) {
      pictures = picturesIfPossible(options, run, scene, stand);
    }
  }
  if (validations.empty()) {
    fmt::print(stderr, "sunfleck: ended before there was anything to report\n");
    return 1;
  }
  const fs::path folder(options.folder);
  const std::string json = reportJson(validations, version(), commit());
  writeWhole(folder / "report.json", json);
  writeWhole(
      folder / "report.html",
      reportHtml(validations, pictures, {.command = run.command_line, .version = version(), .commit = commit()}));
  if (run.json)
    fmt::print("{}", json);
  else
    fmt::print("{}\nwrote {}\n", table(validations), (folder / "report.html").string());
  if (options.stats) fmt::print(run.json ? stderr : stdout, "\n{}", statsTable(stand.costs()));
  if (interrupted()) fmt::print(stderr, "sunfleck: ended early: the report rests on the paths done\n");
  return interrupted() ? 1 : 0;
}

}  // namespace

void addValidate(CLI::App& app, RunOptions& options, int& status) {
  auto validate = std::make_shared<ValidateOptions>();
  CLI::App* command =
      addCommand(app, options, "validate",
                 "Judge every scattering model by Monte Carlo on a tree; writes report.html, report.json and pictures");
  addSceneOptions(*command, validate->scene);
  addCameraOptions(*command, validate->camera);
  command->add_option("-o,--output", validate->folder, "Folder to write to (default sunfleck-report)");
  command
      ->add_option("--stand", validate->stand,
                   "How the tree stands: single, periodic, both, or given by the scene (default: both for a lone tree, "
                   "else given)")
      ->check(CLI::IsMember({"single", "periodic", "both", "given"}));
  command->add_option("--paths", validate->paths, "Paths of light from the sun (default 4e6)")
      ->check(numberIn(64., 1e15, "in [64, 1e15]"));
  command
      ->add_option("--samples", validate->samples, "Monte Carlo paths through each pixel of the picture (default 64)")
      ->transform(wholeNumberIn(1., 1e6, "a whole number, 1 to 1e6"));
  command
      ->add_option("--band", validate->effort.band,
                   "Band of the scene's optics: 0, 1 or 2, red, green or blue (default 0)")
      ->transform(wholeNumberIn(0., 2., "0, 1 or 2"));
  command->add_flag("--with-wood", validate->effort.with_wood,
                    "Let wood stop light in Monte Carlo and in the field; the other models know leaves only");
  command->add_flag("--stats", validate->stats,
                    "Tell what was computed, reused and skipped, and what it took; on stderr with --json");
  command->add_flag("--no-pictures", validate->no_pictures, "Make no pictures");
  command
      ->add_option("--map", validate->geometry.light_resolution, "Pixels along the light's opacity map (default 512)")
      ->transform(wholeNumberIn(1., 4096., "a whole number, 1 to 4096"));
  command
      ->add_option("--directions", validate->geometry.sample_directions,
                   "Sample directions of the G-factor, an even number (default 22)")
      ->transform(wholeNumberIn(2., 4096., "an even number, 2 to 4096"));
  command->add_option("--cells", validate->geometry.cells, "Cells along the longest side of a tree (default 16)")
      ->transform(wholeNumberIn(1., 64., "a whole number, 1 to 64"));
  command->callback([validate, &options, &status] { status = runValidate(*validate, options); });
}

}  // namespace sunfleck::apps
