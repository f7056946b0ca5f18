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

#ifdef FIELD
layout(binding = 10) uniform usamplerBuffer field_places;  // of each triangle, as `triangles`
layout(binding = 11) uniform samplerBuffer field_light;    // irradiance of the front and the back of each place
#endif

layout(location = 0) out vec4 total;  // rgb: radiance; a: coverage by trees and ground
#ifdef LAYERS
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 single;
layout(location = 3) out vec4 multiple;
layout(location = 4) out vec4 of_sky;
layout(location = 5) out vec4 geometry;  // xyz: normal; w: distance along the middle line of sight [m]
layout(location = 6) out vec4 foliage_of_light;  // n+, n-, visible, G
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

// Sums over the lights.
Shaded light_sum = Shaded(vec3(0.0), vec3(0.0), vec3(0.0));
vec3 sky_sum = vec3(0.0);
void addLight(Shaded shaded, uint light, Foliage foliage, float compensation) {
  light_sum.direct += shaded.direct;
  light_sum.single += shaded.single;
  light_sum.multiple += shaded.multiple;
#ifdef LAYERS
  if (light == counts.z) foliage_of_light = vec4(foliage.before, foliage.beyond, foliage.visible, compensation);
#endif
}

void addSky(Surface surface, vec3 radiance) {
  Shaded shaded = shadeBySky(surface, radiance);
  sky_sum = shaded.direct + shaded.single + shaded.multiple;
}

#ifdef FIELD
void addField(Surface surface, int place, bool front) {
  int same = 2 * place + (front ? 0 : 1), other = 2 * place + (front ? 1 : 0);
  light_sum.multiple +=
      shadeBySides(surface, texelFetch(field_light, same).rgb, texelFetch(field_light, other).rgb).multiple;
}
#endif

void shadeTree(uvec2 id, Sight look) {
  vec3 stands_here = drawn[id.x].position;
  uint tree = id.x % counts.y;
  uint kind = kindOf(tree);
  int triangle = 2 * int(kind_frames[kind].cell_count.w + id.y);
  vec4 plane = uintBitsToFloat(texelFetch(triangles, triangle));
  uvec4 of_piece = texelFetch(triangles, triangle + 1);
  float enlargement = length(plane.xyz);
  vec3 normal = plane.xyz / enlargement;
  vec3 from = look.from - stands_here;
  float away = (plane.w - dot(normal, from)) / dot(normal, look.along);
  vec3 place = from + away * look.along;
  bool front = dot(normal, look.along) <= 0.0;
  if (!front) normal = -normal;

  bool wood = of_piece.w >= kThinWood;
  uint leaf = wood ? kNoLeaf : of_piece.w;
  vec3 middle = uintBitsToFloat(of_piece.xyz);
  float error = of_piece.w == kNoLeaf ? middle.x : 0.0;
  // The light is that of the true leaf or twig, however enlarged it is drawn.
  vec3 lit = of_piece.w == kNoLeaf ? place : middle + (place - middle) / enlargement;
  Surface surface = wood ? woodSurface(kind, tree, normal, -look.along)
                         : leafSurface(kind, tree, leaf, normal, -look.along);
  for (uint light = 0u; light < LIGHTS; ++light) {
    float bias = woodBias(wood ? dot(normal, light_frames[light].travel.xyz) : 1.0);
    Foliage foliage = foliageAt(light, lit, trees[tree].position.xyz, tree, leaf, vec2(bias, error));
    // A leaf is itself a part of the slab's thickness.
    float thickness = foliage.before + foliage.beyond + (wood ? 0.0 : 1.0);
    float compensation = NEEDS_COMPENSATION ? compensationAt(lit, tree, light) : 1.0;
    addLight(shadeByLight(surface, foliage, thickness, compensation, light), light, foliage, compensation);
  }
#ifdef FIELD
  // Wood has light outside alone, whichever way pieces of it that stand for more are turned.
  if (trees[tree].kind.z != kNone)
    addField(surface, int(trees[tree].kind.z / 2u + texelFetch(field_places, triangle / 2).r), front || wood);
#else
  if (counts.w > 0u) addSky(surface, skyLightAt(lit, tree));
#endif
#ifdef LAYERS
  geometry = vec4(normal, dot(away * look.along, sight.xyz));
  ids = uvec4(id, kind, leaf);
#endif
}

