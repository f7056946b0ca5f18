#pragma once

#include <cstdint>
#include <vector>

#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "core/progress.hpp"
#include "render/reference/ray_scene.hpp"

namespace sunfleck {

// One band of light and the sun that sends it.
struct TraceLight {
  Direction sun{0.f, 0.f, -1.f};  // direction of travel; z < 0
  LeafOptics leaf;
  float wood_reflectance = 0.3f;  // Lambertian [1], 0 .. 1
  float ground_albedo = 0.f;      // Lambertian [1], 0 .. 1
};

struct TraceEffort {
  std::uint64_t paths = 1'000'000;  // >= batches
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all cores. The result is the same for any number
};

// A share of the incident flux and its standard error.
struct Estimate {
  double value = 0., standard_error = 0.;
};

// Where the sun's light ends up, as shares of the incident flux: what falls through the horizontal top of the traced
// box (one period of a periodic stand; for a single stand the box of its trees).
struct ForwardResult {
  Estimate reflected;  // leaves upward or, for a stand without period, sideways
  Estimate absorbed_leaves, absorbed_wood;
  Estimate arriving_ground, arriving_ground_direct, absorbed_ground;
  // Of each leaf of the prototype, both sides together per one-sided area, for sun irradiance 1 on a plane facing the
  // sun; the mean over the stand's copies.
  std::vector<double> leaf_irradiance;      // E [1]
  std::vector<double> leaf_standard_error;  // of E, from batches [1]
  std::uint64_t paths = 0;                  // traced; fewer than asked for when ended early
  double seconds = 0., cpu_seconds = 0.;
};

// (R1) Monte Carlo from the sun to the leaves. Paths are traced in batches whose order of summation is fixed.
ForwardResult traceForward(const RayScene& scene, const TreeMesh& mesh, const TraceLight& light,
                           const TraceEffort& effort, const Progress& progress = {});

}  // namespace sunfleck
