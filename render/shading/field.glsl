// (F26) The light field: what others scattered, and light of the sky, comes to either side of a surface as it is told of
// the place there, of all suns together.
Scattered scatteredLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  return notTold(vec3(0.0f));
}

//   same, other  irradiance of the side that is seen and of the one beyond, per band
Shaded shadeBySides(Surface surface, vec3 same, vec3 other) {
  vec3 reflected = vec3(0.0f);
  if (surface.roughness > 0.0f) {
    Gloss gloss = glossSeen(surface);
    reflected = (0.3183098861837907f * gloss.albedo) * surface.gloss * same;
    same *= gloss.entering * gloss.let_in;
    other *= gloss.passing * gloss.let_in_beyond;
  }
  Shaded shaded;
  shaded.direct = vec3(0.0f);
  shaded.single = vec3(0.0f);
  shaded.scattered = vec3(0.0f);
  for (int band = 0; band < 3; ++band) {
    SidesLight sides;
    sides.same = same[band];
    sides.other = other[band];
    shaded.scattered[band] = lambertRadiance(sides, surface.reflectance[band], surface.transmittance[band]);
  }
  shaded.scattered += reflected;
  return shaded;
}
