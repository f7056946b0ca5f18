#pragma once

#include "render/reference/camera_trace.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// (R30) The lines of sight of the scene's camera, for Monte Carlo.
PixelRays pixelRays(const Scene& scene);

}  // namespace sunfleck
