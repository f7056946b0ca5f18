#version 450 core
// (R24) Every pixel once: which triangle it shows is known, where its line of sight meets it follows.
#include "render/gl/prelude.glsl"
#include "spp/spp_formulas.glsl"
#include "render/gl/frame.glsl"
#include "render/gl/foliage.glsl"
#include "render/gl/cells.glsl"
#include "render/gl/shading.glsl"

layout(binding = 6) uniform usampler2D visible;
layout(binding = 7) uniform usamplerBuffer triangles;  // two texels of bits for each: see tree_levels.hpp
layout(binding = 8) uniform sampler2D sky_radiance;   // rows from the zenith down [1/sr]
layout(binding = 9) uniform sampler2D ground_sky;     // irradiance of the ground by the sky, per band [1]

#ifdef MAPS
layout(binding = 17) uniform samplerBuffer image_maps;  // two texels of each triangle of kinds with maps: u, v
#endif

#ifdef FIELD
layout(binding = 14) uniform usamplerBuffer field_places;  // of each triangle, as `triangles`
layout(binding = 15) uniform samplerBuffer field_light;    // irradiance of the front and the back of each place
#endif

layout(location = 0) out vec4 total;  // rgb: radiance; a: coverage by trees and ground
#ifdef LAYERS
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 single;
layout(location = 3) out vec4 multiple;
layout(location = 4) out vec4 of_sky;
layout(location = 5) out vec4 geometry;  // xyz: normal; w: distance along the middle line of sight [m]
layout(location = 6) out vec4 foliage_of_light;  // n+, n-, visible, G of the first light
layout(location = 7) out uvec4 ids;              // drawn tree, triangle, kind, leaf
#endif

const uint kThinWood = kNoLeaf - 1u;

struct Sight {
  vec3 from;
  vec3 along;
};
Sight sightThrough(vec2 pixel) {
  vec3 aside = corner.xyz + pixel.x * pixel_right.xyz + pixel.y * pixel_up.xyz;
  return eye.w > 0.0 ? Sight(eye.xyz, normalize(aside)) : Sight(eye.xyz + aside, sight.xyz);
}

// What a pixel shows. Leaves, wood and ground go the same way from here, as far as graphics cards that take every way
// for every pixel, and mask what does not hold, would else do all twice.
struct Place {
  vec3 lit;       // whose light it has, from `stands`: of a leaf or twig the true one's, however enlarged it is drawn [m]
  vec3 stands;    // its tree in the stand's own period; 0 for the ground [m]
  uint number;    // of the tree; kNone for the ground
  bool is_leaf;
  bool front;     // whether the side that is seen is the one that its triangle is wound about; of wood always
  float error;    // how far its wood may lie from the full tree's [m]
  float away;     // from the line of sight's start [m]
  float coverage; // 0 where there is nothing
  Surface surface;
};

// (R37) What of the maps a pixel shows of a leaf.
//   there   in the prototype's frame [m]
//   away    from the line of sight's start [m]
//   cosine  of the line of sight to the leaf's normal
uint placeInMaps(uint kind, uint triangle, vec3 there, Sight look, float away, float cosine) {
  uint place = kNoLeafPlace;
#ifdef MAPS
  uint first = kind_frames[kind].images.x;
  // Leaves that differ by side alone need no images.
  if (kinds[kind].maps.x == 1u && kinds[kind].maps.y == 1u) place = leafPlace(kind, vec2(0.0), 1.0);
  else if (first != 0u) {
    int texel = 2 * int(first - 1u + triangle);
    vec4 u = texelFetch(image_maps, texel), v = texelFetch(image_maps, texel + 1);
    float side = length(pixel_right.xyz);  // of the pixel there [m]
    if (eye.w > 0.0) side *= away * dot(look.along, sight.xyz) / dot(corner.xyz, sight.xyz);
    float images = side * side / max(abs(cosine), 1.0e-3) * length(cross(u.xyz, v.xyz));
    vec2 at = vec2(dot(u.xyz, there) + u.w, dot(v.xyz, there) + v.w);
    if (dot(u.xyz, u.xyz) > 0.0) place = leafPlace(kind, at, images * float(kinds[kind].maps.x * kinds[kind].maps.y));
  }
#endif
  return place;
}

