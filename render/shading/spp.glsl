// (S2, S6) The simplified plane-parallel slab, compensated for the edge of the crown: by 1 where the model does not.

SppRates slabOf(uint kind, int band) {
  SppRates leaves;
  leaves.rate = kinds[kind].slab_rate[band];
  leaves.loss = kinds[kind].slab_loss[band];
  leaves.backward = kinds[kind].slab_backward[band];
  return leaves;
}

Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  float direct = directPower(foliage.before, 1.0f);
  HalvesLight diffuse, once;
  for (int band = 0; band < 3; ++band) {
    SppRates leaves = slabOf(surface.kind, band);
    SlabPowers powers = sppPowersOf(leaves, foliage.before, thickness);
    diffuse.down[band] = compensation * max(powers.down - direct, 0.0f);
    diffuse.up[band] = compensation * powers.up;
    SlabPowers of_once = sppScatteredOnce(leaves, foliage.before, thickness);
    once.down[band] = compensation * of_once.down;
    once.up[band] = compensation * of_once.up;
  }
  Scattered scattered;
  scattered.radiance = fromHalves(surface, light, diffuse);
  scattered.single = fromHalves(surface, light, once);
  return scattered;
}
