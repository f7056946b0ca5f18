#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.hpp"
#include "render/reference/order_table.hpp"
#include "render/reference/ray_scene.hpp"
#include "render/reference/trace_cells.hpp"
#include "render/reference/trace_effort.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_light.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// Where one band of light ends up, as shares of the incident flux: the light of sun and sky that enters the traced box.
// A periodic stand is entered through the horizontal top of one period; a stand without period through the faces of the
// box of its trees that the light comes to, the top and, but for light from overhead, the sides. Light that leaves
// downward arrives at the ground, wherever it leaves the box; light that leaves upward is reflected. So reflected +
// absorbed_leaves + absorbed_wood + absorbed_particles + absorbed_ground = 1; several bands under a sky share paths
// that are not drawn for each alone, and keep to that within their standard errors.
struct ForwardResult {
  double sky_share = 0.;  // of the incident flux; the rest is the sun's
  Estimate reflected;
  Estimate absorbed_leaves, absorbed_wood;     // turbid leaves of media are leaves
  std::optional<Estimate> absorbed_particles;  // where a medium has particles
  Estimate arriving_ground;                    // every arrival counted, also after reflection by the ground itself
  Estimate arriving_ground_direct;             // of these, the light that met nothing before
  Estimate absorbed_ground;
  OrderTable reflected_by_order, arriving_ground_by_order;  // by scatterings by leaves
  // Of each leaf of the prototypes, kind after kind: irradiance per one-sided area, in the unit of the
  // light's: for a sun of irradiance 1 alone, relative to that on a plane facing it; the mean over the stand's trees of
  // the kind.
  std::vector<double> leaf_irradiance;      // E, both sides together [1]
  std::vector<double> leaf_standard_error;  // of E [1]
  std::vector<Estimate> leaf_front,
      leaf_back;                      // of the side that its triangles' corners turn about counter-clockwise ...
  std::vector<Estimate> leaf_direct;  // both sides, of light that met nothing before
  std::uint64_t paths = 0;            // traced; fewer than asked for when ended early
  double seconds = 0.;                // wall time
  double cpu_seconds = 0.;            // of all threads of the process
};

// Light of one band that leaves and wood of a cell absorb, as shares of the incident flux.
struct CellAbsorption {
  std::size_t cell = 0;
  Estimate leaves, wood;
};

// What is kept beside the shares of the light.
struct ForwardDetail {
  bool leaves = true;                 // of each leaf: 32 bytes of memory for every sum, 4 sums for one band
  std::optional<TraceCells> cells{};  // of the scene, what is absorbed in each
};

// (R1) Monte Carlo from the light (R19) to the leaves, all bands on one path. Leaves scatter by Lambert's law on both
// sides or by (R20), wood and ground on one, media by (R14). The ground lies at the bottom of the box.
class ForwardJob final : public TraceJob {
 public:
  //   scene  must outlive the job
  // Throws InvalidInput on invalid light, more than kMostBands bands, and on a ground that reflects under a stand
  // without period: where that light would go cannot be told from the box alone (traceCamera takes any).
  ForwardJob(const RayScene& scene, std::vector<TraceLight> bands, std::uint64_t paths_per_unit,
             ForwardDetail detail = {});
  ~ForwardJob() override;

  std::size_t bins() const override;
  TraceIdentity identity() const override;
  void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const override;

  std::vector<ForwardResult> results(const TraceSums& sums) const;  // of each band
  // Of those cells where any light was absorbed, in their order; their sums are those of the results.
  std::vector<CellAbsorption> cells(const TraceSums& sums, std::size_t band) const;
  double incidentFlux(int band) const;  // that the shares are of, relative to a sun of irradiance 1 [m^2]
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
