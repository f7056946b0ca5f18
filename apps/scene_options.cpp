#include "apps/scene_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <glm/trigonometric.hpp>

#include "core/require.hpp"
#include "render/radians.hpp"
#include "render/scene_file.hpp"
#include "sky/solar_position.hpp"

namespace sunfleck::apps {

void addSceneOptions(CLI::App& command, SceneOptions& options) {
  command.add_option("scene", options.scene,
                     "A scene (.toml, see: sunfleck --help scene), a mesh (.obj, .ply, .gltf, .glb, .txt) or a "
                     "built-in scene: a species "
                     "(cherry, maple, ...), with 1, 16 or 64 for as many trees, periodic, slab (default cherry)");
  const std::string group = "Scene";
  command
      .add_option("--albedo", options.albedo,
                  "Share of light that leaves scatter, half of it reflected; overrides the scene's optics")
      ->check(numberIn(0., 1., "in [0, 1]"))
      ->group(group);
  const auto leafOption = [&](const char* name, std::string& value, const char* about) {
    return command.add_option(name, value, about)
        ->group(group)
        ->excludes("--albedo")
        ->check([](const std::string& text) { return text.empty() ? "must not be empty" : std::string(); });
  };
  leafOption("--leaf-species", options.leaves.species,
             "Measured species whose leaves all trees bear (see: sunfleck leaf --list); overrides the scene's optics");
  leafOption("--leaf-prospect", options.leaves.prospect,
             "Leaves of all trees by their contents, such as chlorophyll=40,water=0.01 (see: sunfleck leaf --help)");
  leafOption("--leaf-bands", options.leaves.bands,
             "What the three bands are of leaves told so, in nm, such as 620:680,520:570,450 (default: red, green and "
             "blue of the eye)");
  command
      .add_option("--sun-zenith", options.sun_zenith_deg,
                  "Angle of the sun from overhead, in degrees; from 89.9 on it has set")
      ->check(numberIn(0., 180., "in [0, 180] degrees"))
      ->group(group);
  command.add_option("--sun-azimuth", options.sun_azimuth_deg, "Where the sun stands, in degrees from +x towards +y")
      ->check(numberIn(-360., 360., "in [-360, 360] degrees"))
      ->group(group);
  CLI::Option* date = command.add_option("--date", options.date,
                                         "The sun where it stands at this date and time, UTC or with an offset, as in "
                                         "2003-10-17T12:30-07:00; needs --place");
  CLI::Option* place =
      command
          .add_option("--place", options.place,
                      "Latitude and longitude of that sun, in degrees to the north and east; x is east, y north")
          ->expected(2)
          ->check(numberIn(-180., 180., "in [-180, 180] degrees"))
          ->group(group)
          ->needs(date);
  date->group(group)->needs(place)->excludes("--sun-zenith")->excludes("--sun-azimuth");
  command
      .add_option("--period", options.period, "Repeat the stand without end on a rectangle with these sides, in metres")
      ->expected(2)
      ->check(numberIn(1e-6, 1e6, "in [1e-6, 1e6] m"))
      ->group(group);
  addImportOptions(command, options.import);
}

namespace {

// What says how to read a mesh fits no other scene.
void requireMeshFor(const SceneOptions& options) {
  const std::filesystem::path extension = std::filesystem::path(options.scene).extension();
  if (!extension.empty() && extension != ".toml") return;
  if (const char* given = options.import.given())
    throw InvalidInput(fmt::format("{}: must be for a mesh file, not for {}", given, options.scene));
}

void placeSun(const SceneOptions& options, Sun& sun) {
  const std::size_t middle = options.date.find_first_of("T ");
  if (middle == std::string::npos)
    throw InvalidInput("--date = \"" + options.date + "\": must be a date and a time, as in 2003-10-17T12:30-07:00");
  const double latitude = (*options.place)[0], longitude = (*options.place)[1];
  require(std::abs(latitude) <= 90., "--place: latitude", latitude, "in [-90, 90] degrees");
  const SolarPosition stands =
      solarPosition(utcMoment(options.date.substr(0, middle), options.date.substr(middle + 1), "--date: "),
                    glm::radians(latitude), glm::radians(longitude));
  sun.zenith = static_cast<float>(stands.zenith);
  sun.azimuth = static_cast<float>(stands.azimuth);
}

// Reflectance and transmittance of all leaves; a gloss stays, and textures do but under --albedo, which makes leaves
// alike at all places.
void changeLeaves(const SceneOptions& options, Scene& scene) {
  if (!options.leaves.bands.empty() && !options.leaves.given())
    throw InvalidInput("--leaf-bands: must be with --leaf-species or --leaf-prospect");
  if (!options.albedo && !options.leaves.given()) return;
  LeafDescription leaf;
  BandOptics optics;
  if (options.albedo) {
    optics.fill({.reflectance = 0.5f * *options.albedo, .transmittance = 0.5f * *options.albedo});
  } else {
    if (!options.leaves.bands.empty()) scene.bands = lightBandsOf(options.leaves);
    leaf = leafOf(options.leaves);
    optics = bandOptics(leaf, scene.bands, {});
  }
  for (TreeKind& kind : scene.kinds) {
    kind.description = leaf;
    BandOptics told = kind.told();
    for (std::size_t band = 0; band < kBands; ++band) {
      told[band].reflectance = optics[band].reflectance;
      told[band].transmittance = optics[band].transmittance;
    }
    if (options.albedo) kind.textures = {};
    setLeaves(kind, scene.bands, told);
  }
  for (SceneMedium& medium : scene.media)
    if (!medium.particles) {
      medium.description = leaf;
      medium.optics = optics;
    }
}

}  // namespace

Scene readScene(const SceneOptions& options, Media media, Treeless treeless) {
  requireMeshFor(options);
  Scene scene = sunfleck::readScene(options.scene, options.import.rules());
  if (media == Media::refused && !scene.media.empty())
    throw InvalidInput(options.scene + ": has a [medium], which trace alone takes");
  if (treeless == Treeless::refused && scene.stand.trees.empty())
    throw InvalidInput(options.scene + ": stand.kind = \"none\": must have a tree (view and render take none)");
  for (const TreeKind& kind : scene.kinds)
    if (kind.dropped.leaf_triangles > 0)
      fmt::print(stderr, "sunfleck: {}: left out {} leaf triangles of no area{}\n", options.scene,
                 kind.dropped.leaf_triangles, scene.kinds.size() > 1 ? fmt::format(" of \"{}\"", kind.name) : "");
  if (scene.sky.negative_values > 0)
    fmt::print(stderr, "sunfleck: {}: took {} negative values of the sky for 0\n", scene.sky.file,
               scene.sky.negative_values);
  changeLeaves(options, scene);
  if (options.sun_zenith_deg) scene.suns.front().zenith = radiansOf(*options.sun_zenith_deg);
  if (options.sun_azimuth_deg) scene.suns.front().azimuth = radiansOf(*options.sun_azimuth_deg);
  if (!options.date.empty()) placeSun(options, scene.suns.front());
  if (options.period) scene.stand.period = glm::vec2((*options.period)[0], (*options.period)[1]);
  intoOnePeriod(scene.stand);
  return scene;
}

void addCameraOptions(CLI::App& command, CameraOptions& options, const std::string& target_name) {
  const std::string group = "Camera (shows the whole stand unless told otherwise)";
  command.add_option("--saved-camera", options.saved, "One that the scene file has saved, by its name")->group(group);
  command.add_option("--elevation", options.elevation_deg, "Height of the camera above the horizon, in degrees")
      ->check(numberIn(-90., 90., "in [-90, 90] degrees"))
      ->group(group);
  command.add_option("--azimuth", options.azimuth_deg, "Where the camera stands, in degrees from +x towards +y")
      ->check(numberIn(-360., 360., "in [-360, 360] degrees"))
      ->group(group);
  command.add_option(target_name, options.target, "Point in the middle of the picture: x y z, in metres")
      ->expected(3)
      ->check(numberIn(-1e6, 1e6, "in [-1e6, 1e6] m"))
      ->group(group);
  command.add_option("--half-width", options.half_width, "Half of the picture's width in the scene, in metres")
      ->check(numberIn(1e-6, 1e6, "in [1e-6, 1e6] m"))
      ->group(group);
  command
      .add_option("--field-of-view", options.field_of_view_deg,
                  "Of the picture's width, in degrees; 0: orthographic (default). In perspective, --half-width is that "
                  "at the point in the middle")
      ->check([](const std::string& text) {
        const bool zero = numberIn(0., 0., "0")(text).empty();
        return zero ? std::string() : numberIn(0.1, 150., "0 or in [0.1, 150] degrees")(text);
      })
      ->group(group);
  command.add_option("--size", options.size, "Width and height of the picture, in pixels")
      ->expected(2)
      ->transform(wholeNumberIn(1., 8192., "a whole number, 1 to 8192"))
      ->group(group);
}

void apply(const CameraOptions& options, Scene& scene) {
  if (!options.given()) return;
  if (!options.saved.empty()) scene.camera = savedCamera(scene, options.saved);
  Camera camera = scene.camera.value_or(kOverview);
  if (options.elevation_deg) camera.elevation = radiansOf(*options.elevation_deg);
  if (options.azimuth_deg) camera.azimuth = radiansOf(*options.azimuth_deg);
  if (options.field_of_view_deg) camera.field_of_view = radiansOf(*options.field_of_view_deg);
  if (options.size) {
    camera.width = (*options.size)[0];
    camera.height = (*options.size)[1];
  }
  if (!scene.camera) camera = showingAll(scene, camera);
  if (options.target) camera.target = {(*options.target)[0], (*options.target)[1], (*options.target)[2]};
  if (options.half_width) camera.half_width = *options.half_width;
  scene.camera = camera;
}

}  // namespace sunfleck::apps
