// What is told of the cells of each tree: a block of texels for each.
layout(binding = 4) uniform sampler3D compensation_cells;  // G for each light [1]
layout(binding = 5) uniform sampler3D sky_cells;           // mean radiance of the environment's light, per band [1/sr]

// Where a place of a tree is in these textures; beyond the outermost cell centres their values go on.
//   place  in the prototype's frame [m]
vec3 inCells(vec3 place, Tree tree) {
  KindFrame of = kind_frames[tree.kind];
  vec3 cell = clamp((place - of.cell_low.xyz) * of.cell_low.w, vec3(0.5), vec3(of.cell_count.xyz) - 0.5);
  return (cell + tree.cells) * cell_part.xyz;
}

float compensationAt(vec3 place, Tree tree, uint light) {
  float told = textureLod(compensation_cells, inCells(place, tree), 0.0)[light];
  return tree.has_cells ? told : 1.0;
}

vec3 skyLightAt(vec3 place, Tree tree) {
  vec3 told = textureLod(sky_cells, inCells(place, tree), 0.0).rgb;
  return tree.has_cells ? told : vec3(0.0);
}
