// What is told of the cells of each tree: a block of texels for each.
layout(binding = 4) uniform sampler3D compensation_cells;  // G for each light [1]
layout(binding = 5) uniform sampler3D sky_cells;           // mean radiance of the environment's light, per band [1/sr]

// Where a place of a tree is in these textures; beyond the outermost cell centres their values go on.
//   place  in the prototype's frame [m]
vec3 inCells(vec3 place, uint kind, uint block) {
  KindFrame of = kind_frames[kind];
  vec3 cell = clamp((place - of.cell_low.xyz) * of.cell_low.w, vec3(0.5), vec3(of.cell_count.xyz) - 0.5);
  uint across = cells.w, up = blocks.x;
  uvec3 corner = uvec3(block % across, block / across % up, block / (across * up)) * cells.xyz;
  return (cell + vec3(corner)) / vec3(textureSize(compensation_cells, 0));
}

float compensationAt(vec3 place, uint tree, uint light) {
  uvec4 of = trees[tree].kind;
  return of.y == kNone ? 1.0 : texture(compensation_cells, inCells(place, kindOf(tree), of.y))[light];
}

vec3 skyLightAt(vec3 place, uint tree) {
  uvec4 of = trees[tree].kind;
  return of.y == kNone ? vec3(0.0) : texture(sky_cells, inCells(place, kindOf(tree), of.y)).rgb;
}
