#include "render/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <glm/trigonometric.hpp>
#include <limits>
#include <map>

#include "core/detail/toml_file.hpp"
#include "core/require.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "render/detail/scene_leaf_file.hpp"
#include "render/detail/scene_light_file.hpp"
#include "render/detail/scene_media_file.hpp"
#include "render/detail/scene_table.hpp"
#include "render/image_file.hpp"
#include "render/radians.hpp"

namespace sunfleck {
namespace {

// Blossoming cherry and autumn maple reflect and pass nearly all light; `albedo` of the paper's experiment.
constexpr LeafOptics kPaperLeaf{.reflectance = 0.475f, .transmittance = 0.475f};

// Without a tree yet.
TreeKind kindWith(const LeafOptics& leaf) {
  TreeKind kind;
  kind.leaf.fill(leaf);
  return kind;
}

// `species_name`: a name, or a parameter file.
void growTree(TreeKind& kind, const std::string& species_name, std::uint64_t seed) {
  kind.mesh = std::make_shared<const TreeMesh>(grow(speciesOrFile(species_name), seed));
  kind.source = fmt::format("species {}, seed {}", species_name, seed);
  kind.recipe = {.species = species_name, .seed = seed, .file = {}, .rules = {}};
  kind.name = std::filesystem::path(species_name).stem().string();
}

// `keep_optics`: whether those of the kind are the user's, which come before the file's own.
void takeImported(TreeKind& kind, const std::filesystem::path& file, const ImportRules& rules, ImportedTree imported,
                  bool keep_optics) {
  kind.source = fmt::format("{} (leaf and wood: {})", file.string(), imported.how);
  kind.dropped = imported.dropped;
  kind.recipe = {.species = {}, .file = file, .rules = rules};
  kind.name = rules.mesh.empty() ? file.stem().string() : rules.mesh;
  if (imported.colours && !keep_optics)
    for (int band = 0; band < kBands; ++band) {
      LeafOptics& leaf = kind.leaf[static_cast<std::size_t>(band)];
      leaf.reflectance = imported.colours->reflectance[band];
      leaf.transmittance = imported.colours->transmittance[band];
    }
  kind.mesh = std::make_shared<const TreeMesh>(std::move(imported.mesh));
}

void importFile(TreeKind& kind, const std::filesystem::path& file, const ImportRules& rules, bool keep_optics) {
  takeImported(kind, file, rules, importTree(file, rules, readOpacity), keep_optics);
}

// The scene that a mesh file is: a tree, or a stand of instances.
void importScene(Scene& scene, const std::filesystem::path& file, const ImportRules& rules) {
  ImportedStand imported = importStand(file, rules, readOpacity);
  scene.kinds.assign(imported.kinds.size(), kindWith(kPaperLeaf));
  for (std::size_t i = 0; i < scene.kinds.size(); ++i) {
    ImportRules of_kind = rules;
    if (imported.kinds.size() > 1 || imported.stand != Stand{}) of_kind.mesh = imported.kinds[i].name;
    takeImported(scene.kinds[i], file, of_kind, std::move(imported.kinds[i].tree), false);
  }
  scene.stand = std::move(imported.stand);
}

// `side` x `side` trees, `spacing` apart, around the origin. Kinds take turns along x and along y.
std::vector<Placement> square(int side, glm::vec2 spacing, std::size_t kinds) {
  std::vector<Placement> trees;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const glm::vec2 at = spacing * (glm::vec2(static_cast<float>(column), static_cast<float>(row)) -
                                      0.5f * static_cast<float>(side - 1));
      trees.push_back(
          {.position = {at, 0.f}, .kind = static_cast<std::uint32_t>(static_cast<std::size_t>(row + column) % kinds)});
    }
  return trees;
}

// `kind` has the scene's optics.
void readTree(const Scene& scene, TreeKind& kind, detail::SceneTable tree, const std::filesystem::path& folder,
              bool keep_optics) {
  if (tree.has("file") && tree.has("species"))
    throw InvalidInput(scene.origin + ": [tree] has both file and species: must be one of them");
  if (tree.has("file") && tree.has("seed"))
    throw InvalidInput(scene.origin + ": [tree] has both file and seed: a seed must be with a species");
  if (tree.has("file")) {
    ImportRules rules;
    if (tree.has("leaf")) rules.leaf = tree.texts("leaf");
    if (tree.has("wood")) rules.wood = tree.texts("wood");
    if (tree.has("scale") && tree.has("unit"))
      throw InvalidInput(scene.origin + ": [tree] has both scale and unit: must be one of them");
    rules.scale = static_cast<float>(tree.number("scale", 1., 1e-9, 1e9, "in [1e-9, 1e9]"));
    if (tree.has("unit")) rules.scale = metresPer(tree.text("unit", ""), scene.origin + ": tree.unit");
    if (tree.has("up")) rules.up = upwardAxis(tree.text("up", ""), scene.origin + ": tree.up");
    if (tree.has("cards")) rules.cards = cardsNamed(tree.text("cards", ""), scene.origin + ": tree.cards");
    rules.mesh = tree.text("mesh", "");
    importFile(kind, folder / tree.text("file", ""), rules, keep_optics);
  } else {
    for (const char* key : {"leaf", "wood", "cards", "scale", "unit", "up", "mesh"})
      if (tree.has(key))
        throw InvalidInput(
            fmt::format("{}: [tree] has {} and no file: must be with a file it is read from", scene.origin, key));
    const std::string name = tree.text("species", "cherry");
    const bool by_file = std::filesystem::path(name).extension() == ".toml";
    growTree(kind, by_file ? (folder / name).string() : name,
             static_cast<std::uint64_t>(tree.count("seed", 1, std::numeric_limits<int>::max())));
  }
  kind.name = tree.text("name", kind.name);
  detail::readOptics(kind, tree, "leaf_", tree, "wood_", scene.bands);
  tree.done();
  setLeaves(kind, scene.bands, kind.leaf);
}

// What is wrong in a table is told with the line at which it begins, where no line is told: of several [[tree]] it says
// which.
void atLineOf(const toml::node* table, const std::filesystem::path& file, const std::function<void()>& read) {
  try {
    read();
  } catch (const InvalidInput& e) {
    std::string wrong = e.what();
    const std::string name = file.string() + ":";
    const bool told = wrong.starts_with(name);
    if (!table || (told && wrong.size() > name.size() && wrong[name.size()] != ' ')) throw;
    if (told) wrong.erase(0, name.size() + 1);
    throw InvalidInput(fmt::format("{}{}: {}", name, table->source().begin.line, wrong));
  }
}

// Bands that no leaf is told by would be ignored.
//   leaf  what [leaf] tells
void requireBandsMatter(const Scene& scene, const TreeKind& leaf, const toml::table& table,
                        const std::filesystem::path& file) {
  const auto byContents = [](const auto& of) { return std::holds_alternative<LeafByContents>(of.description); };
  if (!scene.bands || byContents(leaf) || std::ranges::any_of(scene.kinds, byContents) ||
      std::ranges::any_of(scene.media, byContents))
    return;
  throw InvalidInput(fmt::format(
      "{}:{}: leaf.bands_nm: must be with leaves told by species or prospect, in [leaf], [tree] or [medium]",
      file.string(), table.at_path("leaf.bands_nm").node()->source().begin.line));
}

void readTrees(Scene& scene, const toml::node* node, const TreeKind& optics, const std::filesystem::path& file,
               bool keep_optics) {
  const toml::array* several = node ? node->as_array() : nullptr;  // [[tree]]
  const std::size_t count = several ? several->size() : 1;
  if (count == 0) throw InvalidInput(scene.origin + ": tree = []: must be a table [tree], or a [[tree]] for each kind");
  scene.kinds.assign(count, optics);
  for (std::size_t i = 0; i < count; ++i) {
    const toml::node* table = several ? several->get(i) : node;
    atLineOf(table, file, [&] {
      readTree(scene, scene.kinds[i], detail::SceneTable(table, file.string(), "tree"), file.parent_path(),
               keep_optics);
    });
    for (std::size_t before = 0; before < i; ++before)
      if (scene.kinds[before].name == scene.kinds[i].name)
        throw InvalidInput(fmt::format("{}:{}: tree.name = \"{}\": must differ from that of the other kinds of trees",
                                       file.string(), table->source().begin.line, scene.kinds[i].name));
  }
}

void readStand(Scene& scene, detail::SceneTable stand) {
  const std::string kind = stand.text("kind", "single");
  if (scene.kinds[0].mesh->leaf_count == 0 && kind != "single" && kind != "periodic")
    throw InvalidInput(scene.origin + ": stand.kind = \"" + kind +
                       "\": must be single or periodic in a scene without trees");
  const glm::vec2 touching = touchingPeriod(scene);
  const auto sides = [&](const std::string& key) {
    if (!stand.has(key)) return touching;
    const auto v = stand.numbers(key, 2, 1e-6, 1e6, "two lengths in [1e-6, 1e6] m: [x, y]");
    return glm::vec2(static_cast<float>(v[0]), static_cast<float>(v[1]));
  };
  if (kind == "periodic") {
    if (stand.has("positions")) scene.stand.trees = stand.placements("positions", scene.kinds);
    scene.stand.period = sides("period");
  } else if (kind == "grid") {
    scene.stand.trees = square(stand.count("side", 4, 100), sides("spacing"), scene.kinds.size());
  } else if (kind == "positions") {
    if (!stand.has("positions"))
      throw InvalidInput(scene.origin + ": [stand] of kind \"positions\" has no key positions");
    scene.stand.trees = stand.placements("positions", scene.kinds);
  } else if (kind == "none") {
    scene.stand.trees.clear();
  } else if (kind != "single") {
    throw InvalidInput(scene.origin + ": stand.kind = \"" + kind +
                       "\": must be single, periodic, grid, positions or none");
  }
  stand.done();
  intoOnePeriod(scene.stand);
  if (kind == "none") return;
  std::vector<char> stands(scene.kinds.size());
  for (const Placement& tree : scene.stand.trees) stands[tree.kind] = true;
  for (std::size_t i = 0; i < stands.size(); ++i)
    if (!stands[i])
      throw InvalidInput(fmt::format(
          "{}: [stand] has no place for a tree of kind \"{}\": must have a tree of each of the {} kinds, in positions "
          "or in a grid",
          scene.origin, scene.kinds[i].name, scene.kinds.size()));
}

Camera readCamera(const Scene& scene, detail::SceneTable& camera) {
  Camera read = kOverview;
  if (camera.has("elevation_deg")) read.elevation = camera.degrees("elevation_deg", -90., 90., "in [-90, 90]");
  if (camera.has("azimuth_deg")) read.azimuth = camera.degrees("azimuth_deg", -360., 360., "in [-360, 360]");
  read.field_of_view = camera.degreesOrZero("field_of_view_deg", 0.1, 150.);
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
  return read;
}

void readSavedCameras(Scene& scene, const toml::node& node, const std::filesystem::path& file) {
  const auto refuse = [&](const toml::node& at, const std::string& what) {
    throw InvalidInput(fmt::format("{}:{}: {}", file.string(), at.source().begin.line, what));
  };
  const toml::array* all = node.as_array();
  if (!all) refuse(node, "saved_camera: must be a [[saved_camera]] for each");
  for (const toml::node& one : *all) {
    detail::SceneTable table(&one, file.string(), "saved_camera");
    const std::string name = table.text("name", "");
    if (name.empty() || name.size() > kLongestCameraName)
      refuse(one, fmt::format("saved_camera.name = \"{}\": must be 1 to {} characters", name.substr(0, 80),
                              kLongestCameraName));
    if (std::ranges::find(scene.saved_cameras, name, &SavedCamera::name) != scene.saved_cameras.end())
      refuse(one, fmt::format("saved_camera.name = \"{}\": must differ from that of the other ones", name));
    scene.saved_cameras.push_back({name, readCamera(scene, table)});
  }
}

// The bands of an image: red, green and blue, or its one channel for all.
std::array<std::shared_ptr<const GroundTexture>, kBands> readTexture(const std::filesystem::path& file, float size) {
  const Image image = readImage(file, ImageValues::linear);
  std::array<std::shared_ptr<const GroundTexture>, kBands> bands;
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto named = std::find(image.channels.begin(), image.channels.end(), std::string(1, "RGB"[band]));
    const auto channel = static_cast<std::size_t>(named - image.channels.begin()) % image.channels.size();
    GroundTexture texture{.width = image.width, .height = image.height, .size = size, .albedo = {}};
    for (std::size_t i = channel; i < image.values.size(); i += image.channels.size())
      texture.albedo.push_back(image.values[i]);
    validate(texture);
    bands[band] = std::make_shared<const GroundTexture>(std::move(texture));
  }
  return bands;
}

