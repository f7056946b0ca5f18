#include "render/gl/view.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace sunfleck::gl {
glm::vec2 sampleOffset(int number) {
  if (number == 0) return glm::vec2(0.f);
  const double pair = (number + 1) / 2;  // 1, 1, 2, 2, ...
  const auto place = [&](double step) {
    const double at = 0.5 + pair * step;
    return static_cast<float>(at - std::floor(at) - 0.5);
  };
  const glm::vec2 offset(place(0.7548776662466927), place(0.5698402909980532));
  return number % 2 == 1 ? offset : -offset;
}

glm::mat4 clipFromWorld(const View& view, glm::ivec2 size, float reach) {
  const Camera& camera = view.camera;
  const Axes axes = viewAxes(camera);
  const float pixels = 0.5f * static_cast<float>(camera.width) / camera.half_width;  // per metre at the target
  const glm::vec2 scale = 2.f * pixels / glm::vec2(size);
  // Where the middle of the picture is in the target, from -1 to 1.
  const glm::vec2 middle = 0.5f * glm::vec2(camera.width, camera.height) - glm::vec2(view.low) - view.offset;
  const glm::vec2 shift = 2.f * middle / glm::vec2(size) - 1.f;
  if (!camera.perspective()) {
    const glm::vec3 x = scale.x * axes.right, y = scale.y * axes.up, z = -0.5f / reach * axes.along;
    return glm::transpose(glm::mat4(glm::vec4(x, shift.x - glm::dot(x, camera.target)),
                                    glm::vec4(y, shift.y - glm::dot(y, camera.target)),
                                    glm::vec4(z, 0.5f - glm::dot(z, camera.target)), glm::vec4(0.f, 0.f, 0.f, 1.f)));
  }
  const glm::vec3 eye = eyeOf(camera);
  const float distance = eyeDistance(camera);
  const float near = std::max(1e-3f, 1e-4f * distance);
  const glm::vec3 x = scale.x * distance * axes.right + shift.x * axes.along;
  const glm::vec3 y = scale.y * distance * axes.up + shift.y * axes.along;
  return glm::transpose(glm::mat4(glm::vec4(x, -glm::dot(x, eye)), glm::vec4(y, -glm::dot(y, eye)),
                                  glm::vec4(0.f, 0.f, 0.f, near), glm::vec4(axes.along, -glm::dot(axes.along, eye))));
}

std::array<glm::vec4, 4> sidesOf(const glm::mat4& clip_from_world) {
  const glm::mat4 rows = glm::transpose(clip_from_world);
  return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]};
}

PixelBox pixelsOf(const Bounds& box, const glm::mat4& clip_from_world, glm::ivec2 size) {
  if (box.empty()) return {};
  const glm::vec2 all(size);
  glm::vec2 low = all, high(0.f);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 far(corner & 1, corner & 2, corner & 4);
    const glm::vec4 clip = clip_from_world * glm::vec4(glm::mix(box.low, box.high, far), 1.f);
    if (!(clip.w > 0.f)) return {.low = glm::ivec2(0), .high = size};
    const glm::vec2 pixel = 0.5f * (glm::vec2(clip) / clip.w + 1.f) * all;
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  // A pixel more, for what roundings may do.
  return {.low = glm::ivec2(glm::clamp(glm::floor(low) - 1.f, glm::vec2(0.f), all)),
          .high = glm::ivec2(glm::clamp(glm::ceil(high) + 1.f, glm::vec2(0.f), all))};
}

float pixelsPerMetre(const Camera& camera, float distance) {
  const float at_target = 0.5f * static_cast<float>(camera.width) / camera.half_width;
  return camera.perspective() ? at_target * eyeDistance(camera) / std::max(distance, 1e-3f) : at_target;
}

}  // namespace sunfleck::gl
