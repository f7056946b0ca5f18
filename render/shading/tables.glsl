// (R27) Powers from a table over depth and thickness, compensated for the edge of the crown.
struct TableNode {  // diffuse P+ and P- of a kind's leaves, per band
  float down[3];
  float up[3];
};
MODEL_CONSTANTS(TableNode);

Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  TablePlace place = tablePlace(foliage.before, thickness);
  uint thin = (surface.kind * uint(kTableThicknesses) + uint(place.thickness)) * uint(kTableDepths) + uint(place.depth);
  uint thick = thin + uint(kTableDepths);
  HalvesLight diffuse;
  for (int band = 0; band < 3; ++band) {
    diffuse.down[band] = compensation * tableValue(place, model_constants[thin].down[band],
                                                   model_constants[thin + 1u].down[band],
                                                   model_constants[thick].down[band],
                                                   model_constants[thick + 1u].down[band]);
    diffuse.up[band] = compensation * tableValue(place, model_constants[thin].up[band],
                                                 model_constants[thin + 1u].up[band], model_constants[thick].up[band],
                                                 model_constants[thick + 1u].up[band]);
  }
  return fromHalves(surface, light, diffuse);
}
