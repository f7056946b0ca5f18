#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/gallery.hpp"
#include "apps/import_options.hpp"
#include "apps/plant_report.hpp"
#include "apps/plant_stand.hpp"
#include "apps/thumbnail.hpp"
#include "apps/version.hpp"
#include "core/distinct_files.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "grid/density_grid.hpp"
#include "plants/import.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/write_gltf.hpp"
#include "plants/write_obj.hpp"
#include "plants/write_ply.hpp"
#include "render/image_file.hpp"
#include "render/scene_file.hpp"

namespace sunfleck::apps {
namespace {

namespace fs = std::filesystem;

// Simple things in place of a tree, of which the answer is known.
constexpr const char *kRandomCrown = "random_crown", *kTurbidEllipsoid = "turbid_ellipsoid";

struct PlantOptions {
  std::string input, species = "cherry", output, thumbnail;
  ImportOptions import;
  std::string gallery;
  std::vector<std::string> gallery_files;
  bool list = false;
  std::vector<std::string> write_species;  // a name and a file
  PlantStand stand;
  std::vector<float> size{2.f, 2.f, 3.f};  // of test objects, full axes [m]
  int leaves = 9000;
  float leaf_side = 0.05f;                // [m]
  float density = 1.f, cell_size = 0.1f;  // of a turbid ellipsoid [1/m], [m]
};

// A tree, or the kinds of trees of a file that is a stand.
struct Plant {
  std::vector<TreeKind> kinds{TreeKind{}};
  std::vector<CardAreas> cards{CardAreas{}};  // of each
  std::vector<std::string> hows{""};          // of each, how leaf and wood were told apart
  Stand stand;
  std::string source;

  bool isStand() const { return kinds.size() > 1 || stand != Stand{}; }
};

// Whether the input is to be grown: a species by its name, or by its parameter file.
bool isGrown(const std::string& input) {
  const std::vector<std::string> names = speciesNames();
  return input.empty() || fs::path(input).extension() == ".toml" ||
         std::find(names.begin(), names.end(), input) != names.end();
}

// Whether the input is a file to be read.
bool isFile(const std::string& input) {
  return !isGrown(input) && input != kRandomCrown && input != kTurbidEllipsoid;
}

int writeSpecies(const std::string& name, const std::string& file) {
  const std::string_view text = speciesText(name);
  requireNamed(file, ".toml");
  writeWhole(file, text);
  fmt::print("wrote {}\n", file);
  return 0;
}

// Test objects stand on the ground.
TreeMesh randomCrownOf(const PlantOptions& options, std::uint64_t seed) {
  const glm::vec3 size(options.size[0], options.size[1], options.size[2]);
  TreeMesh mesh = randomCrown({.size = size, .leaf_side = options.leaf_side, .leaves = options.leaves}, seed);
  for (glm::vec3& v : mesh.vertices) v.z += 0.5f * size.z;
  return mesh;
}

int writeTurbidEllipsoid(const PlantOptions& options, const RunOptions& run) {
  requireNamed(options.output, ".vdb");
  const glm::vec3 size(options.size[0], options.size[1], options.size[2]);
  const DensityGrid grid =
      DensityGrid::turbidEllipsoid(size, {0.f, 0.f, 0.5f * size.z}, options.density, options.cell_size);
  grid.write(options.output, {.name = kTurbidEllipsoid, .hash = {}, .program = versionText()});
  if (run.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"leaf_area_m2", grid.leafArea()}, {"units", "m"}}.dump(2));
  else
    fmt::print("wrote {}: {:.4g} m2 of turbid leaves, for [medium] file\n", options.output, grid.leafArea());
  return 0;
}

// Into an .obj or a .ply goes a stand as one mesh.
void takeFile(Plant& plant, const PlantOptions& options) {
  const ImportRules rules = options.import.rules();
  const fs::path file = options.input;
  const std::string ending = fs::path(options.output).extension().string();
  ImportedStand imported;
  if (ending == ".obj" || ending == ".ply")
    imported.kinds.push_back({file.stem().string(), importTree(file, rules, readOpacity)});
  else
    imported = importStand(file, rules, readOpacity);
  plant.stand = imported.stand;
  plant.source = options.input;
  plant.kinds.assign(imported.kinds.size(), plant.kinds.front());
  plant.cards.assign(imported.kinds.size(), {});
  plant.hows.clear();
  for (std::size_t i = 0; i < plant.kinds.size(); ++i) {
    TreeKind& kind = plant.kinds[i];
    ImportedTree& tree = imported.kinds[i].tree;
    kind.name = imported.kinds[i].name;
    kind.recipe = {.species = {}, .file = options.input, .rules = rules};
    if (plant.isStand()) kind.recipe.rules.mesh = kind.name;
    kind.dropped = tree.dropped;
    for (int band = 0; tree.colours && band < kBands; ++band) {
      kind.leaf[static_cast<std::size_t>(band)].reflectance = tree.colours->reflectance[band];
      kind.leaf[static_cast<std::size_t>(band)].transmittance = tree.colours->transmittance[band];
    }
    plant.cards[i] = {.before = tree.card_area, .after = tree.cut_area};
    plant.hows.push_back(tree.how);
    kind.mesh = std::make_shared<const TreeMesh>(std::move(tree.mesh));
  }
}

