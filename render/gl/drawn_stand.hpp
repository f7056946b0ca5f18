#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/gl/light_map.hpp"
#include "render/gl/opacity_map_store.hpp"
#include "render/scene.hpp"
#include "render/stand_geometry.hpp"
#include "sky/sky_map.hpp"

// All that a picture of a stand is made of, as plain data. What is spanned is only read while it is sent.
namespace sunfleck::gl {

inline constexpr std::size_t kMostLights = kMostSuns;

struct DrawnLight {
  Direction along{0.f, 0.f, -1.f};  // in which it travels
  glm::vec3 irradiance{1.f};        // of a plane that faces it, per band [1]
};

// The cells of a kind (grid/cell_grid.hpp).
struct DrawnCells {
  glm::vec3 low{0.f};     // corner of cell (0, 0, 0) in the prototype's frame [m]
  float cell_size = 1.f;  // [m], > 0
  glm::ivec3 size{0};     // [cell]; 0: there are none
};

struct TreeLevels;

struct DrawnKind {
  TreeKind tree;                             // its mesh turned as its trees stand
  std::shared_ptr<const TreeLevels> levels;  // of that mesh; none: they are made when it is sent
  DrawnCells cells;
  std::vector<LightMap> maps;  // of each light
  // Of each triangle of the mesh, leaves before wood, its place in the light field; empty where that is not told.
  std::span<const std::uint32_t> field_places;
  std::span<const std::uint32_t> far_field_places;  // the same in trees that are far
};

// Values of all cells of a tree, or of all its places in the light field, or of the ground; another revision whenever
// they are others (core/revision.hpp).
template <typename Value>
struct TreeValues {
  std::span<const Value> values;  // empty: not told
  std::uint64_t revision = 1;
};

struct DrawnTree {
  glm::vec3 position{0.f};  // [m]
  std::uint32_t kind = 0;
  std::array<TreeValues<float>, kMostLights> compensation;  // G for each light; where not told, 1
  TreeValues<glm::vec3> sky_light;                          // mean radiance; where not told, 0 [1/sr]
  // (F26) Irradiance of the front and the back of each place by all but the suns' direct light [1].
  TreeValues<glm::vec3> field;
  bool far = false;  // whether its places are those of trees that are far
};

struct DrawnStand {
  std::vector<DrawnLight> lights;  // at most kMostLights
  std::vector<DrawnKind> kinds;
  std::vector<DrawnTree> trees;
  std::optional<glm::vec2> period;  // [m]
  glm::ivec2 periods_around{0};     // in which copies may stand in the light
  glm::vec3 ground_albedo{0.f};     // per band [1]; 0 in all: there is none
  std::shared_ptr<const SkyMap> sky;
  GroundSky ground_sky;  // what the ground receives of it
  // (F31) Irradiance of each of the ground's cells, ground_sky.grid, by what the trees scatter [1].
  TreeValues<glm::vec3> ground_field;
};

// Displacements of a stand's copies so many periods around, the stand itself first [m]. Where the stand is not periodic
// there are no others.
std::vector<glm::vec3> copies(const DrawnStand& stand, glm::ivec2 around);
// Tree i of copy c of so many periods around is drawn tree c * trees + i.
inline constexpr int kDrawnAround = 1;

// `geometry` is up to date for the scene. G and sky light are told of the trees for which it has them.
//   made  from where maps are taken that the graphics card made
DrawnStand drawnStand(const Scene& scene, const StandGeometry& geometry, const OpacityMapStore* made = nullptr);

}  // namespace sunfleck::gl
