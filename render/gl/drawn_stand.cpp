#include "render/gl/drawn_stand.hpp"

#include "grid/neighbours.hpp"

namespace sunfleck::gl {

DrawnStand drawnStand(const Scene& scene, const StandGeometry& geometry) {
  DrawnStand stand;
  for (const StandLight& light : geometry.lights())
    stand.lights.push_back({.along = light.along, .irradiance = light.irradiance});
  for (std::size_t kind = 0; kind < geometry.kinds().size(); ++kind) {
    const StandKind& of_stand = geometry.kinds()[kind];
    DrawnKind& drawn = stand.kinds.emplace_back();
    drawn.tree = scene.kinds[of_stand.kind];
    drawn.tree.mesh = of_stand.mesh;
    if (!of_stand.stands) continue;
    const CellGrid& cells = geometry.cells(kind);
    drawn.cells = {.low = cells.low, .cell_size = cells.cell_size, .size = cells.size};
    for (std::size_t light = 0; light < stand.lights.size(); ++light)
      drawn.maps.push_back(lightMap(geometry.light(kind, light), geometry.lightRevision(kind, light)));
  }
  for (std::size_t tree = 0; tree < scene.stand.trees.size(); ++tree) {
    DrawnTree& drawn = stand.trees.emplace_back();
    drawn.position = scene.stand.trees[tree].position;
    drawn.kind = static_cast<std::uint32_t>(geometry.kindOf(tree));
    for (std::size_t light = 0; light < stand.lights.size(); ++light)
      drawn.compensation[light] = {geometry.compensation(tree, light), geometry.compensationRevision(tree, light)};
    drawn.sky_light = {geometry.skyLight(tree), geometry.skyLightRevision(tree)};
  }
  stand.period = scene.stand.period;
  if (stand.period)
    for (const StandKind& kind : geometry.kinds())
      if (kind.stands)
        stand.periods_around = glm::max(stand.periods_around, periodsAround(scene.stand, leafBounds(*kind.mesh)));
  stand.ground_albedo = scene.ground_albedo;
  stand.sky = geometry.sky();
  return stand;
}

}  // namespace sunfleck::gl
