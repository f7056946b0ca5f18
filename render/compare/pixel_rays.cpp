#include "render/compare/pixel_rays.hpp"

#include <glm/geometric.hpp>

namespace sunfleck {

PixelRays pixelRays(const Scene& scene) {
  const Camera camera = cameraOf(scene);
  const PixelSteps steps = pixelSteps(camera);
  PixelRays rays{.corner = steps.lower_left + static_cast<float>(camera.height) * steps.up,
                 .right_step = steps.right,
                 .down_step = -steps.up,
                 .sight = viewAxes(camera).along,
                 .width = camera.width,
                 .height = camera.height};
  if (camera.perspective()) {
    rays.eye = eyeOf(camera);
    return rays;
  }
  const Bounds box = bounds(scene);
  // Far enough behind the target to see all in front, and the ground below, without losing digits.
  const float away = 4.f * (glm::length(box.size()) + glm::length(box.centre() - camera.target) + camera.half_width);
  rays.corner += camera.target - away * rays.sight;
  return rays;
}

}  // namespace sunfleck
