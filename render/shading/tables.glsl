// (R27) Powers from a table over depth and thickness, compensated for the edge of the crown. The model's numbers: for each
// node of each kind's table diffuse P+ of the bands, then P-.
vec3 nodeAt(uint node, uint half_sphere) {
  return vec3(modelNumbers(2u * node + half_sphere));
}
vec3 tablePower(TablePlace place, uint thin, uint half_sphere) {
  uint thick = thin + uint(kTableDepths);
  vec3 thin_before = nodeAt(thin, half_sphere), thin_beyond = nodeAt(thin + 1u, half_sphere);
  vec3 thick_before = nodeAt(thick, half_sphere), thick_beyond = nodeAt(thick + 1u, half_sphere);
  vec3 power;
  for (int band = 0; band < 3; ++band)
    power[band] = tableValue(place, thin_before[band], thin_beyond[band], thick_before[band], thick_beyond[band]);
  return power;
}

Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  TablePlace place = tablePlace(foliage.before, thickness);
  uint thin = (surface.kind * uint(kTableThicknesses) + uint(place.thickness)) * uint(kTableDepths) + uint(place.depth);
  HalvesLight diffuse;
  diffuse.down = compensation * tablePower(place, thin, 0u);
  diffuse.up = compensation * tablePower(place, thin, 1u);
  return notTold(fromHalves(surface, light, diffuse));
}
