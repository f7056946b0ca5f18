// What all models are made of. This text, a model's and shade.glsl are C++ (the members of a class) and GLSL, in this
// order. Both give them `kinds` and `lights`, arrays of KindOptics and ShadingLight, and spp's formulas; C++ defines
// Foliage, what stands before and beyond a place in a light, as foliage.glsl does.

Surface leafSurface(uint kind, uint tree, uint leaf, vec3 normal, vec3 to_eye) {
  Surface surface;
  surface.normal = normal;
  surface.to_eye = to_eye;
  surface.reflectance = vec3(kinds[kind].leaf_reflectance);
  surface.transmittance = vec3(kinds[kind].leaf_transmittance);
  surface.kind = kind;
  surface.tree = tree;
  surface.leaf = leaf;
  return surface;
}

// Wood, or with an albedo of its own the ground.
//   kind  whose leaves make the slab around it
Surface opaqueSurface(uint kind, uint tree, vec3 albedo, vec3 normal, vec3 to_eye) {
  Surface surface;
  surface.normal = normal;
  surface.to_eye = to_eye;
  surface.reflectance = albedo;
  surface.transmittance = vec3(0.0f);
  surface.kind = kind;
  surface.tree = tree;
  surface.leaf = 0xffffffffu;
  return surface;
}
Surface woodSurface(uint kind, uint tree, vec3 normal, vec3 to_eye) {
  return opaqueSurface(kind, tree, vec3(kinds[kind].wood_reflectance), normal, to_eye);
}

// What a model tells of light that was scattered before: radiance towards the eye for irradiance 1  [1/sr].
struct Scattered {
  vec3 single;
  vec3 multiple;
};
Scattered notTold(vec3 radiance) {
  Scattered scattered;
  scattered.single = vec3(0.0f);
  scattered.multiple = radiance;
  return scattered;
}

float toLightCosine(Surface surface, uint light) {
  return -dot(surface.normal, vec3(lights[light].travel));
}

// Powers without the direct light, per band [F].
struct HalvesLight {
  vec3 down;
  vec3 up;
};

// (R27) Radiance towards the eye of diffuse light that is uniform over each half of the sphere about the light's axis.
Scattered fromHalves(Surface surface, uint light, HalvesLight halves) {
  float slant_cosine = toLightCosine(surface, light);
  vec3 radiance;
  for (int band = 0; band < 3; ++band) {
    SlabPowers powers;
    powers.down = halves.down[band];
    powers.up = halves.up[band];
    radiance[band] = lambertRadiance(halvesOnSides(slant_cosine, powers), surface.reflectance[band],
                                     surface.transmittance[band]);
  }
  return notTold(radiance);
}