void readGround(Scene& scene, detail::SceneTable ground, const std::filesystem::path& folder) {
  const std::string kind = ground.text("kind", "lambert");
  const auto need = [&](const char* key) {
    if (!ground.has(key))
      throw InvalidInput(fmt::format("{}: [ground] of kind \"{}\" has no key {}", scene.origin, kind, key));
  };
  if (kind == "lambert") {
    scene.ground_albedo = ground.perBand("albedo", glm::vec3(0.f));
  } else if (kind == "rpv") {
    need("rpv");
    const auto bands = ground.rowPerBand(
        "rpv", {0., 0.2, -0.9, 0.}, {1., 2., 0.9, 2.},
        "[rho0, k, theta, rho_c] in [0, 1], [0.2, 2], [-0.9, 0.9] and [0, 2], or three such for red, green and blue");
    scene.ground_rpv.emplace();
    for (std::size_t band = 0; band < kBands; ++band) {
      const auto value = [&](std::size_t i) { return static_cast<float>(bands[band][i]); };
      (*scene.ground_rpv)[band] = {.rho0 = value(0), .k = value(1), .theta = value(2), .rho_c = value(3)};
      validate((*scene.ground_rpv)[band]);
    }
  } else if (kind == "texture") {
    need("texture");
    const auto size = static_cast<float>(ground.number("texture_size", 1., 1e-3, 1e6, "in [1e-3, 1e6] m"));
    scene.ground_texture_file = (folder / ground.text("texture", "")).string();
    scene.ground_texture = readTexture(scene.ground_texture_file, size);
  } else {
    throw InvalidInput(scene.origin + ": ground.kind = \"" + kind + "\": must be lambert, rpv or texture");
  }
  ground.done();
}

