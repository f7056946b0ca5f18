#version 450 core
// Leaves and wood of the trees that are seen.
#include "render/gl/frame.glsl"

layout(location = 0) in vec3 position;  // in the prototype's frame [m]
layout(location = 1) in vec3 stands;    // where the drawn tree stands [m]
layout(location = 2) in uint number;    // of the drawn tree

flat out uvec2 seen;

void main() {
  seen = uvec2(number, uint(gl_VertexID));  // a triangle's last corner is the vertex of its number
  gl_Position = clip_from_world * vec4(position + stands, 1.0);
}
