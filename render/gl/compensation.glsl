layout(binding = 0) uniform sampler3D compensation_texture;  // G [1]; the cells of each tree are a block of their own

// G at a place of the prototype, for a tree of the stand; beyond the outermost cell centres their values go on.
float compensationAt(vec3 place, uint tree) {
  vec3 cell = clamp((place - cell_low.xyz) / cell_low.w, vec3(0.5), cell_count.xyz - 0.5);
  uint across = uint(cell_count.w);
  vec3 block = vec3(tree % across, 0, tree / across) * cell_count.xyz;
  return texture(compensation_texture, (cell + block) / vec3(textureSize(compensation_texture, 0))).r;
}
