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
  vec4 sky_azimuth;   // x: where the sky's first column begins [rad]
  vec4 ground_cells;  // xy: corner of the cells in which the ground's skylight is told [m]; zw: 1 / extent [1/m]
  vec4 ground_open;   // rgb: irradiance of open ground by the sky [1]; w: 1 where cells are told
  uvec4 counts;       // x: lights; y: trees of the stand; z: light told in layers; w: 1 where cells have light
  uvec4 cells;        // xyz: cells of a block, one for each tree; w: blocks along x
  uvec4 blocks;       // x: blocks along y; y, z: rows and columns of the sky, 0: none
  LightFrame light_frames[4];
};

// A tree of the stand.
struct Tree {
  vec4 position;  // xyz [m]
  uvec4 kind;     // x: its kind; y: its block of cells; z: its first texel of the field; kNone: none
};
layout(std430, binding = 0) readonly buffer Trees { Tree trees[]; };

// A drawn tree, a copy included.
struct Drawn {
  vec3 position;  // [m]
  uint number;
};
layout(std430, binding = 1) readonly buffer DrawnTrees { Drawn drawn[]; };

// Where ONE_KIND and LIGHTS are told, compilers know what is the same for all pixels.
#ifdef ONE_KIND
uint kindOf(uint tree) { return 0u; }
#else
uint kindOf(uint tree) { return trees[tree].kind.x; }
#endif
#ifndef LIGHTS
#define LIGHTS counts.x
#endif

// A kind of trees.
struct KindFrame {
  vec4 cell_low;    // xyz: corner of its cells [m]; w: cells per metre
  uvec4 cell_count; // xyz: cells; w: number of its first triangle
};
layout(std430, binding = 2) readonly buffer KindFrames { KindFrame kind_frames[]; };

// The map of a kind along a light, number 4 * kind + light.
struct MapFrame {
  vec4 origin;   // xyz: (right, up, depth) of the prototype's origin; w: side of a pixel   [m]
  vec4 corner;   // xy: of pixel (0, 0)                                                     [m]
  uvec4 size;    // xy: [pixel]; z: number of its first line in map_lines; w: of its first crossing in map_crossings
};
layout(std430, binding = 3) readonly buffer MapFrames { MapFrame map_frames[]; };

const uint kNoLeaf = 0xffffffffu;
const uint kNone = 0xffffffffu, kGround = 0xfffffffeu;  // in place of a drawn tree

vec3 inLight(uint light, vec3 place) {
  return vec3(dot(place, light_frames[light].right.xyz), dot(place, light_frames[light].up.xyz),
              dot(place, light_frames[light].travel.xyz));
}