constexpr std::array<std::string_view, 11> kSections{"name",   "tree", "medium", "stand",  "leaf",        "wood",
                                                     "ground", "sun",  "sky",    "camera", "saved_camera"};

Scene readTable(const toml::table& table, const std::filesystem::path& file) {
  for (const auto& [key, node] : table) {
    if (std::ranges::find(kSections, key.str()) == kSections.end())
      throw InvalidInput(fmt::format("{}:{}: unknown key \"{}\"; see: sunfleck --help scene", file.string(),
                                     node.source().begin.line, key.str()));
  }
  const auto section = [&](const char* name) { return detail::SceneTable(table.get(name), file.string(), name); };
  Scene scene;
  scene.origin = file.string();
  detail::SceneTable leaf = section("leaf"), wood = section("wood");
  TreeKind optics = kindWith(kPaperLeaf);
  scene.bands = detail::readLightBands(leaf);
  const bool own_leaf = detail::tellsLeafShares(leaf, "");
  atLineOf(table.get("leaf"), file, [&] { detail::readOptics(optics, leaf, "", wood, "", scene.bands); });
  for (const detail::SceneTable* read : {&leaf, &wood}) read->done();
  readGround(scene, section("ground"), file.parent_path());
  if (const toml::node* media = table.get("medium")) detail::readMedia(scene, *media, optics, file);
  if (scene.media.empty() || table.contains("tree")) {
    readTrees(scene, table.get("tree"), optics, file, own_leaf);
  } else {
    scene.kinds[0] = optics;
    scene.kinds[0].name = scene.kinds[0].source = "no tree";
    scene.kinds[0].mesh = std::make_shared<const TreeMesh>();
    setLeaves(scene.kinds[0], scene.bands, optics.leaf);
  }
  requireBandsMatter(scene, optics, table, file);
  readStand(scene, section("stand"));
  detail::readSuns(scene, table.get("sun"), file);
  detail::readSky(scene, section("sky"), file.parent_path());
  sunAndSky(scene);  // refuses a sky that cannot be
  if (table.contains("camera")) {
    detail::SceneTable camera = section("camera");
    scene.camera = readCamera(scene, camera);
  }
  if (const toml::node* cameras = table.get("saved_camera")) readSavedCameras(scene, *cameras, file);
  if (const toml::node* name = table.get("name"); name && !name->is_string())
    throw InvalidInput(fmt::format("{}:{}: name: must be a text in quotes", file.string(), name->source().begin.line));
  scene.name = table["name"].value_or(file.stem().string());
  return scene;
}

