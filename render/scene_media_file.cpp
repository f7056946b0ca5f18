#include "render/detail/scene_media_file.hpp"

#include <cmath>

#include "grid/isolated_read.hpp"
#include "render/detail/scene_leaf_file.hpp"
#include "scattering/leaf_angles.hpp"

namespace sunfleck::detail {
namespace {

void readOptics(SceneMedium& medium, SceneTable& table, const TreeKind& of_scene, const LightBands& bands) {
  if (medium.particles) {
    const glm::vec3 albedo = table.perBand("albedo", glm::vec3(1.f));
    for (std::size_t band = 0; band < kBands; ++band)
      medium.optics[band] = {.reflectance = albedo[static_cast<int>(band)], .transmittance = 0.f};
    medium.asymmetry = static_cast<float>(table.number("asymmetry", 0., -0.999, 0.999, "in [-0.999, 0.999]"));
    return;
  }
  medium.description = of_scene.description;
  BandOptics optics = of_scene.leaf;
  if (const auto of_cells = medium.grid ? medium.grid->meanOptics() : std::nullopt) {
    medium.description = LeafByNumbers{};
    optics = *of_cells;
  }
  if (of_scene.textures.any() && !medium.grid && !tellsLeafShares(table, ""))
    throw InvalidInput(table.file() +
                       ": [medium] has the leaves of [leaf], which have maps or a lower side: must tell "
                       "its own, by reflectance, species, prospect or slab");
  readLeafShares(table, "", bands, medium.description, optics);
  for (std::size_t band = 0; band < kBands; ++band) {
    medium.optics[band] = {.reflectance = optics[band].reflectance, .transmittance = optics[band].transmittance};
    validate(medium.optics[band]);
  }
  medium.angles = table.text("angles", "");
  if (!medium.angles.empty()) LeafAngles::named(medium.angles);
}

void readPlace(SceneMedium& medium, SceneTable& table, const std::filesystem::path& file) {
  constexpr double kFarthest = 1e5;  // [m]
  const std::string density = medium.particles ? "extinction" : "density";
  if (table.has("file")) {
    for (const char* key : {"density", "extinction", "box", "bottom", "top"})
      if (table.has(key))
        throw InvalidInput(file.string() + ": [medium] has both file and " + key + ": must be one of them");
    const std::filesystem::path grid = file.parent_path() / table.text("file", "");
    medium.grid = std::make_shared<const DensityGrid>(readIsolated(grid));
    medium.source = grid.string();
    medium.density = static_cast<float>(table.number("scale", 1., 1e-9, 1e9, "in [1e-9, 1e9]"));
    if (medium.grid->occupiedCells() == 0)
      throw InvalidInput(grid.string() + ": must hold a cell whose density is not 0");
    return;
  }
  if (!table.has(density))
    throw InvalidInput(file.string() + ": [medium] has neither file nor " + density + ": must have one of them");
  medium.density = static_cast<float>(table.number(density, 0., 0., 1e6, "in [0, 1e6] 1/m"));
  if (table.has("box")) {
    for (const char* key : {"bottom", "top"})
      if (table.has(key))
        throw InvalidInput(file.string() + ": [medium] has both box and " + key + ": must be one of them");
    const std::vector<double> v =
        table.numbers("box", 6, -kFarthest, kFarthest, "six coordinates in [-1e5, 1e5] m: [x, y, z, x, y, z]");
    for (int axis = 0; axis < 3; ++axis) {
      medium.box.low[axis] = static_cast<float>(v[static_cast<std::size_t>(axis)]);
      medium.box.high[axis] = static_cast<float>(v[static_cast<std::size_t>(axis) + 3]);
      if (!(medium.box.low[axis] < medium.box.high[axis]))
        throw InvalidInput(file.string() + ": medium.box: must have its low corner first and be wider than 0");
    }
    return;
  }
  const std::string rule = "in [-1e5, 1e5] m";
  medium.box.low.z = static_cast<float>(table.number("bottom", 0., -kFarthest, kFarthest, rule));
  medium.box.high.z = static_cast<float>(table.number("top", 1., -kFarthest, kFarthest, rule));
  require(medium.box.low.z < medium.box.high.z, file.string() + ": medium.top", medium.box.high.z, "above the bottom");
}

}  // namespace

void readMedia(Scene& scene, const toml::node& node, const TreeKind& optics, const std::filesystem::path& file) {
  const toml::array* several = node.as_array();  // [[medium]]
  const std::size_t count = several ? several->size() : 1;
  if (count == 0)
    throw InvalidInput(file.string() + ": medium = []: must be a table [medium], or a [[medium]] for each");
  for (std::size_t i = 0; i < count; ++i) {
    SceneTable table(several ? several->get(i) : &node, file.string(), "medium");
    SceneMedium& medium = scene.media.emplace_back();
    const std::string kind = table.text("kind", "leaves");
    if (kind != "leaves" && kind != "particles")
      throw InvalidInput(file.string() + ": medium.kind = \"" + kind + "\": must be leaves or particles");
    medium.particles = kind == "particles";
    readPlace(medium, table, file);
    readOptics(medium, table, optics, scene.bands);
    table.done();
  }
}

}  // namespace sunfleck::detail
