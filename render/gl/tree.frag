#version 450 core
// (R3) A leaf or a piece of wood as the camera sees it.
#include "render/gl/prelude.glsl"
#include "spp/spp_formulas.glsl"
#include "render/gl/frame.glsl"
#include "render/gl/foliage.glsl"
#include "render/gl/shading.glsl"

in vec3 place;
flat in vec3 face_normal;
flat in uint own_leaf;
flat in uint instance;
out vec4 radiance;

void main() {
  vec3 normal = dot(face_normal, to_eye.xyz) < 0.0 ? -face_normal : face_normal;
  float to_light_cosine = -dot(normal, sun.xyz);
  bool wood = own_leaf == kNoLeaf;
  Foliage foliage = foliageAt(place, instance, own_leaf, woodBias(wood ? to_light_cosine : 1.0));
  // A leaf is itself a part of the slab's thickness.
  float thickness = foliage.before + foliage.beyond + (wood ? 0.0 : 1.0);
  float compensation = choice.x == kSppg ? compensationAt(place, instances[instance].neighbours.z) : 1.0;
  vec3 reflectance = wood ? wood_reflectance.rgb : leaf_reflectance.rgb;
  vec3 transmittance = wood ? vec3(0.0) : leaf_transmittance.rgb;
  radiance = vec4(
      surfaceRadiance(to_light_cosine, foliage, thickness, compensation, reflectance, transmittance), 1.0);
}
