#include "render/scene_medium.hpp"

#include <cmath>

namespace sunfleck {

Bounds bounds(const SceneMedium& medium, const std::optional<glm::vec2>& period, const glm::vec2& about) {
  Bounds box = medium.bounds();
  for (int axis = 0; axis < 2; ++axis) {
    if (std::isfinite(box.low[axis])) continue;
    const float half = period ? 0.5f * (*period)[axis] : 0.5f;
    box.low[axis] = about[axis] - half;
    box.high[axis] = about[axis] + half;
  }
  return box;
}

}  // namespace sunfleck
