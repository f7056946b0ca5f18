#include "render/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <limits>
#include <string_view>

#include "core/require.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "render/detail/scene_table.hpp"

namespace sunfleck {
namespace {

float degrees(detail::SceneTable& table, const std::string& key, double low, double high, const std::string& rule) {
  return glm::radians(static_cast<float>(table.number(key, 0., low, high, rule)));
}

void growTree(Scene& scene, const std::string& species_name, std::uint64_t seed) {
  scene.kinds[0].mesh = std::make_shared<const TreeMesh>(grow(species(species_name), seed));
  scene.kinds[0].source = fmt::format("species {}, seed {}", species_name, seed);
}

void importFile(Scene& scene, const std::filesystem::path& file, const ImportRules& rules) {
  ImportedTree imported = importTree(file, rules);
  scene.kinds[0].mesh = std::make_shared<const TreeMesh>(std::move(imported.mesh));
  scene.kinds[0].source = fmt::format("{} (leaf and wood: {})", file.string(), imported.how);
  scene.kinds[0].dropped = imported.dropped;
}

// `side` x `side` trees, `spacing` apart, around the origin.
std::vector<Placement> square(int side, glm::vec2 spacing) {
  std::vector<Placement> trees;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const glm::vec2 at = spacing * (glm::vec2(static_cast<float>(column), static_cast<float>(row)) -
                                      0.5f * static_cast<float>(side - 1));
      trees.push_back({.position = {at, 0.f}});
    }
  return trees;
}

void readTree(Scene& scene, detail::SceneTable tree, const std::filesystem::path& folder) {
  if (tree.has("file") && tree.has("species"))
    throw InvalidInput(scene.name + ": [tree] has both file and species: must be one of them");
  if (tree.has("file")) {
    ImportRules rules;
    if (tree.has("leaf")) rules.leaf = {tree.text("leaf", "")};
    if (tree.has("wood")) rules.wood = {tree.text("wood", "")};
    rules.scale = static_cast<float>(tree.number("scale", 1., 1e-9, 1e9, "in [1e-9, 1e9]"));
    const std::string up = tree.text("up", "z");
    if (up != "z" && up != "y") throw InvalidInput(scene.name + ": tree.up = \"" + up + "\": must be \"z\" or \"y\"");
    rules.up = up == "y" ? ImportRules::Up::y : ImportRules::Up::z;
    importFile(scene, folder / tree.text("file", ""), rules);
  } else {
    const std::string name = tree.text("species", "cherry");
    growTree(scene, name, static_cast<std::uint64_t>(tree.count("seed", 1, std::numeric_limits<int>::max())));
  }
  tree.done();
}

void readStand(Scene& scene, detail::SceneTable stand) {
  const std::string kind = stand.text("kind", "single");
  const glm::vec2 touching = touchingPeriod(*scene.kinds[0].mesh);
  const auto sides = [&](const std::string& key) {
    if (!stand.has(key)) return touching;
    const auto v = stand.numbers(key, 2, 1e-6, 1e6, "two lengths in [1e-6, 1e6] m: [x, y]");
    return glm::vec2(static_cast<float>(v[0]), static_cast<float>(v[1]));
  };
  if (kind == "periodic") {
    if (stand.has("positions")) scene.stand.trees = stand.placements("positions");
    scene.stand.period = sides("period");
  } else if (kind == "grid") {
    scene.stand.trees = square(stand.count("side", 4, 100), sides("spacing"));
  } else if (kind == "positions") {
    if (!stand.has("positions"))
      throw InvalidInput(scene.name + ": [stand] of kind \"positions\" has no key positions");
    scene.stand.trees = stand.placements("positions");
  } else if (kind != "single") {
    throw InvalidInput(scene.name + ": stand.kind = \"" + kind + "\": must be single, periodic, grid or positions");
  }
  stand.done();
}

void readOptics(Scene& scene, detail::SceneTable leaf, detail::SceneTable wood, detail::SceneTable ground) {
  const glm::vec3 reflectance = leaf.perBand("reflectance", 0.475f);
  const glm::vec3 transmittance = leaf.perBand("transmittance", 0.475f);
  for (int band = 0; band < kBands; ++band) {
    scene.kinds[0].leaf[static_cast<std::size_t>(band)] = {.reflectance = reflectance[band],
                                                           .transmittance = transmittance[band]};
    validate(scene.kinds[0].leaf[static_cast<std::size_t>(band)]);
  }
  scene.kinds[0].wood_reflectance = wood.perBand("reflectance", 0.3f);
  scene.ground_albedo = ground.perBand("albedo", 0.f);
  for (const detail::SceneTable* table : {&leaf, &wood, &ground}) table->done();
}

void readCamera(Scene& scene, detail::SceneTable camera) {
  Camera read = kOverview;
  if (camera.has("elevation_deg")) read.elevation = degrees(camera, "elevation_deg", -90., 90., "in [-90, 90]");
  if (camera.has("azimuth_deg")) read.azimuth = degrees(camera, "azimuth_deg", -360., 360., "in [-360, 360]");
  read.width = camera.count("width", read.width, 8192);
  read.height = camera.count("height", read.height, 8192);
  read = showingAll(scene, read);
  if (camera.has("target")) {
    const auto v = camera.numbers("target", 3, -1e6, 1e6, "three coordinates in [-1e6, 1e6] m");
    read.target = {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  }
  read.half_width = static_cast<float>(
      camera.number("half_width", static_cast<double>(read.half_width), 1e-6, 1e6, "in [1e-6, 1e6] m"));
  camera.done();
  scene.camera = read;
}

Scene readTable(const toml::table& table, const std::filesystem::path& file) {
  for (const auto& [key, node] : table) {
    static constexpr std::array known{"name", "tree", "stand", "leaf", "wood", "ground", "sun", "camera"};
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      throw InvalidInput(fmt::format("{}:{}: unknown key \"{}\"; see: sunfleck --help scene", file.string(),
                                     node.source().begin.line, key.str()));
  }
  const auto section = [&](const char* name) { return detail::SceneTable(table, file.string(), name); };
  Scene scene;
  scene.name = file.string();  // until all is read: messages name the file
  readTree(scene, section("tree"), file.parent_path());
  readStand(scene, section("stand"));
  readOptics(scene, section("leaf"), section("wood"), section("ground"));
  detail::SceneTable sun = section("sun");
  scene.sun_zenith = degrees(sun, "zenith_deg", 0., 89.9, "in [0, 89.9]");
  scene.sun_azimuth = degrees(sun, "azimuth_deg", -360., 360., "in [-360, 360]");
  sun.done();
  if (table.contains("camera")) readCamera(scene, section("camera"));
  if (const toml::node* name = table.get("name"); name && !name->is_string())
    throw InvalidInput(fmt::format("{}:{}: name: must be a text in quotes", file.string(), name->source().begin.line));
  scene.name = table["name"].value_or(file.stem().string());
  return scene;
}

// The text of a scene file. toml++ keeps a table within a table for every dot of a key, without bound; no key of ours
// has more than one.
std::string readText(const std::filesystem::path& file) {
  constexpr int kMostDots = 32;
  if (!std::filesystem::is_regular_file(file)) throw InvalidInput(file.string() + ": must be a file that can be read");
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in) throw InvalidInput(file.string() + ": cannot be read");
  int line = 1, dots = 0;
  for (const char c : text) {
    line += c == '\n';
    if (std::string_view(",=[]{}#\n").find(c) != std::string_view::npos) dots = 0;
    if (c == '.' && ++dots > kMostDots)
      throw InvalidInput(
          fmt::format("{}:{}: more than {} dots on end: must be a number or a key", file.string(), line, kMostDots));
  }
  return text;
}

// Whatever is wrong, the message begins with the file.
Scene readToml(const std::filesystem::path& file) {
  try {
    return readTable(toml::parse(readText(file), file.string()), file);
  } catch (const toml::parse_error& e) {
    throw InvalidInput(fmt::format("{}:{}: {}", file.string(), e.source().begin.line, e.description()));
  } catch (const InvalidInput& e) {
    const std::string message = e.what();
    if (message.starts_with(file.string())) throw;
    throw InvalidInput(file.string() + ": " + message);
  }
}

// Blossoming cherry and autumn maple reflect and pass nearly all light; `albedo` of the paper's experiment.
constexpr LeafOptics kPaperLeaf{.reflectance = 0.475f, .transmittance = 0.475f};

std::optional<Scene> builtin(const std::string& name) {
  Scene scene;
  scene.name = name;
  scene.kinds[0].leaf.fill(kPaperLeaf);
  if (name == "slab") {
    const RandomLayer layer{};
    scene.kinds[0].mesh = std::make_shared<const TreeMesh>(randomLayer(layer, 1));
    scene.kinds[0].source = fmt::format("random square leaves, LAI {}, seed 1", layer.leaf_area_index);
    scene.stand.period = layer.size;
    return scene;
  }
  const std::string plant = name == "periodic" ? "cherry" : name.substr(0, name.find_first_of("0123456789"));
  const std::string copies = name == "periodic" ? "" : name.substr(plant.size());
  const std::vector<std::string> known = speciesNames();
  if (std::find(known.begin(), known.end(), plant) == known.end()) return std::nullopt;
  if (copies != "" && copies != "1" && copies != "16" && copies != "64") return std::nullopt;
  growTree(scene, plant, 1);
  if (copies == "16" || copies == "64")
    scene.stand.trees = square(copies == "16" ? 4 : 8, touchingPeriod(*scene.kinds[0].mesh));
  if (name == "periodic") scene.stand.period = touchingPeriod(*scene.kinds[0].mesh);
  return scene;
}

}  // namespace

