// (R3) What a surface sends to the eye of one sun's light.
//   thickness     of the foliage along the light at the surface, a leaf itself included [1]
//   compensation  G at the surface [1], 0 .. 1; read by models that need it
Shaded shadeByLight(Surface surface, Foliage foliage, float thickness, float compensation, uint light) {
  Scattered scattered = scatteredLight(surface, foliage, thickness, compensation, light);
  vec3 irradiance = vec3(lights[light].irradiance);
  Shaded shaded;
  shaded.direct = irradiance * directRadiance(surface, light, foliage.visible);
  shaded.scattered = irradiance * scattered.radiance;
  shaded.single = irradiance * scattered.single;
  return shaded;
}

// (R3) What it sends of the environment's light, alike in all directions; how often that was scattered before is not told.
//   sky  its mean radiance at the surface, per band (D10)
Shaded shadeBySky(Surface surface, vec3 sky) {
  Shaded shaded;
  shaded.direct = vec3(0.0f);
  shaded.single = vec3(0.0f);
  shaded.scattered = sky * (surface.reflectance + surface.transmittance);
  if (surface.roughness > 0.0f) {
    Gloss gloss = glossSeen(surface);
    shaded.scattered = sky * (gloss.albedo * surface.gloss + gloss.entering * gloss.let_in * surface.reflectance +
                              gloss.passing * gloss.let_in_beyond * surface.transmittance);
  }
  return shaded;
}
