#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/image.hpp"
#include "core/progress.hpp"
#include "render/reference/ray_scene.hpp"
#include "render/reference/trace_effort.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_light.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// A picture's lines of sight: pixel (x, y) of width * height spans `corner + x * right_step + y * down_step` and the
// steps. Those of an orthographic picture pass there along `sight` and see the whole line they lie on; those from an
// eye go to there from it (R30).
struct PixelRays {
  glm::vec3 corner{0.f}, right_step{0.f}, down_step{0.f};  // [m]; with an eye, corner counts from it
  Direction sight{0.f, 0.f, -1.f};                         // unit; with an eye it is not used
  int width = 0, height = 0;
  std::optional<glm::vec3> eye;  // [m]
};

// Throws InvalidInput on sizes and vectors out of their ranges.
void validate(const PixelRays& rays);

// What light a picture shows: all, or none that was scattered more than once.
enum class Followed { all, once };

// Of one band.
struct CameraResult {
  Image radiance;  // channels "Y": radiance per sun irradiance 1 on a plane facing the sun [1/sr], the sky's itself
                   // where nothing is met, and "single.Y": what of it was scattered once
  Image standard_error;  // channel "Y": of the radiance of each pixel
  Estimate mean;         // of all pixels
  std::uint64_t paths = 0;
  double seconds = 0., cpu_seconds = 0.;
};

// (R2, R30) Monte Carlo from the camera to the light, with sun and sky sampled at every hit (R18); where a line of
// sight meets nothing it shows the sky. A unit adds `samples_per_unit` to each pixel of a square tile, evenly spread
// over the pixel. A ground plane without end (albedo > 0) lies at `ground_height` [m] and is seen from above; under a
// periodic stand it must not lie above the bottom of the box.
class CameraJob final : public TraceJob {
 public:
  //   scene  must outlive the job
  // Throws InvalidInput on invalid light, rays or ground height, and on more than kMostBands bands.
  CameraJob(const RayScene& scene, std::vector<TraceLight> bands, const PixelRays& rays, float ground_height,
            int samples_per_unit, Followed followed = Followed::all);
  ~CameraJob() override;

  std::size_t bins() const override;
  std::uint64_t groups() const override;  // tiles
  TraceIdentity identity() const override;
  void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const override;

  std::uint64_t unitsOf(std::uint64_t samples) const;  // that add so many samples to each pixel
  std::uint64_t pathsOf(std::uint64_t unit) const;
  std::vector<CameraResult> results(const TraceSums& sums) const;  // of each band
  // Brings the pixels of a tile up to date in earlier results; their means and paths stay.
  void refresh(std::vector<CameraResult>& results, const TraceSums& sums, std::uint64_t tile) const;
  // What brings the root mean square standard error of the pixels, relative to the mean of the picture, to `target` in
  // each band, in steps: missing units of `seed`, more of them for the tiles that are noisier. None when it is there,
  // or at `most` units of each tile.
  UnitRanges unitsFor(double target, std::uint64_t most, const TraceSums& sums, std::uint64_t seed) const;
  // Whether what was found is that good; not when only the `most` ended it.
  bool reached(double target, const TraceSums& sums) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

// Samples of a unit for a run of so many per pixel: a power of two that leaves several units to tell the error by.
int samplesPerUnit(std::uint64_t samples);

// The whole run in memory; `effort.paths` is rounded up to whole samples of each pixel. When `progress` ends it early,
// the units done until then are the result, at least one; pixels without any are zero.
std::vector<CameraResult> traceCameraBands(const RayScene& scene, const std::vector<TraceLight>& bands,
                                           const PixelRays& rays, float ground_height, const TraceEffort& effort,
                                           const Progress& progress = {});
// The same for one band.
CameraResult traceCamera(const RayScene& scene, const TraceLight& light, const PixelRays& rays, float ground_height,
                         const TraceEffort& effort, const Progress& progress = {});

}  // namespace sunfleck
