#include "render/gl/drawn_stand.hpp"

#include "grid/neighbours.hpp"
#include "render/stand_field.hpp"

namespace sunfleck::gl {

std::vector<glm::vec3> copies(const DrawnStand& stand, glm::ivec2 around) {
  std::vector<glm::vec3> shifts{glm::vec3(0.f)};
  if (!stand.period) return shifts;
  for (int y = -around.y; y <= around.y; ++y)
    for (int x = -around.x; x <= around.x; ++x)
      if (x != 0 || y != 0)
        shifts.push_back({static_cast<float>(x) * stand.period->x, static_cast<float>(y) * stand.period->y, 0.f});
  return shifts;
}

DrawnStand drawnStand(const Scene& scene, const StandGeometry& geometry, const OpacityMapStore* made) {
  DrawnStand stand;
  for (const StandLight& light : geometry.lights())
    stand.lights.push_back({.along = light.along, .irradiance = light.irradiance});
  for (std::size_t kind = 0; kind < geometry.kinds().size(); ++kind) {
    const StandKind& of_stand = geometry.kinds()[kind];
    DrawnKind& drawn = stand.kinds.emplace_back();
    drawn.tree = scene.kinds[of_stand.kind];
    drawn.tree.mesh = of_stand.mesh;
    if (!of_stand.stands) continue;
    if (geometry.field()) {
      drawn.field_places = geometry.field()->places(of_stand.kind);
      drawn.far_field_places = geometry.field()->farPlaces(of_stand.kind);
    }
    const CellGrid& cells = geometry.cells(kind);
    drawn.cells = {.low = cells.low, .cell_size = cells.cell_size, .size = cells.size};
    for (std::size_t light = 0; light < stand.lights.size(); ++light) {
      drawn.maps.push_back(lightMap(geometry.light(kind, light), geometry.lightRevision(kind, light)));
      if (made)
        drawn.maps.back().made =
            made->find(of_stand.mesh, stand.lights[light].along, geometry.effort().light_resolution);
    }
  }
  for (std::size_t tree = 0; tree < scene.stand.trees.size(); ++tree) {
    DrawnTree& drawn = stand.trees.emplace_back();
    drawn.position = scene.stand.trees[tree].position;
    drawn.kind = static_cast<std::uint32_t>(geometry.kindOf(tree));
    for (std::size_t light = 0; light < stand.lights.size(); ++light)
      drawn.compensation[light] = {geometry.compensation(tree, light), geometry.compensationRevision(tree, light)};
    if (geometry.field()) {
      drawn.field = {geometry.field()->sides(tree), geometry.field()->revision()};
      drawn.far = geometry.field()->isFar(tree);
    }
    drawn.sky_light = {geometry.skyLight(tree), geometry.skyLightRevision(tree)};
  }
  stand.period = scene.stand.period;
  if (stand.period)
    for (const StandKind& kind : geometry.kinds())
      if (kind.stands)
        stand.periods_around = glm::max(stand.periods_around, periodsAround(scene.stand, leafBounds(*kind.mesh)));
  stand.ground_albedo = scene.ground_albedo;
  stand.sky = geometry.sky();
  stand.ground_sky = geometry.groundSky();
  if (geometry.field()) stand.ground_field = {geometry.field()->ground(), geometry.field()->revision()};
  return stand;
}

}  // namespace sunfleck::gl
