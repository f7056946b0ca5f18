#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/commands.hpp"
#include "core/whole_file.hpp"
#include "grid/deep_opacity_map.hpp"
#include "grid/leaf_depth.hpp"
#include "plants/import.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "plants/write_obj.hpp"

namespace sunfleck::apps {
namespace {

struct PlantOptions {
  std::string input, species = "cherry", output, up = "z";
  ImportRules rules;
  bool list = false;
  std::vector<std::string> write_species;  // a name and a file
};

// Whether the input is to be grown: a species by its name, or by its parameter file.
bool isGrown(const std::string& input) {
  const std::vector<std::string> names = speciesNames();
  return input.empty() || std::filesystem::path(input).extension() == ".toml" ||
         std::find(names.begin(), names.end(), input) != names.end();
}

int writeSpecies(const std::string& name, const std::string& file) {
  const std::string_view text = speciesText(name);
  requireNamed(file, ".toml");
  writeWhole(file, text);
  fmt::print("wrote {}\n", file);
  return 0;
}

struct Crown {
  double projected_area;              // of the crown on the ground [m^2]
  double mean_depth, mean_thickness;  // of the leaves, light from overhead [1]
};

Crown crownOf(const TreeMesh& mesh) {
  const DeepOpacityMap overhead(mesh, {0.f, 0.f, -1.f}, 512);
  std::size_t covered = 0;
  for (std::size_t pixel = 0; pixel + 1 < overhead.first().size(); ++pixel)
    covered += overhead.first()[pixel + 1] > overhead.first()[pixel];
  const LeafDepths depths = leafDepths(mesh, overhead).front();
  const auto mean = [](const std::vector<float>& v) {
    return std::accumulate(v.begin(), v.end(), 0.) / static_cast<double>(v.size());
  };
  const auto pixel = static_cast<double>(overhead.pixelSize());
  return {static_cast<double>(covered) * pixel * pixel, mean(depths.depth), mean(depths.thickness)};
}

int runPlant(PlantOptions options, const RunOptions& run) {
  if (options.list) {
    for (const std::string& name : speciesNames()) fmt::print("{}\n", name);
    return 0;
  }
  if (!options.write_species.empty()) return writeSpecies(options.write_species[0], options.write_species[1]);
  if (!options.output.empty()) requireWritable(options.output);
  options.rules.up = options.up == "y" ? ImportRules::Up::y : ImportRules::Up::z;
  TreeMesh mesh;
  std::string source, how;
  Dropped dropped;
  if (isGrown(options.input)) {
    const std::string& kind = options.input.empty() ? options.species : options.input;
    mesh = grow(speciesOrFile(kind), run.seed);
    source = fmt::format("{}, seed {}", kind, run.seed);
  } else {
    ImportedTree imported = importTree(options.input, options.rules);
    mesh = std::move(imported.mesh);
    dropped = imported.dropped;
    how = imported.how;
    source = options.input;
  }
  if (!options.output.empty()) writeObj(options.output, mesh);

  const Crown crown = crownOf(mesh);
  const double area = leafArea(mesh);
  // Leaves that are all upright cover nothing from above: there is no index then.
  const double lai = crown.projected_area > 0. ? area / crown.projected_area : 0.;
  if (run.json) {
    const nlohmann::ordered_json result{{"leaves", mesh.leaf_count},
                                        {"leaf_triangles", mesh.leaf_triangles.size()},
                                        {"leaf_area_m2", area},
                                        {"wood_triangles", mesh.wood_triangles.size()},
                                        {"lai", lai},
                                        {"units", "m"},
                                        {"mean_depth", crown.mean_depth},
                                        {"mean_thickness", crown.mean_thickness},
                                        {"dropped_leaf_triangles", dropped.leaf_triangles},
                                        {"dropped_wood_triangles", dropped.wood_triangles}};
    fmt::print("{}\n", result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return 0;
  }
  const glm::vec3 size = bounds(mesh).size();
  fmt::print("{}\n", source);
  if (!how.empty()) fmt::print("  leaf and wood  {}\n", how);
  fmt::print("  leaves         {} ({} triangles), {:.4g} m2 of one side\n", mesh.leaf_count, mesh.leaf_triangles.size(),
             area);
  fmt::print("  wood           {} triangles\n", mesh.wood_triangles.size());
  if (dropped.leaf_triangles + dropped.wood_triangles > 0)
    fmt::print("  dropped        {} leaf and {} wood triangles of no area\n", dropped.leaf_triangles,
               dropped.wood_triangles);
  fmt::print("  size           {:.3g} x {:.3g} x {:.3g} m\n", size.x, size.y, size.z);
  fmt::print("  leaf area      {:.3g} times the crown's projection on the ground\n", lai);
  fmt::print("  from overhead  a leaf lies {:.2f} leaves deep in {:.2f} on average\n", crown.mean_depth,
             crown.mean_thickness);
  if (!options.output.empty()) fmt::print("wrote {}\n", options.output);
  return 0;
}

}  // namespace

void addPlant(CLI::App& app, RunOptions& options, int& status) {
  auto plant = std::make_shared<PlantOptions>();
  CLI::App* command =
      addCommand(app, options, "plant", "Grow a tree, or read one, and tell its leaves; write it as OBJ");
  CLI::Option* input = command->add_option("input", plant->input,
                                           "A species to grow by its name or its parameter file (.toml), or a mesh to "
                                           "read (.obj, .ply)");
  command->add_option("--species", plant->species,
                      "What to grow, as above (default cherry); --seed grows another one of it");
  command->add_flag("--list", plant->list, "Print the names of the species there are");
  command
      ->add_option("--write-species", plant->write_species, "NAME FILE.toml: write a species' parameters, to be edited")
      ->expected(2);
  command->add_option("-o,--output", plant->output, "File to write: .obj, with its .mtl beside it");
  command->add_option("--leaf", plant->rules.leaf,
                      "Materials or groups of the mesh that are leaves, such as 'leaf*'; '*' takes all");
  command->add_option("--wood", plant->rules.wood, "Materials or groups of the mesh that are wood");
  command->add_option("--scale", plant->rules.scale, "Metres per unit of the mesh (default 1)")
      ->check(numberIn(1e-9, 1e9, "in [1e-9, 1e9]"));
  command->add_option("--up", plant->up, "Upward axis of the mesh: z or y (default z)")
      ->check(CLI::IsMember({"z", "y"}));
  command->get_option("--species")->excludes(input);
  for (const char* of_input : {"--leaf", "--wood", "--scale", "--up"}) command->get_option(of_input)->needs(input);
  command->callback([plant, &options, &status] { status = runPlant(*plant, options); });
}

}  // namespace sunfleck::apps
