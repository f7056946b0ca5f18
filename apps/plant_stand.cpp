#include "apps/plant_stand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "apps/csv_rows.hpp"
#include "core/require.hpp"
#include "plants/stand_layout.hpp"
#include "plants/write_gltf.hpp"
#include "render/radians.hpp"
#include "render/scene_file.hpp"
#include "render/scene_writer.hpp"

namespace sunfleck::apps {
namespace {

// The first line of the file, where it is one of those that a stand has.
std::string headerOf(const std::string& file) {
  constexpr std::array headers{"x,y", "x,y,rotation_deg", "x,y,rotation_deg,species"};
  std::ifstream in = openedText(file);
  std::string line;
  std::getline(in, line);
  removeByteOrderMark(line);
  removeReturn(line);
  if (std::find(headers.begin(), headers.end(), line) == headers.end())
    throw InvalidInput(fmt::format("{}:1: \"{}\": must be {}", file, line.substr(0, 80), fmt::join(headers, " or ")));
  return line;
}

void readPositions(const std::string& file, std::uint64_t seed, Scene& scene) {
  for (const CsvRow& row : readCsvRows(file, headerOf(file))) {
    const auto number = [&](std::size_t column, const char* rule) {
      const double value = numberAt(row.fields[column], row.where);
      if (!(std::abs(value) <= 1e6))
        throw InvalidInput(fmt::format("{}\"{}\": must be {}", row.where, row.fields[column].substr(0, 40), rule));
      return value;
    };
    constexpr const char* kPlace = "in [-1e6, 1e6] m";
    Placement tree{.position = {static_cast<float>(number(0, kPlace)), static_cast<float>(number(1, kPlace)), 0.f}};
    if (row.fields.size() > 2) tree.rotation = radiansOf(number(2, "in [-1e6, 1e6] degrees"));
    if (row.fields.size() > 3) {
      const std::string& name = row.fields[3];
      auto kind = std::ranges::find(scene.kinds, name, &TreeKind::name);
      if (kind == scene.kinds.end()) {
        try {
          scene.kinds.push_back(grownKind(name, seed));
        } catch (const InvalidInput& e) {
          throw InvalidInput(row.where + e.what());
        }
        kind = scene.kinds.end() - 1;
        kind->name = name;
        kind->description = scene.kinds.front().description;
        kind->textures = scene.kinds.front().textures;
        setLeaves(*kind, scene.bands, scene.kinds.front().told());
      }
      tree.kind = static_cast<std::uint32_t>(kind - scene.kinds.begin());
    }
    scene.stand.trees.push_back(tree);
  }
  if (scene.stand.trees.empty()) throw InvalidInput(file + ": has no trees: must have one at least");
}

// Kinds of which no tree stands are left out.
void dropAbsentKinds(Scene& scene) {
  std::vector<TreeKind> present;
  std::vector<std::uint32_t> number(scene.kinds.size(), ~0u);
  for (Placement& tree : scene.stand.trees) {
    if (number[tree.kind] == ~0u) {
      number[tree.kind] = static_cast<std::uint32_t>(present.size());
      present.push_back(scene.kinds[tree.kind]);
    }
    tree.kind = number[tree.kind];
  }
  scene.kinds = std::move(present);
}

}  // namespace

Scene plantStand(const PlantStand& stand, TreeKind first, std::uint64_t seed) {
  Scene scene;
  const float width = 2.f * crownRadius(*first.mesh);
  scene.kinds = {std::move(first)};
  scene.name = scene.origin = stand.kind;
  scene.stand.trees.clear();
  const float spacing = stand.spacing > 0.f ? stand.spacing : width;
  const glm::vec2 area = stand.area.empty() ? glm::vec2(5.f * spacing) : glm::vec2(stand.area[0], stand.area[1]);
  if (std::filesystem::path(stand.kind).extension() == ".csv")
    readPositions(stand.kind, seed, scene);
  else if (stand.kind == "regular")
    scene.stand.trees = gridStand(area, spacing, 0.f, seed);
  else if (stand.kind == "jittered")
    scene.stand.trees = gridStand(area, spacing, stand.jitter, seed);
  else if (stand.kind == "poisson")
    scene.stand.trees = poissonStand(area, spacing, seed);
  else
    require(false, "--stand", stand.kind, "regular, jittered, poisson or a .csv file of positions");
  dropAbsentKinds(scene);
  return scene;
}

void writeStand(const std::string& file, const Scene& scene) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".toml")
    writeScene(file, scene);
  else if (extension == ".glb" || extension == ".gltf")
    writeGltf(file, meshes(scene), scene.stand);
  else
    require(false, "output file", file, "named with the extension .toml, .glb or .gltf for a stand");
}

}  // namespace sunfleck::apps
