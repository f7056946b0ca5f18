#version 450 core
// (D14) Writes the leaf crossings of each pixel, in any order, and its first wood. first[i + 1] tells where the next
// crossing of pixel i goes, and in the end where those of pixel i + 1 begin.
#include "render/gl/opacity_scan.glsl"
layout(std430, binding = 2) buffer First { uint first[]; };
layout(std430, binding = 3) writeonly buffer Crossings { uvec2 crossings[]; };  // ordered depth, leaf
layout(std430, binding = 4) buffer WoodDepth { uint wood_depth[]; };            // ordered

const uint kWood = 0xffffffffu;

void put(uint pixel, float depth, uint leaf) {
  if (leaf == kWood)
    atomicMin(wood_depth[pixel], ordered(depth));
  else
    crossings[atomicAdd(first[pixel + 1u], 1u)] = uvec2(ordered(depth), leaf);
}

void main() {
  if (triangleNumber() < map_size.z + map_size.w) scanTriangle();
}
