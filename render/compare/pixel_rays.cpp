#include "render/compare/pixel_rays.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace sunfleck {

PixelRays pixelRays(const Scene& scene) {
  const Camera camera = cameraOf(scene);
  const Axes view = viewAxes(camera);
  const float pixel = 2.f * camera.half_width / static_cast<float>(camera.width);
  const float half_height = 0.5f * pixel * static_cast<float>(camera.height);
  PixelRays rays{.right_step = pixel * view.right,
                 .down_step = -pixel * view.up,
                 .sight = view.along,
                 .width = camera.width,
                 .height = camera.height};
  const glm::vec3 aside = half_height * view.up - camera.half_width * view.right;  // of the corner
  if (camera.perspective()) {
    rays.eye = eyeOf(camera);
    rays.corner = camera.half_width / std::tan(0.5f * camera.field_of_view) * view.along + aside;
    return rays;
  }
  const Bounds box = bounds(scene);
  // Far enough behind the target to see all in front, and the ground below, without losing digits.
  const float away = 4.f * (glm::length(box.size()) + glm::length(box.centre() - camera.target) + camera.half_width);
  rays.corner = camera.target - away * view.along - camera.half_width * view.right + half_height * view.up;
  return rays;
}

}  // namespace sunfleck
