// (S9, S13) The exact solution with two streams in each half, compensated for the edge of the crown.
struct NStreamConstants {  // of a kind's leaves in a band
  float depth_scale;      // scaled depth per leaf crossing along the light
  float beam_rate;
  StreamModes modes;
  ModeWeights powers;
};
MODEL_CONSTANTS(NStreamConstants);

Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  HalvesLight diffuse;
  for (int band = 0; band < 3; ++band) {
    uint leaves = 3u * surface.kind + uint(band);
    SlabPlace at = slabPlace(foliage.before, thickness, model_constants[leaves].depth_scale,
                             model_constants[leaves].beam_rate);
    SlabPowers powers = streamPowers(model_constants[leaves].modes, model_constants[leaves].powers, at);
    diffuse.down[band] = compensation * max(powers.down - at.direct, 0.0f);
    diffuse.up[band] = compensation * powers.up;
  }
  return fromHalves(surface, light, diffuse);
}
