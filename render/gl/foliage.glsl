// What stands between a place and the sun, and behind the place, read from the prototype's deep opacity map along the
// sun, once for each tree that may stand there.
struct Neighbour {
  vec4 in_map;    // xyz: displacement from the instance, along the map's right, up and depth  [m]
  vec4 in_space;  // xyz: the same along x, y and z [m]; w: tree of the stand
};
struct Crossing {
  float depth;  // along the sun from the map's origin plane [m]
  uint leaf;
};
layout(std430, binding = 1) readonly buffer Neighbours { Neighbour neighbours[]; };
layout(std430, binding = 2) readonly buffer First { uint first[]; };
layout(std430, binding = 3) readonly buffer Crossings { Crossing crossings[]; };
layout(std430, binding = 4) readonly buffer WoodDepth { float wood_depth[]; };

struct Foliage {
  float before;   // n+: leaves crossed between the sun and the place                      [1]
  float beyond;   // n-: leaves crossed beyond it                                          [1]
  float visible;  // share of the sun's light that meets neither leaf nor wood before      [1], 0 .. 1
};

vec3 inMap(vec3 place) { return vec3(dot(place, map_right.xyz), dot(place, map_up.xyz), dot(place, sun.xyz)); }

struct Nearest {  // the four pixels nearest to a point, and what each counts
  ivec2 pixel;    // the one of smallest coordinates
  vec2 part;      // of the way to the next
};
Nearest nearestPixels(vec3 at) {
  vec2 pixel = (at.xy - vec2(map_right.w, map_up.w)) * map_size.w - 0.5;
  vec2 low = floor(clamp(pixel, vec2(-2.0), map_size.xy + 1.0));
  return Nearest(ivec2(low), pixel - low);
}
bool besideMap(Nearest near) {
  return any(lessThan(near.pixel, ivec2(-1))) || any(greaterThanEqual(near.pixel, ivec2(map_size.xy)));
}

// One tree's share of (R3)'s foliage. Pixels beside the map are empty.
Foliage foliageOfTree(vec3 at, uint own, float wood_bias) {
  Foliage sum = Foliage(0.0, 0.0, 1.0);
  Nearest near = nearestPixels(at);
  if (besideMap(near)) return sum;
  sum.visible = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    ivec2 offset = ivec2(corner & 1, corner >> 1);
    ivec2 pixel = near.pixel + offset;
    float weight = (offset.x == 1 ? near.part.x : 1.0 - near.part.x) * (offset.y == 1 ? near.part.y : 1.0 - near.part.y);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(map_size.xy)))) {
      sum.visible += weight;
      continue;
    }
    int i = pixel.y * int(map_size.x) + pixel.x;
    int before = 0, beyond = 0;
    for (uint c = first[i]; c < first[i + 1]; ++c) {
      if (crossings[c].leaf == own) continue;
      if (crossings[c].depth < at.z) ++before;
      else ++beyond;
    }
    sum.before += weight * float(before);
    sum.beyond += weight * float(beyond);
    if (before == 0 && at.z <= wood_depth[i] + wood_bias) sum.visible += weight;
  }
  return sum;
}

// (R3) The foliage in the light of a place of an instance: counts summed over the trees, visibilities multiplied.
//   place      in the prototype's frame [m]
//   own        the leaf the place lies on, which does not stand in its own light; kNoLeaf for none
//   wood_bias  how far a place may lie behind wood and count as its surface [m]
Foliage foliageAt(vec3 place, uint instance, uint own, float wood_bias) {
  Foliage sum = Foliage(0.0, 0.0, 1.0);
  vec3 at = inMap(place);
  uvec4 range = instances[instance].neighbours;
  for (uint n = range.x; n < range.y; ++n) {
    // The first neighbour of a tree is the tree itself.
    Foliage tree = foliageOfTree(at - neighbours[n].in_map.xyz, n == range.x ? own : kNoLeaf, wood_bias);
    sum.before += tree.before;
    sum.beyond += tree.beyond;
    sum.visible *= tree.visible;
  }
  return sum;
}

// How far behind the first wood of a pixel another point of the same plane can lie within a pixel's reach, for wood
// whose normal has this cosine to the light; a twentieth is where it no longer grows.
float woodBias(float to_light_cosine) {
  float cosine = max(abs(to_light_cosine), 0.05);
  return map_size.z * (0.5 + 1.5 * sqrt(1.0 - min(cosine * cosine, 1.0)) / cosine);
}
