#version 450 core
// A square around the ground's disc, as a strip of two triangles.
#include "render/gl/frame.glsl"

out vec3 place;  // [m]

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  place = ground.xyz + vec3(corner * ground.w, 0.0);
  gl_Position = clip_from_world * vec4(place, 1.0);
}
