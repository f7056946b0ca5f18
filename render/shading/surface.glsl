// What all models are made of. This text, a model's and shade.glsl are C++ (the members of a class) and GLSL, in this
// order. Both give them `kinds` and `lights`, arrays of KindOptics and ShadingLight; glossTableNumber() of the gloss_tables
// (R26), modelNumbers(), four at a time, of the model's own; GLOSSY, false where no leaf has a gloss; and the formulas of
// spp and of the gloss. C++ defines Foliage, what stands before and beyond a place in a light, as foliage.glsl does.

Surface leafSurface(uint kind, uint tree, uint leaf, vec3 normal, vec3 to_eye) {
  Surface surface;
  surface.normal = normal;
  surface.to_eye = to_eye;
  surface.reflectance = vec3(kinds[kind].leaf_reflectance);
  surface.transmittance = vec3(kinds[kind].leaf_transmittance);
  surface.roughness = GLOSSY ? kinds[kind].leaf_gloss.w : 0.0f;
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
  surface.roughness = 0.0f;
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
  vec3 radiance;
  vec3 single;  // what of it was scattered once
};
// By a model that does not tell how often (tellsSingle() of render/model.hpp).
Scattered notTold(vec3 radiance) {
  Scattered scattered;
  scattered.radiance = radiance;
  scattered.single = vec3(0.0f);
  return scattered;
}

float toLightCosine(Surface surface, uint light) {
  return -dot(surface.normal, vec3(lights[light].travel));
}

// (R20, R26) The gloss of a leaf, seen along its line of sight.
struct Gloss {
  vec3 intensity;  // per band; what follows is for 1
  vec3 entering;   // what Lambert's law beneath is multiplied by for this line of sight
  float eye;       // cosine of the line of sight to the normal
  float albedo;    // E of it
};
float glossNumber(uint kind, int number) {
  return glossTableNumber(kind * uint(kGlossNumbers) + uint(number));
}
float glossAlbedo(uint kind, float cosine) {
  GlossPlace place = glossAlbedoPlace(cosine);
  return between(glossNumber(kind, place.node), glossNumber(kind, place.node + 1), place.part);
}
Gloss glossSeen(Surface surface) {
  Gloss gloss;
  gloss.intensity = vec3(kinds[surface.kind].leaf_gloss);
  gloss.eye = max(dot(surface.normal, surface.to_eye), 1.0e-6f);
  gloss.albedo = glossAlbedo(surface.kind, gloss.eye);
  gloss.entering = (vec3(1.0f) - gloss.albedo * gloss.intensity) / vec3(kinds[surface.kind].gloss_entering);
  return gloss;
}

// (S7, R20) Radiance towards the eye of direct light of irradiance 1, per band.
vec3 directRadiance(Surface surface, uint light, float visible) {
  float to_light_cosine = toLightCosine(surface, light);
  SidesLight sides = directOnSides(to_light_cosine, visible);
  vec3 radiance;
  for (int band = 0; band < 3; ++band)
    radiance[band] = lambertRadiance(sides, surface.reflectance[band], surface.transmittance[band]);
  if (surface.roughness > 0.0f) {
    Gloss gloss = glossSeen(surface);
    radiance *= gloss.entering * (vec3(1.0f) - glossAlbedo(surface.kind, abs(to_light_cosine)) * gloss.intensity);
    if (to_light_cosine > 0.0f) {
      vec3 half_way = normalize(surface.to_eye - vec3(lights[light].travel));
      float cosine = dot(half_way, surface.normal);
      vec3 across = half_way - cosine * surface.normal;
      float facets = glossFacets(dot(across, across), cosine, surface.roughness);
      radiance += (sides.same * glossBrdf(gloss.eye, max(to_light_cosine, 1.0e-6f), facets, surface.roughness)) *
                  gloss.intensity;
    }
  }
  return radiance;
}

// Powers without the direct light, per band [F].
struct HalvesLight {
  vec3 down;
  vec3 up;
};

// (R26) The upper half's share of what the gloss sends to the eye of light from everywhere.
float glossShare(Surface surface, uint light, float eye, float slant_cosine) {
  float height = 2.0f * eye * slant_cosine + dot(surface.to_eye, vec3(lights[light].travel));
  GlossSharePlace place = glossSharePlace(eye, height, slant_cosine, surface.roughness);
  float of_view[2];
  for (int view = 0; view < 2; ++view) {
    float of_height[2];
    for (int h = 0; h < 2; ++h) {
      int first = kGlossSharesFirst + ((place.view.node + view) * kGlossHeights + place.height.node + h) * kGlossTurns +
                  place.turn.node;
      of_height[h] = between(glossNumber(surface.kind, first), glossNumber(surface.kind, first + 1), place.turn.part);
    }
    of_view[view] = between(of_height[0], of_height[1], place.height.part);
  }
  return between(of_view[0], of_view[1], place.view.part);
}

// (R26, R27) Radiance towards the eye of diffuse light that is uniform over each half of the sphere about the light's
// axis: the integrals S+ and S- of Shinya et al. 2013, Eq. 32, which Lambert's law has in closed form.
vec3 fromHalves(Surface surface, uint light, HalvesLight halves) {
  float slant_cosine = toLightCosine(surface, light);
  vec3 same, other;  // irradiance of both sides
  for (int band = 0; band < 3; ++band) {
    SlabPowers powers;
    powers.down = halves.down[band];
    powers.up = halves.up[band];
    SidesLight sides = halvesOnSides(slant_cosine, powers);
    same[band] = sides.same;
    other[band] = sides.other;
  }
  vec3 reflected = vec3(0.0f), entering = vec3(1.0f);
  if (surface.roughness > 0.0f) {
    Gloss gloss = glossSeen(surface);
    GlossPlace place = glossSlantPlace(slant_cosine), against = glossSlantPlace(-slant_cosine);
    int first = kGlossSlantsFirst;
    float upper = between(glossNumber(surface.kind, first + place.node), glossNumber(surface.kind, first + place.node + 1),
                          place.part);
    float lower = between(glossNumber(surface.kind, first + against.node),
                          glossNumber(surface.kind, first + against.node + 1), against.part);
    same -= 0.5f * gloss.intensity * (upper * halves.down + lower * halves.up);
    other -= 0.5f * gloss.intensity * (lower * halves.down + upper * halves.up);
    float share = glossShare(surface, light, gloss.eye, slant_cosine);
    reflected = (0.15915494309189535f * gloss.albedo) * gloss.intensity *
                (share * halves.down + (1.0f - share) * halves.up);
    entering = gloss.entering;
  }
  vec3 radiance;
  for (int band = 0; band < 3; ++band) {
    SidesLight sides;
    sides.same = same[band];
    sides.other = other[band];
    radiance[band] = lambertRadiance(sides, surface.reflectance[band], surface.transmittance[band]);
  }
  return reflected + entering * radiance;
}
