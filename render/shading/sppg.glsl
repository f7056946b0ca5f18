// (S2, S6) The simplified plane-parallel slab, compensated for the edge of the crown.
struct SppConstants {  // of a kind's leaves in a band
  float albedo;
  float forward_share;
};
MODEL_CONSTANTS(SppConstants);

Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  float direct = directPower(foliage.before, 1.0f);
  HalvesLight diffuse;
  for (int band = 0; band < 3; ++band) {
    SppConstants leaves = model_constants[3u * surface.kind + uint(band)];
    SlabPowers powers = sppPowers(foliage.before, thickness, 1.0f, leaves.albedo, leaves.forward_share);
    diffuse.down[band] = compensation * max(powers.down - direct, 0.0f);
    diffuse.up[band] = compensation * powers.up;
  }
  return fromHalves(surface, light, diffuse);
}
