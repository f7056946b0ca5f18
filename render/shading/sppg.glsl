// (S2, S6) The simplified plane-parallel slab, compensated for the edge of the crown.
#include "render/shading/spp_halves.glsl"

Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  HalvesLight diffuse = sppHalves(surface.kind, foliage.before, thickness);
  diffuse.down *= compensation;
  diffuse.up *= compensation;
  return fromHalves(surface, light, diffuse);
}
