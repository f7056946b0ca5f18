#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "render/reference/camera_trace.hpp"

namespace sunfleck::detail {

// Where a picture by parallel rays sees a point.
class PixelOfPoint {
 public:
  explicit PixelOfPoint(const PixelRays& rays)
      : to_pixels_(glm::inverse(glm::mat3(rays.right_step, rays.down_step, rays.sight))),
        corner_(rays.corner),
        width_(rays.width),
        height_(rays.height),
        beam_(std::abs(double{glm::dot(glm::cross(rays.right_step, rays.down_step), rays.sight)})) {}

  // From the picture's first corner, right and down [pixel].
  glm::vec2 place(const glm::vec3& point) const { return glm::vec2(to_pixels_ * (point - corner_)); }
  // Its number, row after row; none outside of the picture.
  std::optional<std::size_t> number(const glm::vec3& point) const {
    const glm::vec2 at = place(point);
    if (!(at.x >= 0.f && at.x < static_cast<float>(width_) && at.y >= 0.f && at.y < static_cast<float>(height_)))
      return std::nullopt;
    return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(at.x);
  }
  double beam() const { return beam_; }  // area of a pixel's beam, across it [m^2]

 private:
  glm::mat3 to_pixels_;
  glm::vec3 corner_;
  int width_, height_;
  double beam_;
};

}  // namespace sunfleck::detail
