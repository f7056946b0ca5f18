#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace sunfleck {

// An axis-aligned box [m]; empty until something is put in.
struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};

  void include(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void include(const Bounds& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool empty() const { return low.x > high.x; }
  glm::vec3 size() const { return high - low; }
  glm::vec3 centre() const { return 0.5f * (low + high); }
};

}  // namespace sunfleck
