#version 450 core
// (D14) From counts to places, in two steps between which the processor adds up the sums of runs of 64 pixels: the
// first tells each run's sum, the second puts in the place of each count the sum of all before it.
layout(local_size_x = 64) in;
layout(std430, binding = 2) buffer First { uint first[]; };  // [1]: that of the first pixel
layout(std430, binding = 5) buffer Runs {
  uint most;    // crossings of a pixel
  uint runs[];  // sums of the runs, then of all before each run
};
layout(location = 0) uniform uint pixels;
layout(location = 1) uniform bool sums_known;

const uint kRun = 64u;

void main() {
  uint run = gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x;
  if (run * kRun >= pixels) return;
  uint sum = sums_known ? runs[run] : 0u, largest = 0u;
  for (uint i = run * kRun; i < min((run + 1u) * kRun, pixels); ++i) {
    uint count = first[i + 1u];
    largest = max(largest, count);
    if (sums_known) first[i + 1u] = sum;
    sum += count;
  }
  if (sums_known) return;
  runs[run] = sum;
  atomicMax(most, largest);
}
