#version 450 core
// (R3) A leaf or a piece of wood as the camera sees it.
#include "render/gl/prelude.glsl"
#include "spp/spp_formulas.glsl"
#include "render/gl/frame.glsl"
#include "render/gl/foliage.glsl"
#include "render/gl/compensation.glsl"
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
  uint tree = instances[instance].neighbours.z;
  float compensation = choice.x != 0u ? compensationAt(place, tree) : 1.0;
  Surface surface =
      wood ? woodSurface(0u, tree, normal, to_eye.xyz) : leafSurface(0u, tree, own_leaf, normal, to_eye.xyz);
  Shaded shaded = shadeByLight(surface, foliage, thickness, compensation, 0u);
  radiance = vec4(shaded.direct + shaded.single + shaded.multiple, 1.0);
}
