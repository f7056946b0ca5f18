#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "apps/commands.hpp"
#include "apps/scene_options.hpp"
#include "apps/terminal.hpp"
#include "apps/version.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "grid/density_grid.hpp"
#include "grid/isolated_read.hpp"
#include "render/stand_geometry.hpp"

namespace sunfleck::apps {
namespace {

struct VoxelizeOptions {
  SceneOptions scene;
  std::string output;
  std::optional<float> cell_size;
  bool stand = false, optics = false;
  std::string of_trees;  // an option given that says something of trees, or of the grids to make of them
};

constexpr float kCellsAlongTree = 128.f;  // the smallest of the scene's

void requireGridFile(const std::filesystem::path& file) {
  if (file.extension() != ".vdb" && file.extension() != ".nvdb")
    throw InvalidInput(file.string() + ": must be named with the extension .vdb or .nvdb");
  requireWritable(file);
}

// Of any case, as importers take a tree's file.
bool isGridFile(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".vdb" || extension == ".VDB";
}

// The first option given that is none of those every command and every input takes.
std::string optionOfTrees(const CLI::App& command) {
  static const std::vector<std::string> of_any{"scene", "--output", "--json", "--quiet", "--threads", "--seed"};
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 && std::find(of_any.begin(), of_any.end(), option->get_name()) == of_any.end())
      return option->get_name();
  return "";
}

// Leaf area as seen from above, each leaf for itself: that times the mean of |n_z|, which the grid estimates [m^2].
double projectedAlongZ(const TreeMesh& mesh) {
  double projected = 0.;
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    projected += 0.5 * std::abs(glm::cross(b - a, c - a).z);
  }
  return projected;
}

float defaultCellSize(const Scene& scene) {
  float least = std::numeric_limits<float>::infinity();
  for (const TreeKind& kind : scene.kinds) {
    const glm::vec3 size = leafBounds(*kind.mesh).size();
    least = std::min(least, std::max({size.x, size.y, size.z}) / kCellsAlongTree);
  }
  return least;
}

// Of the kinds' leaves; none unless they differ or are asked for.
std::vector<BandOptics> opticsOf(const Scene& scene, bool asked) {
  std::vector<BandOptics> optics;
  for (const TreeKind& kind : scene.kinds) optics.push_back(kind.leaf);
  const bool differ = std::adjacent_find(optics.begin(), optics.end(), std::not_equal_to<>()) != optics.end();
  return asked || differ ? optics : std::vector<BandOptics>{};
}

void requireStandIfNeeded(const VoxelizeOptions& options, const Scene& scene) {
  if (options.stand) return;
  if (options.scene.period) throw InvalidInput("--period: without --stand, the tree alone is voxelized");
  if (scene.kinds.size() > 1)
    throw InvalidInput(
        fmt::format("{}: has {} kinds of trees: must be voxelized with --stand", scene.origin, scene.kinds.size()));
}

std::string standName(const Scene& scene) {
  std::vector<std::size_t> count(scene.kinds.size());
  for (const Placement& tree : scene.stand.trees) ++count[tree.kind];
  std::string trees;
  for (std::size_t kind = 0; kind < count.size(); ++kind)
    trees += fmt::format("{}{} x {}", kind == 0 ? "" : "; ", count[kind], scene.kinds[kind].source);
  if (!scene.stand.period) return trees;
  return fmt::format("{}, one period of {:.6g} m x {:.6g} m", trees, scene.stand.period->x, scene.stand.period->y);
}

