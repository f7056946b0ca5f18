// What all stages of a picture read. The C++ side is detail/frame_data.hpp; both change together.
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_world;
  vec4 to_eye;            // xyz: unit vector back to the camera
  vec4 sun;               // xyz: unit vector along which sunlight travels
  vec4 map_right;         // xyz: right of the sun's map; w: its corner along right        [m]
  vec4 map_up;            // xyz: up of the sun's map; w: its corner along up              [m]
  vec4 map_size;          // x, y: size [pixel]; z: side of a pixel [m]; w: 1 / z
  vec4 cell_low;          // xyz: corner of the tree's cells; w: side of a cell            [m]
  vec4 cell_count;        // xyz: cells of one tree; w: trees side by side in the texture
  vec4 ground_albedo;     // per band [1]
  vec4 ground;       // xyz: centre of the ground's disc; w: its radius                    [m]
  uvec4 choice;      // x: whether there is G; y: instance number of the ground
};

struct Instance {
  vec4 position;    // xyz: of the tree; 0 for the ground                                  [m]
  uvec4 neighbours; // x .. y - 1: whose leaves may stand in its light; z: tree of the stand
};
layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };

const uint kNoLeaf = 0xffffffffu;
