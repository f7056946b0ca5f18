// What stands between a place and a light, and behind the place, read from the kinds' deep opacity maps along the
// light, once for each tree that may stand there.
layout(binding = 0) uniform usamplerBuffer map_lines;      // first crossing, end of them, bits of the wood's depth
layout(binding = 1) uniform usamplerBuffer map_crossings;  // bits of the depth from the map's origin plane [m], leaf
layout(binding = 2) uniform usamplerBuffer light_cells;    // entries of each cell of the lights' grids: first, end
layout(binding = 3) uniform usamplerBuffer light_casters;  // bits of a tree's position [m], the tree

struct Foliage {
  float before;   // n+: leaves crossed between the light and the place                    [1]
  float beyond;   // n-: leaves crossed beyond it                                          [1]
  float visible;  // share of the light that meets neither leaf nor wood before            [1], 0 .. 1
};

// Entries of the grid that may stand in the light of a place: x .. y - 1.
uvec2 castersAt(uint light, vec3 place) {
  LightFrame of = light_frames[light];
  ivec2 cell = ivec2(floor((inLight(light, place).xy - vec2(of.right.w, of.up.w)) * of.travel.w));
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(of.grid.xy)))) return uvec2(0u);
  return texelFetch(light_cells, int(of.grid.z) + cell.y * int(of.grid.x) + cell.x).xy;
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

// The last leaf that light on its way to a place can meet.
struct LastLeaf {
  float way;       // from it to the place, 1e30 where there is no leaf [m]
  Standing stands; // its tree
};

struct TreeFoliage {
  Foliage foliage;
  float last;  // depth of the last leaf of the pixel nearest to the place, -1e30 where there is none [m]
};

// One tree's share of (R3)'s foliage. Pixels beside the map are empty. The crossings of pixels beside each other in a
// row stand one after the other, so that all four are a walk of two parts.
TreeFoliage foliageOfTree(MapFrame map, vec3 at, uint own, float wood_bias) {
  Nearest near = nearestPixels(map, at);
  ivec2 size = ivec2(map.size.xy);
  bvec2 low_inside = lessThan(uvec2(near.pixel), map.size.xy), high_inside = lessThan(uvec2(near.pixel + 1), map.size.xy);
  ivec2 low = clamp(near.pixel, ivec2(0), max(size - 1, 0)), high = clamp(near.pixel + 1, ivec2(0), max(size - 1, 0));
  vec2 low_weight = 1.0 - near.part, high_weight = near.part;
  uint crossings = map.size.w;
  // Lower and upper row; of each its left and right pixel.
  uvec3 lower_left = texelFetch(map_lines, int(map.size.z) + low.y * size.x + low.x).xyz;
  uvec3 lower_right = texelFetch(map_lines, int(map.size.z) + low.y * size.x + high.x).xyz;
  uvec3 upper_left = texelFetch(map_lines, int(map.size.z) + high.y * size.x + low.x).xyz;
  uvec3 upper_right = texelFetch(map_lines, int(map.size.z) + high.y * size.x + high.x).xyz;
  // Where the crossings of the row begin, those of the right pixel begin, and they end.
  uvec3 lower = uvec3(low_inside.x ? lower_left.x : lower_right.x, low_inside.x ? lower_left.y : lower_right.x, 0u);
  uvec3 upper = uvec3(low_inside.x ? upper_left.x : upper_right.x, low_inside.x ? upper_left.y : upper_right.x, 0u);
  lower.z = high_inside.x ? lower_right.y : lower.y;
  upper.z = high_inside.x ? upper_right.y : upper.y;
  uint in_lower = low_inside.y && (low_inside.x || high_inside.x) ? lower.z - lower.x : 0u;
  uint in_upper = high_inside.y && (low_inside.x || high_inside.x) ? upper.z - upper.x : 0u;

  TreeFoliage of_tree = TreeFoliage(Foliage(0.0, 0.0, 0.0), -1e30);
  uint nearest = (near.part.x > 0.5 ? 1u : 0u) + (near.part.y > 0.5 ? 2u : 0u), shaded = 0u;
  float crossed = 0.0;
  for (uint i = 0u; i < in_lower + in_upper; ++i) {
    bool is_upper = i >= in_lower;
    uint c = is_upper ? upper.x + i - in_lower : lower.x + i;
    bool is_right = c >= (is_upper ? upper.y : lower.y);
    uint corner = (is_right ? 1u : 0u) + (is_upper ? 2u : 0u);
    float weight = (is_right ? high_weight.x : low_weight.x) * (is_upper ? high_weight.y : low_weight.y);
    uvec2 crossing = texelFetch(map_crossings, int(crossings + c)).xy;
    float depth = uintBitsToFloat(crossing.x);
    of_tree.last = corner == nearest ? depth : of_tree.last;
    bool is_other = crossing.y != own, is_before = is_other && depth < at.z;
    crossed += is_other ? weight : 0.0;
    of_tree.foliage.before += is_before ? weight : 0.0;
    shaded |= is_before ? 1u << corner : 0u;
  }
  of_tree.foliage.beyond = crossed - of_tree.foliage.before;
  // Leaves and wood that hide the light.
  float depth = at.z - wood_bias;
  bvec4 open = bvec4((shaded & 1u) == 0u && depth <= uintBitsToFloat(lower_left.z),
                     (shaded & 2u) == 0u && depth <= uintBitsToFloat(lower_right.z),
                     (shaded & 4u) == 0u && depth <= uintBitsToFloat(upper_left.z),
                     (shaded & 8u) == 0u && depth <= uintBitsToFloat(upper_right.z));
  bvec4 inside = bvec4(low_inside.x && low_inside.y, high_inside.x && low_inside.y, low_inside.x && high_inside.y,
                       high_inside.x && high_inside.y);
  vec2 of_lower = vec2(open.x || !inside.x ? low_weight.x : 0.0, open.y || !inside.y ? high_weight.x : 0.0);
  vec2 of_upper = vec2(open.z || !inside.z ? low_weight.x : 0.0, open.w || !inside.w ? high_weight.x : 0.0);
  of_tree.foliage.visible =
      any(inside) ? low_weight.y * (of_lower.x + of_lower.y) + high_weight.y * (of_upper.x + of_upper.y) : 1.0;
  return of_tree;
}