std::optional<Scene> builtin(const std::string& name) {
  Scene scene;
  scene.name = scene.origin = name;
  TreeKind& kind = scene.kinds[0] = kindWith(kPaperLeaf);
  if (name == "slab") {
    const RandomLayer layer{};
    kind.mesh = std::make_shared<const TreeMesh>(randomLayer(layer, 1));
    kind.name = name;
    kind.source = fmt::format("random square leaves, LAI {}, seed 1", layer.leaf_area_index);
    scene.stand.period = layer.size;
    return scene;
  }
  const std::string plant = name == "periodic" ? "cherry" : name.substr(0, name.find_first_of("0123456789"));
  const std::string copies = name == "periodic" ? "" : name.substr(plant.size());
  const std::vector<std::string> known = speciesNames();
  if (std::find(known.begin(), known.end(), plant) == known.end()) return std::nullopt;
  if (copies != "" && copies != "1" && copies != "16" && copies != "64") return std::nullopt;
  growTree(kind, plant, 1);
  if (copies == "16" || copies == "64") scene.stand.trees = square(copies == "16" ? 4 : 8, touchingPeriod(scene), 1);
  if (name == "periodic") scene.stand.period = touchingPeriod(scene);
  return scene;
}

}  // namespace

TreeKind grownKind(const std::string& species_name, std::uint64_t seed) {
  TreeKind kind;
  growTree(kind, species_name, seed);
  return kind;
}

