#pragma once

#include <cstddef>

// The formulas over arrays, compiled for several instruction sets; arrayKernel() is the best that this machine has.
namespace sunfleck::spp::detail {

// True depths and thicknesses of `count` places.
struct Places {
  std::size_t count;
  const float *depth, *thickness;
};

// n streams: `modes` holds StreamModes of stream_formulas.glsl for each order, member after member.
struct StreamNumbers {
  int streams, orders;
  float depth_scale, beam_rate;
  const float* modes;
};

// What the modes weigh in a result: ModeWeights of stream_formulas.glsl, for each order that has a part in it.
struct Weights {
  const float *sum, *difference;
};

struct ViewNumbers {
  bool downward;
  float rate, beam_source;
  Weights seen;
};

// Of `count` sample directions: cosines, and a row of distances to the edge for each, as many as there are places.
struct Edges {
  std::size_t count;
  const float *cosines, *distances;
};

struct ArrayKernel {
  void (*compensation)(const Places&, const Edges&, float mu0, float* compensation);
  void (*sppPowers)(const Places&, float mu0, float albedo, float forward_share, float* down, float* up);
  void (*sppRadiance)(const Places&, float mu0, float albedo, float forward_share, float* down, float* up);
  void (*streamPowers)(const Places&, const StreamNumbers&, const Weights&, float* down, float* up);
  void (*refinedRadiance)(const Places&, const StreamNumbers&, const ViewNumbers&, float* radiance);
};

const ArrayKernel& arrayKernel();

}  // namespace sunfleck::spp::detail
