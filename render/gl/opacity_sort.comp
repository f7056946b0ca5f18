#version 450 core
// (D14) Sorts the crossings of each pixel by depth, of equal depths by leaf, turns ordered numbers into depths, and tells
// each pixel's line.
layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer First { uint first[]; };
layout(std430, binding = 3) buffer Crossings { uvec2 crossings[]; };  // ordered depth, leaf; then depth, leaf
layout(std430, binding = 4) readonly buffer WoodDepth { uint wood_depth[]; };  // ordered
layout(std430, binding = 5) writeonly buffer Lines { uint lines[]; };          // see OpacityMap
layout(location = 0) uniform uint pixels;

uint depthBits(uint ordered) { return (ordered >> 31) != 0u ? ordered ^ 0x80000000u : ~ordered; }

bool before(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

// Shell's sort with the gaps of Ciura 2001: in place, and on the few crossings that most pixels have an insertion sort.
const uint kGaps[9] = uint[9](1750u, 701u, 301u, 132u, 57u, 23u, 10u, 4u, 1u);

void main() {
  uint pixel = gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x;
  if (pixel >= pixels) return;
  uint begin = first[pixel], count = first[pixel + 1u] - begin;
  for (int g = 0; g < 9; ++g) {
    uint gap = kGaps[g];
    for (uint i = gap; i < count; ++i) {
      uvec2 crossing = crossings[begin + i];
      uint to = i;
      for (; to >= gap; to -= gap) {
        uvec2 other = crossings[begin + to - gap];
        if (!before(crossing, other)) break;
        crossings[begin + to] = other;
      }
      crossings[begin + to] = crossing;
    }
  }
  for (uint i = 0u; i < count; ++i) crossings[begin + i].x = depthBits(crossings[begin + i].x);
  lines[3u * pixel] = begin;
  lines[3u * pixel + 1u] = begin + count;
  lines[3u * pixel + 2u] = depthBits(wood_depth[pixel]);
}