glm::vec2 touchingPeriod(const Scene& scene) {
  glm::vec2 period(0.f);
  for (const TreeKind& kind : scene.kinds) {
    if (kind.mesh->leaf_count == 0) continue;
    const glm::vec3 size = leafBounds(*kind.mesh).size();
    period = glm::max(period, glm::max(glm::vec2(size), glm::vec2(0.15f * std::max({size.x, size.y, size.z}))));
  }
  if (period != glm::vec2(0.f)) return period;
  for (const SceneMedium& medium : scene.media)
    period = glm::max(period, glm::vec2(bounds(medium, {}, glm::vec2(0.f)).size()));
  return period;
}

std::vector<std::string> builtinScenes() {
  std::vector<std::string> names{"periodic", "slab"};
  for (const std::string& plant : speciesNames())
    for (const char* copies : {"", "1", "16", "64"}) names.push_back(plant + copies);
  return names;
}

bool isSceneFile(const std::filesystem::path& file) {
  bool is_scene = false;
  try {
    detail::readToml(file, [&](const toml::table& table) {
      const toml::node_view tree = table["tree"];
      is_scene = tree.is_array() || tree["species"] || tree["file"] ||
                 std::ranges::any_of(kSections, [&](std::string_view name) {
                   return name != "tree" && name != "name" && table.contains(name);
                 });
    });
  } catch (const InvalidInput&) {
    return false;
  }
  return is_scene;
}

Scene readScene(const std::string& name_or_file, const ImportRules& rules) {
  const std::filesystem::path file(name_or_file);
  if (file.extension() == ".toml") {
    Scene scene;
    detail::readToml(file, [&](const toml::table& table) { scene = readTable(table, file); });
    return scene;
  }
  if (file.has_extension()) {
    Scene scene;
    scene.name = file.stem().string();
    scene.origin = file.string();
    importScene(scene, file, rules);
    return scene;
  }
  if (std::optional<Scene> scene = builtin(name_or_file)) return *scene;
  throw InvalidInput(
      fmt::format("scene \"{}\": must be a .toml, .obj, .ply, .gltf, .glb, .txt or .leaves file or one of: {}",
                  name_or_file, fmt::join(builtinScenes(), ", ")));
}

