#include "render/camera.hpp"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

namespace sunfleck {
namespace {

// Half of the picture's height in the scene, at the target [m].
float halfHeight(const Camera& camera) {
  return camera.half_width * static_cast<float>(camera.height) / static_cast<float>(camera.width);
}

}  // namespace

Axes viewAxes(const Camera& camera) {
  const float ce = std::cos(camera.elevation), se = std::sin(camera.elevation);
  const float ca = std::cos(camera.azimuth), sa = std::sin(camera.azimuth);
  return {.right = {-sa, ca, 0.f}, .up = {-se * ca, -se * sa, ce}, .along = {-ce * ca, -ce * sa, -se}};
}

float eyeDistance(const Camera& camera) {
  assert(camera.perspective());
  return camera.half_width / std::tan(0.5f * camera.field_of_view);
}

glm::vec3 eyeOf(const Camera& camera) {
  return camera.target - eyeDistance(camera) * viewAxes(camera).along;
}

PixelSteps pixelSteps(const Camera& camera) {
  const Axes axes = viewAxes(camera);
  const float pixel = 2.f * camera.half_width / static_cast<float>(camera.width);
  const float ahead = camera.perspective() ? eyeDistance(camera) : 0.f;
  return {.lower_left = ahead * axes.along - camera.half_width * axes.right - halfHeight(camera) * axes.up,
          .right = pixel * axes.right,
          .up = pixel * axes.up};
}

Sight sightThrough(const Camera& camera, const glm::vec2& place) {
  const PixelSteps steps = pixelSteps(camera);
  const glm::vec3 aside =
      steps.lower_left + place.x * steps.right + (static_cast<float>(camera.height) - place.y) * steps.up;
  if (!camera.perspective()) return {.from = camera.target + aside, .along = viewAxes(camera).along};
  return {.from = eyeOf(camera), .along = glm::normalize(aside)};
}

std::array<glm::vec4, 4> sidesOfSight(const Camera& camera) {
  const Axes axes = viewAxes(camera);
  const auto side = [&](const glm::vec3& outward, float half) {
    if (!camera.perspective()) return glm::vec4(-outward, half + glm::dot(outward, camera.target));
    const glm::vec3 inward = glm::normalize(half * axes.along - eyeDistance(camera) * outward);
    return glm::vec4(inward, -glm::dot(inward, eyeOf(camera)));
  };
  const float half_height = halfHeight(camera);
  return {side(-axes.right, camera.half_width), side(axes.right, camera.half_width), side(-axes.up, half_height),
          side(axes.up, half_height)};
}

}  // namespace sunfleck