// (R3) The foliage in the light of a place: counts summed over the trees, visibilities multiplied.
//   place      from `stands` [m]
//   stands     where the tree of the place stands, in the stand's own period [m]
//   tree, own  that tree and the leaf the place lies on, which does not stand in its own light; kNone, kNoLeaf for none
//   wood_bias  how far a place may lie behind wood and count as its surface: x [side of a pixel] and y [m]
//   last       is told for places without a leaf of their own: what sends the slab's light down to there
Foliage foliageAt(uint light, vec3 place, vec3 stands, uint tree, uint own, vec2 wood_bias, out LastLeaf last) {
  Foliage sum = Foliage(0.0, 0.0, 1.0);
  last = LastLeaf(1e30, Standing(vec3(0.0), 0u));
  uvec2 casters = castersAt(light, place + stands);
  for (uint c = casters.x; c < casters.y; ++c) {
    Standing caster = standingAt(texelFetch(light_casters, int(c)));
    vec3 displacement = caster.position - stands;
    MapFrame map = map_frames[4u * kindOf(caster.tree) + light];
    bool same = caster.tree == tree && displacement == vec3(0.0);
    vec3 at = inLight(light, place - displacement) + map.origin.xyz;
    TreeFoliage of_tree =
        foliageOfTree(map, at, same ? own : kNoLeaf, wood_bias.x * map.origin.w + wood_bias.y);
    sum.before += of_tree.foliage.before;
    sum.beyond += of_tree.foliage.beyond;
    sum.visible *= of_tree.foliage.visible;
    if (at.z - of_tree.last < last.way) last = LastLeaf(at.z - of_tree.last, caster);
  }
  return sum;
}

// How far behind the first wood of a pixel another point of the same plane can lie within a pixel's reach, for wood
// whose normal has this cosine to the light; a twentieth is where it no longer grows  [side of a pixel].
float woodBias(float to_light_cosine) {
  float cosine = max(abs(to_light_cosine), 0.05);
  return 0.5 + 1.5 * sqrt(1.0 - min(cosine * cosine, 1.0)) / cosine;
}
