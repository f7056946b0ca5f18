#pragma once

#include <cstdint>
#include <vector>

#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "core/progress.hpp"
#include "render/reference/ray_scene.hpp"

namespace sunfleck {

// What a kind of tree does to light of one band.
struct TreeOptics {
  LeafOptics leaf{};
  float wood_reflectance = 0.3f;  // Lambertian [1], 0 .. 1
};

// One band of light and the sun that sends it.
struct TraceLight {
  Direction sun{0.f, 0.f, -1.f};  // direction of travel; z < 0
  LeafOptics leaf{};
  float wood_reflectance = 0.3f;       // Lambertian [1], 0 .. 1
  float ground_albedo = 0.f;           // Lambertian [1], 0 .. 1
  std::vector<TreeOptics> of_kinds{};  // of each kind of tree; none: all have the optics above

  TreeOptics ofKind(std::uint32_t kind) const {
    return of_kinds.empty() ? TreeOptics{leaf, wood_reflectance} : of_kinds[kind];
  }
};

// Paths are traced in batches of equal size, whose spread gives the standard errors: this many, or more where a batch
// would be larger than kMostBatchPaths. Between two batches a run can be ended.
inline constexpr int kTraceBatches = 64;
inline constexpr std::uint64_t kMostBatchPaths = 65'536;

struct TraceEffort {
  std::uint64_t paths = 1'000'000;  // >= kTraceBatches, rounded up to whole batches
  std::uint64_t seed = 1;
  int threads = 0;  // at most; 0: all cores. The result is the same for any number
};

// Throw InvalidInput on a value out of its range, a sun that does not shine down or is no unit vector.
void validate(const TraceLight& light);
void validate(const TraceEffort& effort);
void requireFitting(const TraceLight& light, const RayScene& scene);  // validates, and demands optics of each kind

// A mean and its standard error, from the spread of independent parts. Where there is one part alone, nothing is known
// of the spread: the standard error is then the value itself.
struct Estimate {
  double value = 0., standard_error = 0.;
};

// Where the sun's light ends up, as shares of the incident flux: the sunlight that enters the traced box. A periodic
// stand is entered through the horizontal top of one period; a stand without period through the sunlit faces of the box
// of its trees, the top and, unless the sun is overhead, the sides. Light that leaves downward arrives at the ground,
// wherever it leaves the box; light that leaves upward is reflected. So
// reflected + absorbed_leaves + absorbed_wood + absorbed_ground = 1.
struct ForwardResult {
  Estimate reflected;
  Estimate absorbed_leaves, absorbed_wood;
  Estimate arriving_ground;         // every arrival counted, also after reflection by the ground itself
  Estimate arriving_ground_direct;  // of these, the light that met nothing before
  Estimate absorbed_ground;
  // Of each leaf of the prototypes, kind after kind: both sides together per one-sided area, for sun irradiance 1 on a
  // plane facing the sun; the mean over the stand's trees of the kind.
  std::vector<double> leaf_irradiance;      // E [1]
  std::vector<double> leaf_standard_error;  // of E, from batches [1]
  std::uint64_t paths = 0;                  // traced; fewer than asked for when ended early
  double seconds = 0.;                      // wall time
  double cpu_seconds = 0.;                  // of all threads of the process
};

// (R1) Monte Carlo from the sun to the leaves. Leaves scatter by Lambert's law on both sides, wood and ground on one.
// The ground lies at the bottom of the box. When `progress` ends it early, the batches done until then are the result,
// at least one.
// Throws InvalidInput on invalid light or effort, light for another number of kinds, and on a ground that reflects
// under a stand without period: where that light would go cannot be told from the box alone (traceCamera takes any).
ForwardResult traceForward(const RayScene& scene, const TraceLight& light, const TraceEffort& effort,
                           const Progress& progress = {});

}  // namespace sunfleck