glm::vec2 touchingPeriod(const TreeMesh& tree) {
  const glm::vec3 size = leafBounds(tree).size();
  return glm::max(glm::vec2(size), glm::vec2(0.15f * std::max({size.x, size.y, size.z})));
}

std::vector<std::string> builtinScenes() {
  std::vector<std::string> names{"periodic", "slab"};
  for (const std::string& plant : speciesNames())
    for (const char* copies : {"", "1", "16", "64"}) names.push_back(plant + copies);
  return names;
}

Scene readScene(const std::string& name_or_file, const ImportRules& rules) {
  const std::filesystem::path file(name_or_file);
  if (file.extension() == ".toml") return readToml(file);
  if (file.has_extension()) {
    Scene scene;
    scene.name = file.stem().string();
    scene.kinds[0].leaf.fill(kPaperLeaf);
    importFile(scene, file, rules);
    return scene;
  }
  if (std::optional<Scene> scene = builtin(name_or_file)) return *scene;
  throw InvalidInput(fmt::format("scene \"{}\": must be a .toml, .obj or .ply file or one of: {}", name_or_file,
                                 fmt::join(builtinScenes(), ", ")));
}

std::string sceneFileHelp() {
  return R"(A scene is a TOML file. Every key may be left out; the value shown is the default.
Lengths are metres, z is up. Optics are one number, or three for red, green and blue.

name = "file name"            # what reports call it

[tree]                        # the prototype: grown, or read from a file
species = "cherry"            # see: sunfleck plant --help
seed = 1
# file = "tree.obj"           # .obj or .ply beside the scene file, instead of species
# leaf = "leaf*"              # materials or groups of the file that are leaves ...
# wood = "bark*"              # ... and those that are wood; told by their names if not given
# scale = 1.0                 # metres per unit of the file, above 0
# up = "z"                    # the file's upward axis: "z" or "y"

[stand]
kind = "single"               # single | periodic | grid | positions
# period = [8.0, 8.0]         # periodic: sides of the repeated rectangle; the leaves' box if not given
# side = 4                    # grid: side x side trees, 1 to 100 ...
# spacing = [8.0, 8.0]        # ... this far apart; the leaves' box if not given
# positions = [[0, 0], [5, 1, 30]]   # positions, periodic: x, y and rotation_deg of each tree

[leaf]                        # Lambertian on both sides; reflectance + transmittance at most 1
reflectance = 0.475           # 0 to 1
transmittance = 0.475         # 0 to 1

[wood]
reflectance = 0.3             # 0 to 1

[ground]
albedo = 0.0                  # 0 to 1; 0: no ground. trace takes it for periodic stands and pictures

[sun]
zenith_deg = 0.0              # 0 overhead, to 89.9
azimuth_deg = 0.0             # where the sun stands, from +x towards +y

[camera]                      # orthographic; shows the whole stand if left out
# target = [0.0, 0.0, 4.0]    # point in the middle of the picture
# elevation_deg = 10.0        # -90 to 90
# azimuth_deg = 20.0          # where the camera stands, from +x towards +y
# half_width = 5.0            # half of the picture's width
# width = 512                 # pixels, 1 to 8192
# height = 512
)";
}

}  // namespace sunfleck
