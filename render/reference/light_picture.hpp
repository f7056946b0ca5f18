#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/reference/camera_trace.hpp"

namespace sunfleck {

// (R23) What light scattered more than once adds to a camera's picture, by paths from the light: wherever a path meets
// something again, what that sends to the camera is added to the pixel that sees the place. A path passes before many
// pixels, so that of a stand seen as a whole the picture is less noisy than one by paths from the camera (R2), in the
// same time.
class LightPictureJob final : public TraceJob {
 public:
  // Whether such paths bring all of that light, and most of them into the picture: a stand without period over a black
  // ground, seen whole or by half at least.
  static bool suits(const RayScene& scene, const std::vector<TraceLight>& bands, const PixelRays& rays);

  //   scene  must outlive the job
  // Throws InvalidInput on invalid light or rays, more than kMostBands bands, a periodic stand, and a ground that
  // reflects: the light that it sends up comes from everywhere.
  LightPictureJob(const RayScene& scene, std::vector<TraceLight> bands, const PixelRays& rays,
                  std::uint64_t paths_per_unit);
  ~LightPictureJob() override;

  std::size_t bins() const override;
  TraceIdentity identity() const override;
  void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const override;

  std::vector<CameraResult> results(const TraceSums& sums) const;  // of each band; "single.Y" is 0
  // Root mean square standard error of the pixels of the noisiest band, relative to the mean of the whole picture.
  //   once  means of the bands' radiance that was scattered once, which the picture has besides [1/sr]
  double relativeError(const TraceSums& sums, const std::vector<double>& once) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

// The whole picture of each band: what was scattered once, by paths from the camera, and the rest.
std::vector<CameraResult> together(std::vector<CameraResult> once, const std::vector<CameraResult>& more);

}  // namespace sunfleck
