#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
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

namespace sunfleck::apps {
namespace {

struct VoxelizeOptions {
  SceneOptions scene;
  std::string output;
  std::optional<float> cell_size;
  bool stand = false;
};

constexpr float kCellsAlongTree = 128.f;

void requireGridFile(const std::filesystem::path& file) {
  if (file.extension() != ".vdb" && file.extension() != ".nvdb")
    throw InvalidInput(file.string() + ": must be named with the extension .vdb or .nvdb");
  requireWritable(file);
}

// Share of the leaf area that is seen from above: the mean of |n_z|, which the grid estimates.
double projectionAlongZ(const TreeMesh& mesh) {
  double projected = 0.;
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    projected += 0.5 * std::abs(glm::cross(b - a, c - a).z);
  }
  return projected / leafArea(mesh);
}

std::string standName(const Scene& scene) {
  const std::string trees = fmt::format("{} x {}", scene.stand.trees.size(), scene.kinds[0].source);
  if (!scene.stand.period) return trees;
  return fmt::format("{}, one period of {:.6g} m x {:.6g} m", trees, scene.stand.period->x, scene.stand.period->y);
}

int runVoxelize(const VoxelizeOptions& options, const RunOptions& run) {
  if (!options.output.empty()) requireGridFile(options.output);
  const bool from_grid = std::filesystem::path(options.scene.scene).extension() == ".vdb";
  double mesh_area = 0., mesh_projection = 0., seconds = 0.;
  GridSource source{.name = options.scene.scene, .hash = "", .program = versionText()};
  const DensityGrid grid = [&] {
    if (from_grid) {
      if (options.stand) throw InvalidInput("--stand: a .vdb file holds grids and no trees to place");
      return DensityGrid::read(options.scene.scene);
    }
    const Scene scene = readScene(options.scene);
    source.name = scene.kinds[0].source;
    source.hash = meshHash(*scene.kinds[0].mesh);
    mesh_area = leafArea(*scene.kinds[0].mesh);
    if (options.stand) {
      source.name = standName(scene);
      source.hash = standHash(*scene.kinds[0].mesh, scene.stand);
      mesh_area *= static_cast<double>(scene.stand.trees.size());
    }
    mesh_projection = projectionAlongZ(*scene.kinds[0].mesh);
    const glm::vec3 size = leafBounds(*scene.kinds[0].mesh).size();
    const float cell_size = options.cell_size.value_or(std::max({size.x, size.y, size.z}) / kCellsAlongTree);
    const auto start = std::chrono::steady_clock::now();
    const Progress progress = terminalProgress("voxelizing", run.quiet);
    DensityGrid made = options.stand
                           ? DensityGrid::voxelizeStand(*scene.kinds[0].mesh, scene.stand, cell_size, progress)
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
  fmt::print("\n  grids          name        cells      MB  unit\n");
  for (const DensityGrid::Summary& one : grid.grids())
    fmt::print("                 {:9} {:>7} {:>7.3g}  {}\n", one.name, one.cells, static_cast<double>(one.bytes) * 1e-6,
               one.unit);
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
      ->check(numberIn(1e-5, 1e6, "in [1e-5, 1e6] m"));
  command->add_flag(
      "--stand", voxelize->stand,
      "All trees of the scene's stand on one grid; one period of a periodic stand (default: its tree alone)");
  command->callback([voxelize, &options, &status] { status = runVoxelize(*voxelize, options); });
}

}  // namespace sunfleck::apps