int runVoxelize(const VoxelizeOptions& options, const RunOptions& run) {
  if (!options.output.empty()) requireGridFile(options.output);
  const bool from_grid = isGridFile(options.scene.scene);
  double mesh_area = 0., mesh_projection = 0., seconds = 0.;
  GridSource source{.name = options.scene.scene, .hash = "", .program = versionText()};
  const DensityGrid grid = [&] {
    if (from_grid) {
      if (!options.of_trees.empty())
        throw InvalidInput(options.of_trees + ": a .vdb file holds grids already and no trees to voxelize");
      return readIsolated(options.scene.scene, [](double) { return !interrupted(); });
    }
    const Scene scene = readScene(options.scene);
    requireWholeLeaves(scene, "voxelize");
    requireStandIfNeeded(options, scene);
    const Stand stand = options.stand ? scene.stand : Stand{};
    const std::vector<BandOptics> optics = opticsOf(scene, options.optics);
    source.name = options.stand ? standName(scene) : scene.kinds[0].source;
    source.hash =
        options.stand || options.optics ? standHash(meshes(scene), stand, optics) : meshHash(*scene.kinds[0].mesh);
    for (const Placement& tree : stand.trees) {
      mesh_area += leafArea(*scene.kindOf(tree).mesh);
      mesh_projection += projectedAlongZ(*scene.kindOf(tree).mesh);
    }
    mesh_projection /= mesh_area;
    const float cell_size = options.cell_size.value_or(defaultCellSize(scene));
    const auto start = std::chrono::steady_clock::now();
    const Progress progress = terminalProgress("voxelizing", run.quiet);
    DensityGrid made = options.stand || options.optics
                           ? DensityGrid::voxelizeStand(meshes(scene), stand, cell_size, optics, progress)
                           : DensityGrid::voxelize(*scene.kinds[0].mesh, cell_size, progress);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return made;
  }();
  if (interrupted()) throw std::runtime_error("interrupted");
  if (!options.output.empty()) grid.write(options.output, source);

  const double projection = grid.projectedLeafArea({0.f, 0.f, -1.f}) / grid.leafArea();
  const bool has_crown = grid.crownArea() > 0.;

  if (run.json) {
    nlohmann::ordered_json result{{"cell_size_m", grid.cellSize()},
                                  {"occupied_cells", grid.occupiedCells()},
                                  {"leaf_area_m2", grid.leafArea()},
                                  {"memory_bytes", grid.memoryBytes()}};
    if (has_crown) {
      result["crown_area_m2"] = grid.crownArea();
      result["lai"] = grid.leafArea() / grid.crownArea();
    }
    if (grid.leafArea() > 0.) result["projection_z"] = projection;
    result["projected_wood_area_m2"] = grid.projectedWoodArea();
    if (const auto optics = grid.meanOptics())
      for (const LeafOptics& band : *optics) {
        result["mean_reflectance"].push_back(band.reflectance);
        result["mean_transmittance"].push_back(band.transmittance);
      }
    for (const DensityGrid::Summary& one : grid.grids())
      result["grids"].push_back(
          {{"name", one.name}, {"unit", one.unit}, {"cells", one.cells}, {"memory_bytes", one.bytes}});
    if (!from_grid) {
      result["mesh_leaf_area_m2"] = mesh_area;
      result["mesh_projection_z"] = mesh_projection;
      result["seconds"] = seconds;
    }
    fmt::print("{}\n", result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return 0;
  }
  fmt::print("{}\n  cells          {} occupied, {:.4g} m wide, {:.3g} MB\n  leaf area      {:.6g} m2", source.name,
             grid.occupiedCells(), grid.cellSize(), static_cast<double>(grid.memoryBytes()) * 1e-6, grid.leafArea());
  if (!from_grid) fmt::print(", of the mesh {:.6g} m2", mesh_area);
  if (has_crown)
    fmt::print("\n  crown          {:.4g} m2 seen from above, leaf area index {:.4g}", grid.crownArea(),
               grid.leafArea() / grid.crownArea());
  if (grid.leafArea() > 0.) fmt::print("\n  projection     {:.4f} along z by the grid", projection);
  if (!from_grid) fmt::print(", {:.4f} by the mesh\n  time           {:.0f} ms", mesh_projection, 1e3 * seconds);
  if (const auto optics = grid.meanOptics()) {
    const auto& [red, green, blue] = *optics;
    fmt::print("\n  leaves         reflectance {:.4g} {:.4g} {:.4g}, transmittance {:.4g} {:.4g} {:.4g} in the mean",
               red.reflectance, green.reflectance, blue.reflectance, red.transmittance, green.transmittance,
               blue.transmittance);
  }
  fmt::print("\n  grids          name                    cells      MB  unit\n");
  for (const DensityGrid::Summary& one : grid.grids())
    fmt::print("                 {:21} {:>7} {:>7.3g}  {}\n", one.name, one.cells,
               static_cast<double>(one.bytes) * 1e-6, one.unit);
  if (!options.output.empty())
    fmt::print("wrote {}, {:.3g} MB\n", options.output,
               static_cast<double>(std::filesystem::file_size(options.output)) * 1e-6);
  return 0;
}

}  // namespace

void addVoxelize(CLI::App& app, RunOptions& options, int& status) {
  auto voxelize = std::make_shared<VoxelizeOptions>();
  CLI::App* command =
      addCommand(app, options, "voxelize",
                 "Leaf area density, leaf orientation and wood of a scene's tree or stand on OpenVDB grids; "
                 "or tell what a .vdb file holds");
  addSceneOptions(*command, voxelize->scene);
  command->add_option("-o,--output", voxelize->output, "File to write: .vdb, or .nvdb for NanoVDB");
  command->add_option("--cell-size", voxelize->cell_size, "Side of a cell in metres (default: 1/128 of the tree)")
      ->check(numberIn(2e-5, 1e6, "in [2e-5, 1e6] m"));
  command->add_flag(
      "--stand", voxelize->stand,
      "All trees of the scene's stand on one grid; one period of a periodic stand (default: its tree alone)");
  command->add_flag("--optics", voxelize->optics,
                    "Also the leaves' reflectance and transmittance in each cell; with --stand, always where the "
                    "scene's kinds of trees differ in them");
  command->callback([voxelize, command, &options, &status] {
    voxelize->of_trees = optionOfTrees(*command);
    status = runVoxelize(*voxelize, options);
  });
}

}  // namespace sunfleck::apps