// The last leaf that light on its way to a place of the ground can meet: what sends the slab's light down to here.
struct LastLeaf {
  uint tree;   // kNone: there is no leaf
  vec3 place;  // in the tree's frame [m]
};
LastLeaf lastLeaf(uint light, vec3 here) {
  LastLeaf last = LastLeaf(kNone, vec3(0.0));
  float nearest = 1e30;
  uvec2 casters = castersAt(light, here);
  for (uint c = casters.x; c < casters.y; ++c) {
    Caster caster = casterAt(c);
    MapFrame map = map_frames[4u * kindOf(caster.tree) + light];
    vec3 in_tree = inLight(light, here - caster.position) + map.origin.xyz;
    Nearest near = nearestPixels(map, in_tree);
    ivec2 pixel = near.pixel + ivec2(greaterThan(near.part, vec2(0.5)));
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(map.size.xy)))) continue;
    uvec3 line = texelFetch(map_lines, int(map.size.z) + pixel.y * int(map.size.x) + pixel.x).xyz;
    if (line.x == line.y) continue;
    float way = in_tree.z - uintBitsToFloat(texelFetch(map_crossings, int(map.size.w + line.y) - 1).x);
    if (way >= nearest) continue;
    nearest = way;
    last = LastLeaf(caster.tree, here - caster.position - way * light_frames[light].travel.xyz);
  }
  return last;
}

const float kPi = 3.14159265;

// (D12) What a place of the ground receives of the sky: beyond the cells it lies open.
vec3 skyOnGround(vec2 here) {
  vec2 at = (here - ground_cells.xy) * ground_cells.zw;
  bool told = ground_open.w > 0.0 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0)));
  return told ? textureLod(ground_sky, at, 0.0).rgb : ground_open.rgb;
}

// (R3) The ground: a Lambertian disc that fades towards its rim; under a sky it goes on to the horizon. Gives its
// coverage.
float shadeGround(Sight look) {
  if (ground_albedo.w == 0.0 || look.along.z >= 0.0) return 0.0;
  float away = (ground.z - look.from.z) / look.along.z;
  vec3 place = look.from + away * look.along;
  float from_centre = blocks.y > 0u ? 0.0 : distance(place.xy, ground.xy) / ground.w;
  if (from_centre >= 1.0 || (eye.w > 0.0 && away <= 0.0)) return 0.0;
  vec3 here = place;
  if (period.x > 0.0) here.xy -= floor((here.xy - period.zw) / period.xy) * period.xy;
  for (uint light = 0u; light < LIGHTS; ++light) {
    Foliage foliage = foliageAt(light, here, vec3(0.0), kNone, kNoLeaf, vec2(1.0, 0.0));
    LastLeaf last = lastLeaf(light, here);
    float compensation =
        NEEDS_COMPENSATION && last.tree != kNone ? compensationAt(last.place, last.tree, light) : 1.0;
    uint kind = last.tree == kNone ? 0u : kindOf(last.tree);
    Surface surface = opaqueSurface(kind, kNone, ground_albedo.rgb, vec3(0.0, 0.0, 1.0), -look.along);
    addLight(shadeByLight(surface, foliage, foliage.before + foliage.beyond, compensation, light), light, foliage,
             compensation);
  }
  if (blocks.y > 0u)
    addSky(opaqueSurface(0u, kNone, ground_albedo.rgb, vec3(0.0, 0.0, 1.0), -look.along), skyOnGround(here.xy) / kPi);
#ifdef LAYERS
  geometry = vec4(0.0, 0.0, 1.0, dot(away * look.along, sight.xyz));
  ids = uvec4(kGround, kNone, kNone, kNoLeaf);
#endif
  return 1.0 - smoothstep(0.6, 1.0, from_centre);
}

vec3 skyTowards(vec3 to_sky) {
  if (blocks.y == 0u || to_sky.z <= 0.0) return vec3(0.0);
  vec2 rows_columns = vec2(blocks.yz);
  float row = acos(min(to_sky.z, 1.0)) / (0.5 * kPi) * rows_columns.x;
  float turn = (atan(to_sky.y, to_sky.x) - sky_azimuth.x) / (2.0 * kPi);
  float column = (turn - floor(turn)) * rows_columns.y;
  return texelFetch(sky_radiance, min(ivec2(column, row), ivec2(blocks.zy) - 1), 0).rgb;
}

void main() {
#ifdef LAYERS
  geometry = vec4(0.0, 0.0, 0.0, uintBitsToFloat(0x7f800000u));
  foliage_of_light = vec4(0.0);
  ids = uvec4(kNone, kNone, kNone, kNoLeaf);
#endif
  Sight look = sightThrough(gl_FragCoord.xy + vec2(pixel_right.w, pixel_up.w));
  uvec2 id = texelFetch(visible, ivec2(gl_FragCoord.xy), 0).xy;
  float coverage = 1.0;
  vec3 behind = vec3(0.0);
  if (id.x < kGround) {
    shadeTree(id, look);
  } else {
    coverage = shadeGround(look);
    behind = skyTowards(look.along);
  }
  vec3 of_lights = light_sum.direct + light_sum.single + light_sum.multiple;
  total = vec4(coverage * (of_lights + sky_sum) + (1.0 - coverage) * behind, coverage);
#ifdef LAYERS
  direct = vec4(coverage * light_sum.direct, coverage);
  single = vec4(coverage * light_sum.single, coverage);
  multiple = vec4(coverage * light_sum.multiple, coverage);
  of_sky = vec4(coverage * sky_sum + (1.0 - coverage) * behind, coverage);
#endif
}
