#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/commands.hpp"
#include "apps/scene_options.hpp"
#include "apps/terminal.hpp"
#include "core/whole_file.hpp"
#include "grid/density_grid.hpp"

namespace sunfleck::apps {
namespace {

struct VoxelizeOptions {
  SceneOptions scene;
  std::string output;
  std::optional<float> cell_size;
};

constexpr float kCellsAlongTree = 128.f;

int runVoxelize(const VoxelizeOptions& options, const RunOptions& run) {
  if (!options.output.empty()) requireNamed(options.output, ".vdb");
  const bool from_grid = std::filesystem::path(options.scene.scene).extension() == ".vdb";
  double mesh_area = 0., seconds = 0.;
  std::string source = options.scene.scene;
  const DensityGrid grid = [&] {
    if (from_grid) return DensityGrid::read(options.scene.scene);
    const Scene scene = readScene(options.scene);
    source = scene.source;
    mesh_area = leafArea(*scene.tree);
    const glm::vec3 size = leafBounds(*scene.tree).size();
    const float cell_size = options.cell_size.value_or(std::max({size.x, size.y, size.z}) / kCellsAlongTree);
    const auto start = std::chrono::steady_clock::now();
    DensityGrid made = DensityGrid::voxelize(*scene.tree, cell_size, terminalProgress("voxelizing", run.quiet));
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return made;
  }();
  if (!options.output.empty()) grid.write(options.output, source);

  if (run.json) {
    nlohmann::ordered_json result{{"cell_size_m", grid.cellSize()},
                                  {"occupied_cells", grid.occupiedCells()},
                                  {"leaf_area_m2", grid.leafArea()},
                                  {"memory_bytes", grid.memoryBytes()}};
    if (!from_grid) {
      result["mesh_leaf_area_m2"] = mesh_area;
      result["seconds"] = seconds;
    }
    fmt::print("{}\n", result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return 0;
  }
  fmt::print("{}\n  cells          {} occupied, {:.4g} m wide, {:.3g} MB\n  leaf area      {:.6g} m2", source,
             grid.occupiedCells(), grid.cellSize(), static_cast<double>(grid.memoryBytes()) * 1e-6, grid.leafArea());
  if (!from_grid) fmt::print(", of the mesh {:.6g} m2\n  time           {:.0f} ms", mesh_area, 1e3 * seconds);
  fmt::print("\n");
  if (!options.output.empty()) fmt::print("wrote {}\n", options.output);
  return 0;
}

}  // namespace

void addVoxelize(CLI::App& app, RunOptions& options, int& status) {
  auto voxelize = std::make_shared<VoxelizeOptions>();
  CLI::App* command =
      addCommand(app, options, "voxelize",
                 "Leaf area density of a scene's tree on an OpenVDB grid; or tell what a .vdb file holds");
  addSceneOptions(*command, voxelize->scene);
  command->add_option("-o,--output", voxelize->output, "File to write: .vdb");
  command->add_option("--cell-size", voxelize->cell_size, "Side of a cell in metres (default: 1/128 of the tree)")
      ->check(numberIn(1e-5, 1e6, "in [1e-5, 1e6] m"));
  command->callback([voxelize, &options, &status] { status = runVoxelize(*voxelize, options); });
}

}  // namespace sunfleck::apps
