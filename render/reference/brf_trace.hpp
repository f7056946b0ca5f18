#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/reference/ray_scene.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_light.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// Where a stand is seen from, far away.
struct ViewDirection {
  double zenith = 0.;   // [rad], 0 .. kMostViewZenith
  double azimuth = 0.;  // where the viewer stands, from +x towards +y [rad]
};
// Farther down a line of sight passes so many periods that it is cut off.
inline constexpr double kMostViewZenith = 1.5533430342749532;  // 89 degrees

// A reflectance factor [1] by how often and where the light was scattered.
struct ReflectanceParts {
  Estimate whole;
  Estimate leaf_once, wood_once, ground_once;
  Estimate more;  // scattered more than once, by anything
};

// Of one band.
struct BrfResult {
  std::vector<ReflectanceParts> views;  // reflectance factors, in the order of the directions
  ReflectanceParts albedo;              // of the hemisphere: reflected flux over incident flux
  std::uint64_t paths = 0;
};

// (R12) Reflectance factors of a periodic stand over its ground, which lies at the bottom of the box, by
// Monte Carlo from the top of one period down, all bands on one path. Unit u is of view u % groups; the last group is
// the albedo, whose views are drawn. Under a point sun alone the factors are bidirectional; light of a disc or a sky
// makes them hemispherical-directional: radiance by what a white plane would send under all of that light.
class BrfJob final : public TraceJob {
 public:
  //   scene  must outlive the job
  // Throws InvalidInput on invalid light, more than kMostBands bands, a stand without period, no views, more than
  // kMostViews or one out of its range.
  BrfJob(const RayScene& scene, std::vector<TraceLight> bands, std::vector<ViewDirection> views,
         std::uint64_t paths_per_unit);
  ~BrfJob() override;

  static constexpr std::size_t kMostViews = 10'000;

  std::size_t bins() const override;
  std::uint64_t groups() const override;  // views and the albedo
  TraceIdentity identity() const override;
  void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const override;

  std::uint64_t unitsOf(std::uint64_t paths) const;             // that trace so many paths to each view
  std::vector<BrfResult> results(const TraceSums& sums) const;  // of each band
  // What brings the standard error of every view, relative to its reflectance factor, to `target` in each band: more
  // units for the views that are noisier. Nothing when it is there, or at `most` units of each view.
  UnitRanges unitsFor(double target, std::uint64_t most, const TraceSums& sums, std::uint64_t seed) const;
  // Whether what was found is that good; not when only the `most` ended it.
  bool reached(double target, const TraceSums& sums) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace sunfleck
