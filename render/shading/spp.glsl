// (S2) The simplified plane-parallel slab.
#include "render/shading/spp_halves.glsl"

Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  return fromHalves(surface, light, sppHalves(surface.kind, foliage.before, thickness));
}