// Throws InvalidInput, of a scene file by saying that it is one.
TreeKind grownFrom(const std::string& species_or_file, std::uint64_t seed) {
  try {
    return grownKind(species_or_file, seed);
  } catch (const InvalidInput&) {
    if (isSceneFile(species_or_file))
      throw InvalidInput(species_or_file +
                         ": is a scene file: must be a species' parameters, as --write-species writes them");
    throw;
  }
}

Plant plantOf(const PlantOptions& options, const RunOptions& run) {
  Plant plant;
  constexpr LeafOptics kLeaf{.reflectance = 0.475f, .transmittance = 0.475f};  // that of scene files without others
  plant.kinds.front().leaf.fill(kLeaf);
  if (options.input == kRandomCrown) {
    plant.kinds.front().name = kRandomCrown;
    plant.kinds.front().mesh = std::make_shared<const TreeMesh>(randomCrownOf(options, run.seed));
    plant.source = fmt::format("{}, seed {}", kRandomCrown, run.seed);
  } else if (isGrown(options.input)) {
    const std::string& name = options.input.empty() ? options.species : options.input;
    const BandOptics leaf = plant.kinds.front().leaf;
    plant.kinds.front() = grownFrom(name, run.seed);
    plant.kinds.front().leaf = leaf;
    plant.source = fmt::format("{}, seed {}", name, run.seed);
  } else {
    takeFile(plant, options);
  }
  return plant;
}

void writeTree(const std::string& file, const TreeMesh& mesh) {
  const std::string extension = fs::path(file).extension().string();
  if (extension == ".obj")
    writeObj(file, mesh);
  else if (extension == ".ply")
    writePly(file, mesh);
  else
    writeGltf(file, mesh);
}

void requireOutput(const PlantOptions& options) {
  if (options.output.empty()) return;
  std::vector<std::string> endings{".glb", ".gltf"};
  if (options.stand.kind.empty()) endings.insert(endings.end(), {".obj", ".ply"});
  if (!options.stand.kind.empty() || isFile(options.input)) endings.emplace_back(".toml");
  const bool known = std::ranges::find(endings, fs::path(options.output).extension().string()) != endings.end();
  require(known, "output file", options.output,
          fmt::format("named with one of the extensions {}", fmt::join(endings, " ")));
  requireWritable(options.output);
  if (isFile(options.input)) requireOther(options.output, options.input);
}

// Meshes hold no masks: a scene file does, by naming the mesh file and how its cards are taken.
void requireWithoutMasks(const Plant& plant, const PlantOptions& options) {
  if (options.output.empty() || fs::path(options.output).extension() == ".toml") return;
  for (const TreeKind& kind : plant.kinds)
    if (!kind.mesh->masks.empty())
      throw InvalidInput(options.output + ": must be a .toml file, as the leaves have masks, or --cards cut or whole");
}

// Of a file: a stand, or the tree alone.
Scene sceneOf(const Plant& plant) {
  Scene scene;
  scene.name = fs::path(plant.source).stem().string();
  scene.origin = plant.source;
  scene.kinds = plant.kinds;
  scene.stand = plant.stand;
  return scene;
}

