// What all stages of a picture read. The C++ side is detail/frame_data.hpp; both change together.
struct LightFrame {
  vec4 right;       // xyz: right across the light; w: its light grid's corner along right  [m]
  vec4 up;          // xyz: up across the light; w: the corner along up                     [m]
  vec4 travel;      // xyz: unit vector along which the light travels; w: cells of the grid per metre
  uvec4 grid;       // x, y: cells; z: number of the first in light_cells
};
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_world;
  vec4 eye;           // xyz: the eye, or for parallel lines of sight the middle of the picture [m]; w: 1 in perspective
  vec4 sight;         // xyz: direction of sight of the middle
  vec4 corner;        // xyz: from `eye` to where the picture's lower left corner is seen; zw of right: see there [m]
  vec4 pixel_right;   // xyz: one pixel to the right [m]; w: the target's corner in the picture, from the left [pixel]
  vec4 pixel_up;      // xyz: one pixel up; w: the same from below
  vec4 ground;        // xyz: centre of the ground's disc; w: its radius                    [m]
  vec4 ground_albedo; // rgb: per band; w: 1 where the ground is drawn
  vec4 period;        // xy: side lengths, 0: none; zw: where the period begins              [m]
  vec4 sky_azimuth;   // x: where the sky's first column begins [rad]; yz: cells of the ground
  vec4 ground_cells;  // xy: corner of the cells in which the ground's light is told [m]; zw: 1 / extent [1/m]
  vec4 ground_open;   // rgb: irradiance of open ground by the sky [1]; w: 1 where cells are told
  vec4 cell_part;     // xyz: 1 / cells of the texture that holds those of all trees
  uvec4 counts;       // x: lights; y, z: rows and columns of the sky, 0: none; w: see FieldTexture::ground()
  LightFrame light_frames[4];
};

bool hasSky() { return counts.y > 0u; }

// What is the same for all pixels, and compilers then know: LIGHTS where there is one light, ONE_KIND, NO_SKY.
#ifndef LIGHTS
#define LIGHTS counts.x
#endif

// A kind of trees.
struct KindFrame {
  vec4 cell_low;    // xyz: corner of its cells [m]; w: cells per metre
  uvec4 cell_count; // xyz: cells; w: number of its first triangle
  uvec4 images;     // x: see ImageMapTexture::first()
};
const uint kMostKinds = 64u;
layout(std140, binding = 2) uniform KindFrames { KindFrame kind_frames[kMostKinds]; };

// The map of a kind along a light, number 4 * kind + light.
struct MapFrame {
  vec4 origin;   // xyz: (right, up, depth) of the prototype's origin; w: side of a pixel   [m]
  vec4 corner;   // xy: of pixel (0, 0)                                                     [m]
  uvec4 size;    // xy: [pixel]; z: number of its first line in map_lines; w: of its first crossing in map_crossings
};
layout(std140, binding = 3) uniform MapFrames { MapFrame map_frames[4u * kMostKinds]; };

// A tree of the stand: two texels of bits.
struct Tree {
  vec3 position;  // [m]
  uint kind;
  vec3 cells;     // first of its cells in their texture
  bool has_cells;
  bool far;       // whether its places in the light field are those of trees that are far
  uint field;     // one more than its first place in the light field; 0: none is told
};
layout(binding = 12) uniform usamplerBuffer trees;
Tree treeAt(uint number) {
  uvec4 stands = texelFetch(trees, 2 * int(number)), block = texelFetch(trees, 2 * int(number) + 1);
#ifdef ONE_KIND
  stands.w = 0u;
#endif
  return Tree(uintBitsToFloat(stands.xyz), stands.w, vec3(block.xyz), (block.w & 1u) != 0u, (block.w & 2u) != 0u, block.w >> 2);
}

#ifdef ONE_KIND
uint kindOf(uint tree) { return 0u; }
#else
uint kindOf(uint tree) { return texelFetch(trees, 2 * int(tree)).w; }
#endif

// A tree that is drawn, or that stands in a light; a copy included. A texel of bits.
struct Standing {
  vec3 position;  // [m]
  uint tree;
};
Standing standingAt(uvec4 bits) { return Standing(uintBitsToFloat(bits.xyz), bits.w); }
layout(binding = 13) uniform usamplerBuffer drawn;

const uint kNoLeaf = 0xffffffffu;
const uint kNone = 0xffffffffu, kGround = 0xfffffffeu;  // in place of a drawn tree

vec3 inLight(uint light, vec3 place) {
  return vec3(dot(place, light_frames[light].right.xyz), dot(place, light_frames[light].up.xyz),
              dot(place, light_frames[light].travel.xyz));
}
