#version 450 core
// Leaves and wood of every tree of the stand.
#include "render/gl/frame.glsl"

layout(location = 0) in vec3 position;  // in the prototype's frame [m]
layout(location = 1) in uint leaf;      // kNoLeaf for wood
layout(location = 2) in vec3 normal;    // of the triangle

out vec3 place;
flat out vec3 face_normal;
flat out uint own_leaf;
flat out uint instance;
invariant gl_Position;  // the depth pass and the shading pass must meet in the same depths

void main() {
  place = position;
  face_normal = normal;
  own_leaf = leaf;
  instance = uint(gl_InstanceID);
  gl_Position = clip_from_world * vec4(position + instances[gl_InstanceID].position.xyz, 1.0);
}