// Options that say nothing of what is done would be ignored.
void requireFitting(const CLI::App& command, const PlantOptions& options) {
  using Names = std::vector<std::string>;
  static const Names import{"--leaf", "--wood", "--scale", "--unit", "--up", "--cards", "--mesh"};
  static const Names common{"--json", "--quiet", "--threads", "--seed"};
  const auto joined = [](Names names, const Names& more) {
    names.insert(names.end(), more.begin(), more.end());
    return names;
  };
  const auto allow = [&](const Names& allowed, const std::string& beside) {
    for (const CLI::Option* option : command.get_options())
      if (option->count() > 0 && std::ranges::find(allowed, option->get_name()) == allowed.end())
        throw InvalidInput(fmt::format("{}: must be without {}", option->get_name(), beside));
  };
  if (options.list) return allow(joined(common, {"--list"}), "--list");
  if (!options.write_species.empty()) return allow(joined(common, {"--write-species"}), "--write-species");
  if (!options.gallery.empty())
    return allow(joined(joined(common, import), {"--gallery", "input", "files"}), "--gallery");
  if (options.input == kTurbidEllipsoid)
    return allow(joined(common, {"input", "--output", "--size", "--density", "--cell-size"}), kTurbidEllipsoid);
  for (const char* option : {"--density", "--cell-size"})
    if (command.count(option) > 0) throw InvalidInput(fmt::format("{}: must be for {}", option, kTurbidEllipsoid));
  for (const char* option : {"--size", "--leaves", "--leaf-side"})
    if (command.count(option) > 0 && options.input != kRandomCrown)
      throw InvalidInput(fmt::format("{}: must be for {}", option, kRandomCrown));
  for (const std::string& option : import)
    if (command.count(option) > 0 && !isFile(options.input))
      throw InvalidInput(fmt::format("{}: must be for a mesh file, not for {}", option, options.input));
}

int runPlant(const PlantOptions& options, const RunOptions& run) {
  if (options.list) {
    for (const std::string& name : speciesNames()) fmt::print("{}\n", name);
    return 0;
  }
  if (!options.write_species.empty()) return writeSpecies(options.write_species[0], options.write_species[1]);
  if (!options.gallery.empty()) {
    std::vector<std::string> files = options.gallery_files;
    if (!options.input.empty()) files.insert(files.begin(), options.input);
    if (!writeGallery(options.gallery, files, options.import.rules(), run)) {
      fmt::print(stderr, "sunfleck: interrupted: nothing was written\n");
      return 1;
    }
    if (run.json)
      fmt::print("{}\n", nlohmann::ordered_json{{"gallery", options.gallery}}.dump(2));
    else
      fmt::print("wrote {}\n", options.gallery);
    return 0;
  }
  if (options.input == kTurbidEllipsoid) return writeTurbidEllipsoid(options, run);
  requireOutput(options);
  if (!options.thumbnail.empty()) requireNamed(options.thumbnail, ".png");
  requireOther(options.thumbnail, options.input);
  const Plant plant = plantOf(options, run);
  requireWithoutMasks(plant, options);
  const TreeMesh& mesh = *plant.kinds.front().mesh;
  std::optional<Scene> stand;
  if (plant.isStand() && !options.stand.kind.empty())
    throw InvalidInput(options.input + ": is a stand of instances: must be one of its trees for --stand (--mesh \"" +
                       plant.kinds.front().name + "\")");
  if (!options.stand.kind.empty()) stand = plantStand(options.stand, plant.kinds.front(), run.seed);
  if (plant.isStand() || (!stand && fs::path(options.output).extension() == ".toml")) stand = sceneOf(plant);
  if (!options.output.empty() && stand) writeStand(options.output, *stand);
  if (!options.output.empty() && !stand) writeTree(options.output, mesh);
  if (!options.thumbnail.empty()) writeThumbnail(options.thumbnail, mesh);

  std::vector<PlantReport> reports;
  for (std::size_t i = 0; i < plant.kinds.size(); ++i)
    reports.emplace_back(*plant.kinds[i].mesh,
                         plant.isStand() ? plant.source + ", " + plant.kinds[i].name : plant.source, plant.hows[i],
                         plant.kinds[i].dropped, plant.cards[i]);
  double stand_area = 0.;  // of all leaves [m^2]
  if (stand)
    for (const Placement& tree : stand->stand.trees) stand_area += leafArea(*stand->kindOf(tree).mesh);
  if (run.json) {
    nlohmann::ordered_json result = reports.front().json();
    if (stand) result["stand"] = {{"trees", stand->stand.trees.size()}, {"leaf_area_m2", stand_area}};
    for (std::size_t i = 0; plant.isStand() && i < reports.size(); ++i) {
      nlohmann::ordered_json kind{{"name", plant.kinds[i].name}};
      kind.update(reports[i].json());
      result["stand"]["kinds"].push_back(kind);
    }
    fmt::print("{}\n", result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return 0;
  }
  for (const PlantReport& report : reports) fmt::print("{}", report.text());
  if (stand)
    fmt::print("  stand          {} trees of {} kinds, {:.4g} m2 of leaves\n", stand->stand.trees.size(),
               stand->kinds.size(), stand_area);
  for (const std::string& file : {options.output, options.thumbnail})
    if (!file.empty()) fmt::print("wrote {}\n", file);
  return 0;
}

void addStandOptions(CLI::App& command, PlantOptions& plant) {
  const std::string group = "Stand";
  CLI::Option* stand =
      command.add_option("--stand", plant.stand.kind,
                         "Plant many, into a scene file (.toml) or .glb: regular, jittered, poisson (no "
                         "crowns overlap) or a .csv file of x,y[,rotation_deg[,species]]");
  stand->group(group)->check(
      [](const std::string& text) { return text.empty() ? "must not be empty" : std::string(); });
  command.add_option("--area", plant.stand.area, "Sides of the rectangle [m] (default 5 times the spacing)")
      ->expected(2)
      ->check(numberIn(1e-3, 1e6, "in [1e-3, 1e6] m"))
      ->group(group)
      ->needs(stand);
  command
      .add_option("--spacing", plant.stand.spacing,
                  "Between trees, of poisson the least [m] (default the crown's width)")
      ->check(numberIn(1e-3, 1e6, "in [1e-3, 1e6] m"))
      ->group(group)
      ->needs(stand);
  command.add_option("--jitter", plant.stand.jitter, "Of jittered: moves over half of the spacing (default 0.5)")
      ->check(numberIn(0., 1., "in [0, 1]"))
      ->group(group)
      ->needs(stand);
}

void addTestObjectOptions(CLI::App& command, PlantOptions& plant) {
  const std::string group = "Test objects random_crown and turbid_ellipsoid";
  command.add_option("--size", plant.size, "Full axes of the ellipsoid [m] (default 2 2 3)")
      ->expected(3)
      ->check(numberIn(1e-3, 1e3, "in [1e-3, 1000] m"))
      ->group(group);
  command.add_option("--leaves", plant.leaves, "Leaves of a random crown (default 9000)")
      ->transform(wholeNumberIn(1, 2e7, "a whole number, 1 to 2e7"))
      ->group(group);
  command.add_option("--leaf-side", plant.leaf_side, "Side of its square leaves [m] (default 0.05)")
      ->check(numberIn(1e-4, 10., "in [1e-4, 10] m"))
      ->group(group);
  command.add_option("--density", plant.density, "Leaf area density of a turbid ellipsoid [1/m] (default 1)")
      ->check(numberIn(1e-6, 1e6, "in [1e-6, 1e6] 1/m"))
      ->group(group);
  command.add_option("--cell-size", plant.cell_size, "Side of its cells [m] (default 0.1)")
      ->check(numberIn(2e-5, 1e3, "in [2e-5, 1000] m"))
      ->group(group);
}

}  // namespace