std::string sceneFileHelp() {
  return R"(A scene is a TOML file. Every key may be left out; the value shown is the default.
Lengths are metres, z is up. Optics and irradiances are one number, or three for red, green and blue.

name = "file name"            # what reports call it

[tree]                        # the prototype: grown, or read from a file
species = "cherry"            # see: sunfleck plant --list; or a parameter file (.toml) beside the scene file
seed = 1
# file = "tree.obj"           # .obj, .ply, .gltf, .glb, or leaves in lines radius x y z nx ny nz (.txt, .leaves), beside
                              # the scene file, instead of species
# leaf = "leaf*"              # materials or groups of the file that are leaves, or a list of such ...
# wood = "bark*"              # ... and those that are wood; told by their names if not given. A material's name comes
                              # before those of groups (glTF: the mesh), these before the object's (the node)
# cards = "cut"               # what an image's opacity cuts out of leaves' faces: "cut" to triangles, as a "mask" that
                              # trace alone takes, or "whole" faces
# scale = 1.0                 # metres per unit of the file, above 0; or instead
# unit = "m"                  # the file's unit: "m", "dm", "cm", "mm", "km", "in" or "ft"
# up = "z"                    # the file's upward axis: "x", "y" or "z"; if not given that of its format, y of glTF alone
# mesh = "oak"                # of a glTF file of instances: the kind of tree to take; if not given all of it as one
# name = "cherry"             # what positions call it; the species' or the file's name if not given
# leaf_reflectance = 0.475    # its own optics, if not those of [leaf] and [wood]
# leaf_transmittance = 0.475
# leaf_species = "beech"      # or by what they are: see [leaf]
# leaf_prospect = { chlorophyll = 40.0 }
# leaf_slab = { absorption = [1.5, 0.4, 5.0], scattering = 10.0, thickness = 0.2 }
# leaf_maps = { upper = "oak_upper.png" }  # and by images: see [leaf]; {} for none
# leaf_lower = { reflectance = 0.5 }
# leaf_gloss = 0.0
# leaf_gloss_roughness = 0.3
# wood_reflectance = 0.3
# Several kinds of trees: a [[tree]] with these keys for each, instead of [tree]; names must differ, and of each kind
# stands one tree at least. Trees of a grid take the kinds in turn along x and along y.

# [medium]                    # what fills space, alone or among trees; trace alone takes it. It stands once, and in a
                              # periodic stand once in each period. Without a [tree], no tree stands
# kind = "leaves"             # leaves too small to tell apart, or "particles" of Henyey and Greenstein
# density = 1.0               # leaves: one-sided leaf area per volume in 1/m, 0 to 1e6, the same everywhere ...
# extinction = 1.0            # ... particles: extinction in 1/m, 0 to 1e6 ...
# bottom = 0.0                # ... between two heights, in a periodic stand ...
# top = 1.0
# box = [-1, -1, 0, 1, 1, 2]  # ... or in a box: its corners
# file = "leaves.vdb"         # instead: cells, as sunfleck voxelize writes them, with their orientation; wood is left out
# scale = 1.0                 # by which their densities count, above 0
# angles = "spherical"        # of leaves: spherical, planophile, erectophile, plagiophile, extremophile or uniform; the
                              # file's where it tells them
# reflectance = 0.475         # of leaves; those of the file in the mean, or of [leaf], if not given
# transmittance = 0.475
# species = "beech"           # or by species, prospect or slab: see [leaf]
# albedo = 1.0                # of particles, 0 to 1
# asymmetry = 0.0             # of particles: mean cosine of scattering, -0.999 to 0.999
# Several media, a [[medium]] for each, may fill the same space.

[stand]
kind = "single"               # single | periodic | grid | positions | none: no tree stands, for view and render alone
# period = [8.0, 8.0]         # periodic: sides of the repeated rectangle; the leaves' box if not given
# side = 4                    # grid: side x side trees, 1 to 100 ...
# spacing = [8.0, 8.0]        # ... this far apart; the leaves' box if not given
# positions = [[0, 0], [5, 1, 30]]   # positions, periodic: x, y and rotation_deg of each tree, and at the end the
                              # name of its kind, as in [5, 1, 30, "cherry"]; without one, trees take the kinds in turn
# trace takes all stands; validate takes at most 1024 trees, render 16384, both at most 64 in the space of one, and at most
# 64 kinds of trees, each rotation_deg counted as one, since each has maps of its own

[leaf]                        # Lambertian on both sides; reflectance + transmittance at most 1
reflectance = 0.475           # 0 to 1
transmittance = 0.475         # 0 to 1
# species = "beech"           # instead of these two, a measured species: see sunfleck leaf --list
# prospect = { chlorophyll = 40.0, water = 0.01 }   # or a leaf by its contents: see sunfleck leaf --help; with a species,
                              # what is different about it
# bands_nm = [[620, 680], [520, 570], 450]   # what the three bands are, of species and contents alone: from and to, or one
                              # wavelength, 400 to 2500; red, green and blue as the eye has them if not given
# slab = { absorption = [1.5, 0.4, 5.0], scattering = 10.0, thickness = 0.2 }   # or even tissue: 1/mm, 1/mm and mm
# maps = { upper = "oak_upper.png", lower = "oak_lower.png", upper_gloss = "oak_gloss.png", albedo = 1.5, relief = 0.1 }
                              # images of linear values of one size, at most 4096 a side, beside the scene file. upper,
                              # lower: colour times albedo multiplies the reflectance, alpha is thickness of slab above
                              # (2 alpha - 1) relief in mm; upper_gloss, lower_gloss: gloss, and in alpha its roughness.
                              # A lower side without is as the upper. albedo = 1.0 and relief = 0.1 if not given
# lower = { reflectance = 0.5, gloss = 0.0, gloss_roughness = 0.3 }   # or what is different on the lower side, by numbers
gloss = 0.0                   # intensity of a glossy reflection on both sides, 0 to 1; the two above are then shares of
                              # the light it lets in. trace and render take it, validate does not
gloss_roughness = 0.3         # root mean square slope of its facets, 0.05 to 1; one number

[wood]
reflectance = 0.3             # 0 to 1

[ground]                      # trace takes one that reflects for periodic stands and pictures
kind = "lambert"              # lambert | rpv | texture; the latter two for trace alone
albedo = 0.0                  # lambert: 0 to 1; 0: no ground
# rpv = [0.1, 0.8, -0.1, 0.1] # rpv: rho0, k, theta and rho_c of Rahman, Pinty and Verstraete, or three such lists for
                              # red, green and blue; refused if it would reflect more light than arrives
# texture = "ground.png"      # texture: an image of the albedo; whole numbers in it are sRGB, others linear; x to the
                              # right, y up, from x = y = 0; in a periodic stand the period's ground repeats
# texture_size = 1.0          # texture: metres that its width covers

[sun]
zenith_deg = 0.0              # 0 overhead, to 180; from 89.9 on it has set and gives no light
azimuth_deg = 0.0             # where the sun stands, from +x towards +y
# date = "2003-10-17"         # instead of these, a moment and a place; x is then east, y north, and air does not bend
# time = "12:30:30-07:00"     # light. In UTC, or with the offset of its zone
# latitude_deg = 39.74        # north, -90 to 90
# longitude_deg = -105.18     # east, -180 to 180
irradiance = 1.0              # of a plane that faces the sun, 0 to 10; 0: no sun. All results are relative to 1
diameter_deg = 0.0            # of its disc, 0.25 to 60; the real one has 0.533; 0: a point, as which render draws it
# Several suns, at most 4: a [[sun]] with these keys for each, instead of [sun]. The first is the one that lights a
# preetham sky. render takes several, trace and validate one alone.

[sky]                         # trace and render know a sky and suns of any irradiance; validate neither
kind = "none"                 # none | uniform | overcast | preetham | image
# irradiance = 0.2            # of a horizontal plane, 0 to 1000, by the sun's unit; one number keeps a sky's own colours,
                              # as the mean of its bands. Preetham's sky has its own if not given
# turbidity = 3.0             # preetham: haze of the air, 1.7 to 10; made for 2 to 6 and suns above 15 degrees
# coloured_sun = false        # preetham: multiply the sun's irradiance by its colour behind that air
# file = "sky.exr"            # image: .exr or .hdr beside the scene file, a panorama in latitude and longitude with the
                              # zenith on top. Its lower half is not used; a sun in it adds to [sun]
# rotation_deg = 0.0          # image: azimuth of its middle column; to the right of it the azimuth falls

[camera]                      # shows the whole stand if left out
# target = [0.0, 0.0, 4.0]    # point in the middle of the picture
# elevation_deg = 10.0        # -90 to 90
# azimuth_deg = 20.0          # where the camera stands, from +x towards +y
# half_width = 5.0            # half of the picture's width, in perspective at the target: with the field of view it
                              # says how far away the eye is
# field_of_view_deg = 0.0     # of the picture's width, 0.1 to 150; 0: orthographic
# width = 512                 # pixels, 1 to 8192
# height = 512
# Others to look from, as view saves them and --saved-camera takes them: a [[saved_camera]] for each, with these keys and
# name = "from the road"      # 1 to 64 characters, other than those of the others
)";
}

}  // namespace sunfleck
