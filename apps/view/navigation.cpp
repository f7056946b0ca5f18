#include "apps/view/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sunfleck::view {
namespace {

constexpr float kLeastHalfWidth = 1e-3f, kMostHalfWidth = 1e5f;  // [m]
constexpr float kFarthestGround = 1e5f;                          // [m]
constexpr float kFullTurn = 6.2831853f;

float metresPerPixel(const Camera& camera) {
  return 2.f * camera.half_width / static_cast<float>(camera.width);
}

void turn(Camera& camera, float azimuth, float elevation) {
  camera.azimuth = std::remainder(camera.azimuth + azimuth, kFullTurn);
  camera.elevation = std::clamp(camera.elevation + elevation, -kSteepest, kSteepest);
}

}  // namespace

Camera orbited(Camera camera, float azimuth, float elevation) {
  turn(camera, azimuth, elevation);
  return camera;
}

Camera panned(Camera camera, glm::vec2 pixels) {
  const Axes axes = viewAxes(camera);
  camera.target += metresPerPixel(camera) * (-pixels.x * axes.right + pixels.y * axes.up);
  return camera;
}

Camera zoomed(Camera camera, float factor, glm::vec2 place) {
  const Axes axes = viewAxes(camera);
  const float former = metresPerPixel(camera);
  camera.half_width = std::clamp(camera.half_width * factor, kLeastHalfWidth, kMostHalfWidth);
  const glm::vec2 aside = place - 0.5f * glm::vec2(camera.width, camera.height);
  camera.target += (former - metresPerPixel(camera)) * (aside.x * axes.right - aside.y * axes.up);
  return camera;
}

Camera inPerspective(Camera camera, float field_of_view) {
  camera.field_of_view = field_of_view;
  return camera;
}

Camera orthographic(Camera camera) {
  camera.field_of_view = 0.f;
  return camera;
}

Camera lookedAround(Camera camera, float azimuth, float elevation) {
  if (!camera.perspective()) camera = inPerspective(camera, kWideView);
  const glm::vec3 eye = eyeOf(camera);
  turn(camera, azimuth, elevation);
  camera.target = eye + eyeDistance(camera) * viewAxes(camera).along;
  return camera;
}

Camera flown(Camera camera, float right, float up, float ahead) {
  if (!camera.perspective()) camera = inPerspective(camera, kWideView);
  const Axes axes = viewAxes(camera);
  camera.target += right * axes.right + up * axes.up + ahead * axes.along;
  return camera;
}

Camera walked(Camera camera, float right, float ahead, float ground_height) {
  if (!camera.perspective()) camera = inPerspective(camera, kWideView);
  const Axes axes = viewAxes(camera);
  const glm::vec3 level(-std::cos(camera.azimuth), -std::sin(camera.azimuth), 0.f);  // `along` may be upright
  camera.target += right * axes.right + ahead * level;
  camera.target.z += ground_height + kWalkersEye - eyeOf(camera).z;
  return camera;
}

std::optional<glm::vec3> groundAt(const Camera& camera, glm::vec2 place, float height) {
  const Sight sight = sightThrough(camera, place);
  const float distance = (height - sight.from.z) / sight.along.z;  // infinite along a level sight
  if (!(std::abs(distance) <= kFarthestGround)) return std::nullopt;
  if (camera.perspective() && distance <= 0.f) return std::nullopt;
  return glm::vec3(glm::vec2(sight.from + distance * sight.along), height);
}

std::optional<glm::vec2> pixelOf(const Camera& camera, const glm::vec3& point) {
  const Axes axes = viewAxes(camera);
  const glm::vec3 away = point - camera.target;
  float pixels = 1.f / metresPerPixel(camera);
  if (camera.perspective()) {
    const float depth = eyeDistance(camera) + glm::dot(away, axes.along);
    if (depth <= 1e-3f * eyeDistance(camera)) return std::nullopt;
    pixels *= eyeDistance(camera) / depth;
  }
  return 0.5f * glm::vec2(camera.width, camera.height) +
         pixels * glm::vec2(glm::dot(away, axes.right), -glm::dot(away, axes.up));
}

}  // namespace sunfleck::view