void addPlant(CLI::App& app, RunOptions& options, int& status) {
  auto plant = std::make_shared<PlantOptions>();
  CLI::App* command =
      addCommand(app, options, "plant", "Grow a tree or a stand of trees, or read one; tell its leaves and write it");
  CLI::Option* input = command->add_option(
      "input", plant->input,
      "A species to grow by its name or its parameter file (.toml), a mesh to "
      "read (.obj, .ply, .gltf, .glb, or leaves in lines "
      "radius x y z nx ny nz: .txt, .leaves), or a test object: random_crown, or turbid_ellipsoid into a .vdb");
  command->add_option("--species", plant->species,
                      "What to grow, as above (default cherry); --seed grows another one of it");
  command->add_flag("--list", plant->list, "Print the names of the species there are");
  command
      ->add_option("--write-species", plant->write_species, "NAME FILE.toml: write a species' parameters, to be edited")
      ->expected(2);
  command->add_option("-o,--output", plant->output,
                      "File to write: .obj, with its .mtl beside it, .ply, .glb, .gltf, or of a file a scene: .toml");
  command->add_option("--thumbnail", plant->thumbnail, "A small picture to write: .png");
  command->add_option(
      "--gallery", plant->gallery,
      "Draw all species, and the mesh files and scenes that follow, on one sheet with names: a .png file");
  command->add_option("files", plant->gallery_files, "More files for --gallery")->needs("--gallery");
  addImportOptions(*command, plant->import);
  command->get_option("--species")->excludes(input);
  for (const char* of_input : {"--leaf", "--wood", "--scale", "--unit", "--up", "--cards", "--mesh"})
    command->get_option(of_input)->needs(input);
  addStandOptions(*command, *plant);
  addTestObjectOptions(*command, *plant);
  command->callback([plant, command, &options, &status] {
    requireFitting(*command, *plant);
    status = runPlant(*plant, options);
  });
}

}  // namespace sunfleck::apps
