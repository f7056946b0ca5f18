// (D14) Which pixels of a deep opacity map a triangle covers: the steps of grid/detail/scan_conversion_for.cpp in the
// same order and in double precision, so that both find the same pixels and the same depths. `precise`, because the
// triangles on either side of an edge must see the same, and so must the shader that counts and the one that fills.
layout(local_size_x = 64) in;

// The C++ side is `MapData` in opacity_maps.cpp.
layout(std140, binding = 0) uniform Map {
  dvec2 corner;             // (right, up) of pixel (0, 0)'s outer corner [m]
  double pixels_per_metre;  // [1/m]
  vec4 map_right, map_up, map_along;
  uvec4 map_size;  // x, y: columns, rows [pixel]; z: leaf triangles; w: wood triangles, which follow them
};
layout(std430, binding = 0) readonly buffer Positions { float positions[]; };   // of the vertices [m]
layout(std430, binding = 1) readonly buffer Triangles { uvec4 triangles[]; };  // vertices, and the leaf

// What is done with each pixel: `depth` of the triangle at its centre [m].
void put(uint pixel, float depth, uint leaf);

// The triangle of this invocation: there may be more than fit side by side. Along z several share a triangle.
uint triangleNumber() {
  return gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x;
}

// A float as a number that is greater the greater it is, and back.
uint ordered(float value) {
  uint bits = floatBitsToUint(value);
  return (bits >> 31) != 0u ? ~bits : bits | 0x80000000u;
}

struct Corner {
  double column, row, depth;
};
Corner cornerOf(uint vertex) {
  vec3 p = vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
  precise float right = p.x * map_right.x + p.y * map_right.y + p.z * map_right.z;
  precise float up = p.x * map_up.x + p.y * map_up.y + p.z * map_up.z;
  precise float along = p.x * map_along.x + p.y * map_along.y + p.z * map_along.z;
  precise double column = (double(right) - corner.x) * pixels_per_metre + 0.5lf;
  precise double row = (double(up) - corner.y) * pixels_per_metre + 0.5lf;
  return Corner(column, row, double(along));
}

struct Edge {
  Corner high, slope;  // upper end, and change per row; .row of the latter is not used
};
Edge edgeOf(Corner low, Corner high) {
  precise double per_row = 1.0lf / (high.row - low.row);
  precise double column = per_row * (high.column - low.column);
  precise double depth = per_row * (high.depth - low.depth);
  return Edge(high, Corner(column, 0.0lf, depth));
}

void swapped(inout Corner a, inout Corner b) {
  Corner c = a;
  a = b;
  b = c;
}

void scanTriangle() {
  uvec4 triangle = triangles[triangleNumber()];
  Corner low = cornerOf(triangle.x), middle = cornerOf(triangle.y), high = cornerOf(triangle.z);
  int least_column = int(min(low.column, min(middle.column, high.column)));
  int most_column = int(max(low.column, max(middle.column, high.column)));
  if (middle.row < low.row) swapped(low, middle);
  if (high.row < middle.row) swapped(middle, high);
  if (middle.row < low.row) swapped(low, middle);
  int bend = int(middle.row), end_row = min(int(map_size.y), int(high.row));
  if (least_column == most_column) return;  // between the centres of pixels
  Edge whole = edgeOf(low, high), lower = edgeOf(low, middle), upper = edgeOf(middle, high);
  for (int row = int(low.row) + int(gl_WorkGroupID.z); row < end_row; row += int(gl_NumWorkGroups.z)) {
    Edge part = lower;
    if (row >= bend) part = upper;
    double centre = double(row) + 1.0lf;
    precise double column = whole.high.column + (centre - whole.high.row) * whole.slope.column;
    precise double other = part.high.column + (centre - part.high.row) * part.slope.column;
    int first_pixel = max(int(min(column, other)), 0);
    int end_pixel = min(int(max(column, other)), int(map_size.x));
    if (first_pixel >= end_pixel) continue;
    precise double depth = whole.high.depth + (centre - whole.high.row) * whole.slope.depth;
    precise double other_depth = part.high.depth + (centre - part.high.row) * part.slope.depth;
    precise double slope = (other_depth - depth) / (other - column);
    precise double first_depth = depth + (double(first_pixel) + 1.0lf - column) * slope;
    precise float at_first = float(first_depth), per_pixel = float(slope);
    for (int x = first_pixel; x < end_pixel; ++x) {
      precise float at_pixel = at_first + float(x - first_pixel) * per_pixel;
      put(uint(row) * map_size.x + uint(x), at_pixel, triangle.w);
    }
  }
}
