#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.hpp"
#include "render/reference/order_table.hpp"
#include "render/reference/ray_scene.hpp"
#include "render/reference/trace_effort.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_light.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// Where one band of the sun's light ends up, as shares of the incident flux: the sunlight that enters the traced box. A
// periodic stand is entered through the horizontal top of one period; a stand without period through the sunlit faces
// of the box of its trees, the top and, unless the sun is overhead, the sides. Light that leaves downward arrives at
// the ground, wherever it leaves the box; light that leaves upward is reflected. So reflected + absorbed_leaves +
// absorbed_wood + absorbed_particles + absorbed_ground = 1.
struct ForwardResult {
  Estimate reflected;
  Estimate absorbed_leaves, absorbed_wood;     // turbid leaves of media are leaves
  std::optional<Estimate> absorbed_particles;  // where a medium has particles
  Estimate arriving_ground;                    // every arrival counted, also after reflection by the ground itself
  Estimate arriving_ground_direct;             // of these, the light that met nothing before
  Estimate absorbed_ground;
  OrderTable reflected_by_order, arriving_ground_by_order;  // by scatterings by leaves
  // Of each leaf of the prototypes, kind after kind: irradiance per one-sided area, for sun irradiance 1 on a plane
  // facing the sun; the mean over the stand's trees of the kind.
  std::vector<double> leaf_irradiance;      // E, both sides together [1]
  std::vector<double> leaf_standard_error;  // of E [1]
  std::vector<Estimate> leaf_front,
      leaf_back;                      // of the side that its triangles' corners turn about counter-clockwise ...
  std::vector<Estimate> leaf_direct;  // both sides, of light that met nothing before
  std::uint64_t paths = 0;            // traced; fewer than asked for when ended early
  double seconds = 0.;                // wall time
  double cpu_seconds = 0.;            // of all threads of the process
};

// (R1) Monte Carlo from the sun to the leaves, all bands on one path. Leaves scatter by Lambert's law on both sides,
// wood and ground on one, media by (R14). The ground lies at the bottom of the box.
class ForwardJob final : public TraceJob {
 public:
  //   scene  must outlive the job
  // Throws InvalidInput on invalid light, more than kMostBands bands, and on a ground that reflects under a stand
  // without period: where that light would go cannot be told from the box alone (traceCamera takes any).
  ForwardJob(const RayScene& scene, std::vector<TraceLight> bands, std::uint64_t paths_per_unit);
  ~ForwardJob() override;

  std::size_t bins() const override;
  TraceIdentity identity() const override;
  void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const override;

  std::vector<ForwardResult> results(const TraceSums& sums) const;  // of each band
  // The largest standard error of a share of the light, relative to it; shares below 1 % are left out.
  double relativeError(const TraceSums& sums) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

// The whole run in memory. When `progress` ends it early, the units done until then are the result, at least one.
std::vector<ForwardResult> traceForwardBands(const RayScene& scene, const std::vector<TraceLight>& bands,
                                             const TraceEffort& effort, const Progress& progress = {});
// The same for one band.
ForwardResult traceForward(const RayScene& scene, const TraceLight& light, const TraceEffort& effort,
                           const Progress& progress = {});

}  // namespace sunfleck