Place placeOnTree(uint triangle, Standing stands, Tree tree, Sight look) {
  int texel = 2 * int(kind_frames[tree.kind].cell_count.w + triangle);
  vec4 plane = uintBitsToFloat(texelFetch(triangles, texel));
  uvec4 of_piece = texelFetch(triangles, texel + 1);
  float enlargement = length(plane.xyz);
  vec3 normal = plane.xyz / enlargement;
  vec3 from = look.from - stands.position;
  float slant = dot(normal, look.along), away = (plane.w - dot(normal, from)) / slant;
  vec3 there = from + away * look.along, middle = uintBitsToFloat(of_piece.xyz);
  bool whole = of_piece.w == kNoLeaf, is_leaf = of_piece.w < kThinWood;

  Place place;
  place.lit = whole ? there : middle + (there - middle) / enlargement;
  place.stands = tree.position;
  place.number = stands.tree;
  place.is_leaf = is_leaf;
  place.front = slant <= 0.0 || !is_leaf;  // wood has light outside alone, however simplified pieces are turned
  place.error = whole ? middle.x : 0.0;
  place.away = away;
  place.coverage = 1.0;
  if (slant > 0.0) normal = -normal;
  uint shown = kNoLeafPlace;
  if (is_leaf) shown = placeInMaps(tree.kind, triangle, there, look, away, slant);
  place.surface = leafSurface(tree.kind, shown, slant <= 0.0, stands.tree, of_piece.w, normal, -look.along);
  if (!is_leaf) place.surface = woodSurface(tree.kind, stands.tree, normal, -look.along);
  return place;
}

// (R3) The ground: a Lambertian disc that fades towards its rim; under a sky it goes on to the horizon.
Place placeOnGround(Sight look) {
  Place place;
  place.away = (ground.z - look.from.z) / look.along.z;
  vec3 there = look.from + place.away * look.along;
  float from_centre = hasSky() ? 0.0 : distance(there.xy, ground.xy) / ground.w;
  bool seen = ground_albedo.w > 0.0 && look.along.z < 0.0 && from_centre < 1.0 && (eye.w == 0.0 || place.away > 0.0);
  place.coverage = seen ? 1.0 - smoothstep(0.6, 1.0, from_centre) : 0.0;
  place.lit = seen ? there : ground.xyz;
  if (period.x > 0.0) place.lit.xy -= floor((place.lit.xy - period.zw) / period.xy) * period.xy;
  place.stands = vec3(0.0);
  place.number = kNone;
  place.is_leaf = false;
  place.front = true;
  place.error = 0.0;
  place.surface = opaqueSurface(0u, kNone, ground_albedo.rgb, vec3(0.0, 0.0, 1.0), -look.along);
  return place;
}

// (D12) Mean radiance of the sky's light on a place of the ground: beyond the cells it lies open.
const float kPi = 3.14159265;
vec3 skyOnGround(vec2 here) {
  vec2 at = (here - ground_cells.xy) * ground_cells.zw;
  bool told = ground_open.w > 0.0 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0)));
  vec3 in_cells = textureLod(ground_sky, at, 0.0).rgb;
  return (told ? in_cells : ground_open.rgb) / kPi;
}

vec3 skyTowards(vec3 to_sky) {
  if (!hasSky() || to_sky.z <= 0.0) return vec3(0.0);
  vec2 rows_columns = vec2(counts.yz);
  float row = acos(min(to_sky.z, 1.0)) / (0.5 * kPi) * rows_columns.x;
  float turn = (atan(to_sky.y, to_sky.x) - sky_azimuth.x) / (2.0 * kPi);
  float column = (turn - floor(turn)) * rows_columns.y;
  return texelFetch(sky_radiance, min(ivec2(column, row), ivec2(counts.zy) - 1), 0).rgb;
}

#ifdef FIELD
// (F26) What a leaf or wood sends of the light field.
vec3 byField(Place place, Tree tree, uint triangle) {
  if (tree.field == 0u) return vec3(0.0);
  int number = int(kind_frames[tree.kind].cell_count.w + triangle) + (tree.far ? textureSize(field_places) / 2 : 0);
  int at = 2 * int(tree.field - 1u + texelFetch(field_places, number).r), seen = place.front ? at : at + 1;
  return shadeBySides(place.surface, texelFetch(field_light, seen).rgb,
                      texelFetch(field_light, place.front ? at + 1 : at).rgb).scattered;
}

// (F31) Irradiance of a place of the ground by what trees scatter, between the middles of its cells. Beyond these, where
// the ground goes on, there is none: it fades over the outermost two.
vec3 fieldOnGround(vec2 here) {
  vec2 size = sky_azimuth.yz, at = (here - ground_cells.xy) * ground_cells.zw * size;
  if (counts.w == 0u || any(lessThan(at, vec2(0.0))) || any(greaterThan(at, size))) return vec3(0.0);
  vec2 low = floor(at - 0.5), part = at - 0.5 - low, inside = 0.5 * min(at, size - at);
  float fading = period.x > 0.0 ? 1.0 : min(min(inside.x, inside.y), 1.0);
  vec3 sum = vec3(0.0);
  for (int corner_number = 0; corner_number < 4; ++corner_number) {
    vec2 one = vec2(corner_number & 1, corner_number >> 1), cell = low + one;
    vec2 share = mix(1.0 - part, part, one);
    cell = period.x > 0.0 ? cell - floor(cell / size) * size : clamp(cell, vec2(0.0), size - 1.0);
    sum += share.x * share.y * texelFetch(field_light, int(counts.w) - 1 + int(cell.y) * int(size.x) + int(cell.x)).rgb;
  }
  return fading * sum;
}
#endif

