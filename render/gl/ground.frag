#version 450 core
// (R3) The ground: a Lambertian disc that fades towards its rim.
#include "render/gl/prelude.glsl"
#include "spp/spp_formulas.glsl"
#include "render/gl/frame.glsl"
#include "render/gl/foliage.glsl"
#include "render/gl/compensation.glsl"
#include "render/gl/shading.glsl"

in vec3 place;
out vec4 radiance;

// G of the last leaf that the sunlight on its way here can meet: the place that sends the slab's light down to here.
// 1 where there is none, and no diffuse light either.
float compensationAbove(vec3 here) {
  vec3 at = inMap(here);
  uvec4 range = instances[choice.y].neighbours;
  float nearest = 1e30, compensation = 1.0;
  for (uint n = range.x; n < range.y; ++n) {
    vec3 in_tree = at - neighbours[n].in_map.xyz;
    Nearest near = nearestPixels(in_tree);
    ivec2 pixel = near.pixel + ivec2(greaterThan(near.part, vec2(0.5)));
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(map_size.xy)))) continue;
    int i = pixel.y * int(map_size.x) + pixel.x;
    if (first[i] == first[i + 1]) continue;
    float way = in_tree.z - crossings[first[i + 1] - 1u].depth;
    if (way >= nearest) continue;
    nearest = way;
    compensation = compensationAt(here - neighbours[n].in_space.xyz - way * sun.xyz, uint(neighbours[n].in_space.w));
  }
  return compensation;
}

void main() {
  float from_centre = distance(place.xy, ground.xy) / ground.w;
  if (from_centre >= 1.0) discard;
  float coverage = 1.0 - smoothstep(0.6, 1.0, from_centre);
  Foliage foliage = foliageAt(place, choice.y, kNoLeaf, map_size.z);
  float compensation = choice.x != 0u ? compensationAbove(place) : 1.0;
  Surface surface = opaqueSurface(0u, 0u, ground_albedo.rgb, vec3(0.0, 0.0, 1.0), to_eye.xyz);
  Shaded shaded = shadeByLight(surface, foliage, foliage.before + foliage.beyond, compensation, 0u);
  radiance = vec4((shaded.direct + shaded.single + shaded.multiple) * coverage, coverage);
}
