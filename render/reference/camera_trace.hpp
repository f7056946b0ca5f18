#pragma once

#include "core/image.hpp"
#include "render/reference/forward_trace.hpp"

namespace sunfleck {

// An orthographic picture's rays: pixel (x, y) of width * height spans `corner + x * right_step + y * down_step` and
// the steps; all rays travel along `sight`, a unit vector, and see the whole line they lie on.
struct PixelRays {
  glm::vec3 corner{0.f}, right_step{0.f}, down_step{0.f};  // [m]
  Direction sight{0.f, 0.f, -1.f};
  int width = 0, height = 0;
};

struct CameraResult {
  Image radiance;        // channel "Y": radiance per sun irradiance 1 on a plane facing the sun [1/sr]
  Image standard_error;  // channel "Y": of the radiance of each pixel
  Estimate mean;         // of all pixels
  std::uint64_t paths = 0;
  double seconds = 0., cpu_seconds = 0.;
};

// (R2) Monte Carlo from the camera to the sun, with the sun sampled at every hit, before a black sky. Every pass adds
// four samples to each pixel, one in each quarter of it; `effort.paths` is rounded up to whole passes. A ground plane
// without end (albedo > 0) lies at `ground_height` [m] and is seen from above; under a periodic stand it must not lie
// above the bottom of the box. When `progress` ends it early, the passes done until then are the result, at least one.
// Throws InvalidInput on invalid light, effort, rays or ground height.
CameraResult traceCamera(const RayScene& scene, const TraceLight& light, const PixelRays& rays, float ground_height,
                         const TraceEffort& effort, const Progress& progress = {});

}  // namespace sunfleck
