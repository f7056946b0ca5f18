// What stands between a place and a light, and behind the place, read from the kinds' deep opacity maps along the
// light, once for each tree that may stand there.
layout(binding = 0) uniform usamplerBuffer map_lines;      // first crossing, end of them, bits of the wood's depth
layout(binding = 1) uniform usamplerBuffer map_crossings;  // bits of the depth from the map's origin plane [m], leaf
layout(binding = 2) uniform usamplerBuffer light_cells;    // first entry of each cell of the lights' grids
layout(binding = 3) uniform usamplerBuffer light_casters;  // bits of a tree's position [m], the tree

struct Foliage {
  float before;   // n+: leaves crossed between the light and the place                    [1]
  float beyond;   // n-: leaves crossed beyond it                                          [1]
  float visible;  // share of the light that meets neither leaf nor wood before            [1], 0 .. 1
};

struct Caster {
  vec3 position;  // [m]
  uint tree;
};
Caster casterAt(uint entry) {
  uvec4 bits = texelFetch(light_casters, int(entry));
  return Caster(uintBitsToFloat(bits.xyz), bits.w);
}

// Entries of the grid that may stand in the light of a place: x .. y - 1.
uvec2 castersAt(uint light, vec3 place) {
  LightFrame of = light_frames[light];
  ivec2 cell = ivec2(floor((inLight(light, place).xy - vec2(of.right.w, of.up.w)) * of.travel.w));
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(of.grid.xy)))) return uvec2(0u);
  int number = int(of.grid.z) + cell.y * int(of.grid.x) + cell.x;
  return uvec2(texelFetch(light_cells, number).r, texelFetch(light_cells, number + 1).r);
}

struct Nearest {  // the four pixels nearest to a point, and what each counts
  ivec2 pixel;    // the one of smallest coordinates
  vec2 part;      // of the way to the next
};
Nearest nearestPixels(MapFrame map, vec3 at) {
  vec2 pixel = (at.xy - map.corner.xy) / map.origin.w - 0.5;
  vec2 low = floor(clamp(pixel, vec2(-2.0), vec2(map.size.xy) + 1.0));
  return Nearest(ivec2(low), pixel - low);
}

// One tree's share of (R3)'s foliage. Pixels beside the map are empty.
Foliage foliageOfTree(MapFrame map, vec3 at, uint own, float wood_bias) {
  Foliage sum = Foliage(0.0, 0.0, 1.0);
  Nearest near = nearestPixels(map, at);
  if (any(lessThan(near.pixel, ivec2(-1))) || any(greaterThanEqual(near.pixel, ivec2(map.size.xy)))) return sum;
  sum.visible = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    ivec2 offset = ivec2(corner & 1, corner >> 1);
    ivec2 pixel = near.pixel + offset;
    float weight =
        (offset.x == 1 ? near.part.x : 1.0 - near.part.x) * (offset.y == 1 ? near.part.y : 1.0 - near.part.y);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(map.size.xy)))) {
      sum.visible += weight;
      continue;
    }
    uvec3 line = texelFetch(map_lines, int(map.size.z) + pixel.y * int(map.size.x) + pixel.x).xyz;
    int before = 0, beyond = 0;
    for (uint c = line.x; c < line.y; ++c) {
      uvec2 crossing = texelFetch(map_crossings, int(map.size.w + c)).xy;
      if (crossing.y == own) continue;
      if (uintBitsToFloat(crossing.x) < at.z) ++before;
      else ++beyond;
    }
    sum.before += weight * float(before);
    sum.beyond += weight * float(beyond);
    if (before == 0 && at.z <= uintBitsToFloat(line.z) + wood_bias) sum.visible += weight;
  }
  return sum;
}

// (R3) The foliage in the light of a place: counts summed over the trees, visibilities multiplied.
//   place      from `stands` [m]
//   stands     where the tree of the place stands, in the stand's own period [m]
//   tree, own  that tree and the leaf the place lies on, which does not stand in its own light; kNone, kNoLeaf for none
//   wood_bias  how far a place may lie behind wood and count as its surface: x [side of a pixel] and y [m]
Foliage foliageAt(uint light, vec3 place, vec3 stands, uint tree, uint own, vec2 wood_bias) {
  Foliage sum = Foliage(0.0, 0.0, 1.0);
  uvec2 casters = castersAt(light, place + stands);
  for (uint c = casters.x; c < casters.y; ++c) {
    Caster caster = casterAt(c);
    vec3 displacement = caster.position - stands;
    MapFrame map = map_frames[4u * kindOf(caster.tree) + light];
    bool same = caster.tree == tree && displacement == vec3(0.0);
    Foliage of_tree = foliageOfTree(map, inLight(light, place - displacement) + map.origin.xyz, same ? own : kNoLeaf,
                                    wood_bias.x * map.origin.w + wood_bias.y);
    sum.before += of_tree.before;
    sum.beyond += of_tree.beyond;
    sum.visible *= of_tree.visible;
  }
  return sum;
}

// How far behind the first wood of a pixel another point of the same plane can lie within a pixel's reach, for wood
// whose normal has this cosine to the light; a twentieth is where it no longer grows  [side of a pixel].
float woodBias(float to_light_cosine) {
  float cosine = max(abs(to_light_cosine), 0.05);
  return 0.5 + 1.5 * sqrt(1.0 - min(cosine * cosine, 1.0)) / cosine;
}
