// Single scattering: no light but the direct, none that was scattered before.
Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  return notTold(vec3(0.0f));
}