void main() {
  Sight look = sightThrough(gl_FragCoord.xy + vec2(pixel_right.w, pixel_up.w));
  uvec2 id = texelFetch(visible, ivec2(gl_FragCoord.xy), 0).xy;
  bool of_tree = id.x < kGround;
  Standing stands = standingAt(texelFetch(drawn, int(of_tree ? id.x : 0u)));
  Tree tree = treeAt(stands.tree);
  Place place = placeOnGround(look);
  if (of_tree) place = placeOnTree(id.y, stands, tree, look);

  Shaded sum = Shaded(vec3(0.0), vec3(0.0), vec3(0.0));
  vec4 of_light = vec4(0.0);
  for (uint light = 0u; light < LIGHTS; ++light) {
    float cosine = dot(place.surface.normal, light_frames[light].travel.xyz);
    float bias = woodBias(of_tree && !place.is_leaf ? cosine : 1.0);
    LastLeaf last;
    Foliage foliage = foliageAt(light, place.lit, place.stands, place.number, place.surface.leaf,
                                vec2(bias, place.error), last);
    vec3 in_tree = place.lit;
    bool in_foliage = true;
    // The ground has the light of the last leaves above it.
    if (!of_tree) {
      in_foliage = last.way < 1e30;
      in_tree -= last.stands.position + last.way * light_frames[light].travel.xyz;
      tree = treeAt(in_foliage ? last.stands.tree : 0u);
      place.surface.kind = in_foliage ? tree.kind : 0u;
    }
    float compensation = NEEDS_COMPENSATION && in_foliage ? compensationAt(in_tree, tree, light) : 1.0;
    // A leaf is itself a part of the slab's thickness.
    float thickness = foliage.before + foliage.beyond + (place.is_leaf ? 1.0 : 0.0);
    Shaded shaded = shadeByLight(place.surface, foliage, thickness, compensation, light);
    sum.direct += shaded.direct;
    sum.scattered += shaded.scattered;
    sum.single += shaded.single;
    if (light == 0u) of_light = vec4(foliage.before, foliage.beyond, foliage.visible, compensation);
  }
#ifdef FIELD
  if (of_tree) sum.scattered += byField(place, tree, id.y);
  if (!of_tree && place.coverage > 0.0) sum.scattered += ground_albedo.rgb * fieldOnGround(place.lit.xy) / kPi;
#endif
  vec3 sky_sum = vec3(0.0), behind = vec3(0.0);
#ifndef NO_SKY
  vec3 sky = hasSky() ? skyOnGround(place.lit.xy) : vec3(0.0);
#ifdef FIELD
  if (of_tree) sky = vec3(0.0);  // the field holds it
#else
  if (of_tree) sky = skyLightAt(place.lit, tree);
#endif
  Shaded by_sky = shadeBySky(place.surface, sky);
  sky_sum = by_sky.direct + by_sky.scattered;
  behind = skyTowards(look.along);
#endif
  float coverage = place.coverage;
  vec3 seen = sum.direct + sum.scattered + sky_sum;
  total = coverage > 0.0 ? vec4(coverage * seen + (1.0 - coverage) * behind, coverage) : vec4(behind, 0.0);
#ifdef LAYERS
  bool nothing = coverage == 0.0;
  float depth = dot(place.away * look.along, sight.xyz);
  geometry = nothing ? vec4(0.0, 0.0, 0.0, uintBitsToFloat(0x7f800000u)) : vec4(place.surface.normal, depth);
  foliage_of_light = nothing ? vec4(0.0) : of_light;
  ids = of_tree ? uvec4(id, tree.kind, place.surface.leaf) : uvec4(nothing ? kNone : kGround, kNone, kNone, kNoLeaf);
  direct = nothing ? vec4(0.0) : vec4(coverage * sum.direct, coverage);
  single = nothing ? vec4(0.0) : vec4(coverage * sum.single, coverage);
  multiple = nothing ? vec4(0.0) : vec4(coverage * max(sum.scattered - sum.single, 0.0), coverage);
  of_sky = nothing ? vec4(behind, 0.0) : vec4(coverage * sky_sum + (1.0 - coverage) * behind, coverage);
#endif
}
