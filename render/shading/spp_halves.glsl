// (S2) Diffuse powers of the simplified plane-parallel slab, per band.
HalvesLight sppHalves(uint kind, float depth, float thickness) {
  float direct = directPower(depth, 1.0f);
  HalvesLight diffuse;
  for (int band = 0; band < 3; ++band) {
    SppConstants leaves;
    leaves.rate = kinds[kind].slab_rate[band];
    leaves.loss = kinds[kind].slab_loss[band];
    leaves.backward = kinds[kind].slab_backward[band];
    SlabPowers powers = sppPowersOf(leaves, depth, thickness);
    diffuse.down[band] = max(powers.down - direct, 0.0f);
    diffuse.up[band] = powers.up;
  }
  return diffuse;
}
