// What all models are made of. This text, a model's and shade.glsl are C++ (the members of a class) and GLSL, in this
// order. Both give them `kinds` and `lights`, arrays of KindOptics and ShadingLight; glossTableNumber() of the gloss_tables
// (R26), modelNumbers(), four at a time, of the model's own, leafNumbers() of the leaves' maps; GLOSSY and MAPPED, false
// where no leaf has a gloss or maps; and the formulas of spp and of the gloss. C++ defines Foliage, what stands before and
// beyond a place in a light, as foliage.glsl does.

// (R37) Where a point of a leaf's images is in the maps of its kind, full size or coarser.
//   at      u to the right and v up [1]; images repeat
//   places  of the full size, that a pixel shows [1], >= 0: what is drawn is the mean of about as many
uint leafPlace(uint kind, vec2 at, float places) {
  uvec2 size = uvec2(kinds[kind].maps.x, kinds[kind].maps.y);
  if (size.x == 0u) return kNoLeafPlace;
  uint first = kinds[kind].maps.z;
  vec2 within = vec2(at.x, 1.0f - at.y);
  within -= floor(within);
  uint x = min(uint(within.x * float(size.x)), size.x - 1u);
  uint y = min(uint(within.y * float(size.y)), size.y - 1u);
  float left = places;
  while (left >= 2.0f && (size.x > 1u || size.y > 1u)) {
    first += size.x * size.y;
    size = uvec2((size.x + 1u) / 2u, (size.y + 1u) / 2u);
    x = x / 2u;
    y = y / 2u;
    left = left * 0.25f;
  }
  return first + y * size.x + x;
}

//   place  of the maps, or kNoLeafPlace
//   front  whether the eye sees the upper side, about which the corners of the triangle turn counter-clockwise
Surface leafSurface(uint kind, uint place, bool front, uint tree, uint leaf, vec3 normal, vec3 to_eye) {
  vec4 transmittance = kinds[kind].leaf_transmittance, reflectance = kinds[kind].leaf_reflectance;
  vec4 gloss = kinds[kind].leaf_gloss, beyond = gloss;
  if (MAPPED && place != kNoLeafPlace) {
    uint seen = front ? 1u : 3u, other = 4u - seen;
    transmittance = leafNumbers(kind, place, 0u);
    reflectance = leafNumbers(kind, place, seen);
    if (GLOSSY) {
      gloss = leafNumbers(kind, place, seen + 1u);
      beyond = leafNumbers(kind, place, other + 1u);
    }
  }
  Surface surface;
  surface.normal = normal;
  surface.to_eye = to_eye;
  surface.reflectance = vec3(reflectance);
  surface.transmittance = vec3(transmittance);
  surface.roughness = GLOSSY ? reflectance.w : 0.0f;
  surface.gloss = vec3(gloss);
  surface.gloss_beyond = vec3(beyond);
  surface.gloss_table = kinds[kind].maps.w + uint(gloss.w);
  surface.gloss_table_beyond = kinds[kind].maps.w + uint(beyond.w);
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
  surface.gloss = vec3(0.0f);
  surface.gloss_beyond = vec3(0.0f);
  surface.gloss_table = 0u;
  surface.gloss_table_beyond = 0u;
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

// (R20, R26, R37) The gloss of a leaf, seen along its line of sight. What Lambert's law beneath is multiplied by for this
// line of sight and light that has come in through the eye's side or through the other.
struct Gloss {
  vec3 entering;
  vec3 passing;
  vec3 let_in;         // mean share that the eye's side lets in
  vec3 let_in_beyond;  // and that the other does
  float eye;           // cosine of the line of sight to the normal
  float albedo;        // E of it, for intensity 1
};
float glossNumber(uint table, int number) {
  return glossTableNumber(table * uint(kGlossNumbers) + uint(number));
}
float glossAlbedo(uint table, float cosine) {
  GlossPlace place = glossAlbedoPlace(cosine);
  return between(glossNumber(table, place.node), glossNumber(table, place.node + 1), place.part);
}
vec3 glossLetsIn(uint table, vec3 intensity) {
  return max(vec3(1.0f) - intensity * glossNumber(table, kGlossMeanAlbedo), vec3(1.0e-6f));
}
Gloss glossSeen(Surface surface) {
  Gloss gloss;
  gloss.eye = max(dot(surface.normal, surface.to_eye), 1.0e-6f);
  gloss.albedo = glossAlbedo(surface.gloss_table, gloss.eye);
  gloss.let_in = glossLetsIn(surface.gloss_table, surface.gloss);
  gloss.let_in_beyond = glossLetsIn(surface.gloss_table_beyond, surface.gloss_beyond);
  vec3 out_again = vec3(1.0f) - gloss.albedo * surface.gloss;
  gloss.entering = out_again / gloss.let_in;
  gloss.passing = out_again / max(gloss.let_in, gloss.let_in_beyond);
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
    bool same = to_light_cosine > 0.0f;
    float lost = glossAlbedo(same ? surface.gloss_table : surface.gloss_table_beyond, abs(to_light_cosine));
    radiance *= (same ? gloss.entering : gloss.passing) *
                (vec3(1.0f) - lost * (same ? surface.gloss : surface.gloss_beyond));
    if (same) {
      vec3 half_way = normalize(surface.to_eye - vec3(lights[light].travel));
      float cosine = dot(half_way, surface.normal);
      vec3 across = half_way - cosine * surface.normal;
      float facets = glossFacets(dot(across, across), cosine, surface.roughness);
      radiance += (sides.same * glossBrdf(gloss.eye, max(to_light_cosine, 1.0e-6f), facets, surface.roughness)) *
                  surface.gloss;
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
      of_height[h] = between(glossNumber(surface.gloss_table, first), glossNumber(surface.gloss_table, first + 1),
                             place.turn.part);
    }
    of_view[view] = between(of_height[0], of_height[1], place.height.part);
  }
  return between(of_view[0], of_view[1], place.view.part);
}

// (R26) A: the share, for intensity 1, of what the gloss reflects of light from the half of the sphere to whose axis its
// normal has this cosine.
float glossOfHalf(uint table, float slant_cosine) {
  GlossPlace place = glossSlantPlace(slant_cosine);
  int first = kGlossSlantsFirst + place.node;
  return between(glossNumber(table, first), glossNumber(table, first + 1), place.part);
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
  vec3 reflected = vec3(0.0f);
  if (surface.roughness > 0.0f) {
    Gloss gloss = glossSeen(surface);
    float upper = glossOfHalf(surface.gloss_table, slant_cosine), lower = glossOfHalf(surface.gloss_table, -slant_cosine);
    same -= 0.5f * surface.gloss * (upper * halves.down + lower * halves.up);
    upper = glossOfHalf(surface.gloss_table_beyond, slant_cosine);
    lower = glossOfHalf(surface.gloss_table_beyond, -slant_cosine);
    other -= 0.5f * surface.gloss_beyond * (lower * halves.down + upper * halves.up);
    float share = glossShare(surface, light, gloss.eye, slant_cosine);
    reflected = (0.15915494309189535f * gloss.albedo) * surface.gloss *
                (share * halves.down + (1.0f - share) * halves.up);
    same *= gloss.entering;
    other *= gloss.passing;
  }
  vec3 radiance;
  for (int band = 0; band < 3; ++band) {
    SidesLight sides;
    sides.same = same[band];
    sides.other = other[band];
    radiance[band] = lambertRadiance(sides, surface.reflectance[band], surface.transmittance[band]);
  }
  return reflected + radiance;
}
