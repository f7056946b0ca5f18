#version 450 core
// (D14) How many leaf crossings each pixel has: that of pixel i is added to first[i + 1].
#include "render/gl/opacity_scan.glsl"
layout(std430, binding = 2) buffer First { uint first[]; };

void put(uint pixel, float depth, uint leaf) { atomicAdd(first[pixel + 1u], 1u); }

void main() {
  if (triangleNumber() < map_size.z) scanTriangle();
}
