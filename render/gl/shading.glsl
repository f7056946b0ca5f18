// From the foliage around a place to the radiance that leaves it, by the formulas shared with C++.
layout(binding = 0) uniform sampler3D compensation_texture;  // G [1]; the cells of each tree are a block of their own

// G at a place of the prototype, for a tree of the stand; beyond the outermost cell centres their values go on.
float compensationAt(vec3 place, uint tree) {
  vec3 cell = clamp((place - cell_low.xyz) / cell_low.w, vec3(0.5), cell_count.xyz - 0.5);
  uint across = uint(cell_count.w);
  vec3 block = vec3(tree % across, 0, tree / across) * cell_count.xyz;
  return texture(compensation_texture, (cell + block) / vec3(textureSize(compensation_texture, 0))).r;
}

// Diffuse powers at a place of the equivalent slab, whose normal is the light's axis (mu0 = 1).
SlabPowers diffusePowers(float depth, float thickness, float compensation, float reflectance, float transmittance) {
  if (choice.x == kSingleScattering) return SlabPowers(0.0, 0.0);
  float direct = directPower(depth, 1.0);
  SlabPowers powers = sppPowers(depth, thickness, 1.0, reflectance + transmittance,
                                sphericalLeafForwardShare(reflectance, transmittance));
  if (choice.x == kSppg) powers = compensated(powers, direct, compensation);
  return SlabPowers(max(powers.down - direct, 0.0), max(powers.up, 0.0));
}

// (R3) Radiance per band of a two-sided Lambertian surface in the slab's light. The slab's upward normal points at the
// sun, so that one cosine tells how the surface faces both.
vec3 surfaceRadiance(float to_light_cosine, Foliage foliage, float thickness, float compensation, vec3 reflectance,
                     vec3 transmittance) {
  vec3 radiance;
  for (int band = 0; band < 3; ++band) {
    SlabPowers diffuse =
        diffusePowers(foliage.before, thickness, compensation, leaf_reflectance[band], leaf_transmittance[band]);
    radiance[band] = leafRadiance(to_light_cosine, foliage.visible, to_light_cosine, diffuse, reflectance[band],
                                  transmittance[band]);
  }
  return radiance;
}
