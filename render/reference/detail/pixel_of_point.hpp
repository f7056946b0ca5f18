#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "render/reference/camera_trace.hpp"

namespace sunfleck::detail {

// Where a picture sees a point.
class PixelOfPoint {
 public:
  explicit PixelOfPoint(const PixelRays& rays)
      : eye_(rays.eye.has_value()),
        to_pixels_(glm::inverse(glm::mat3(rays.right_step, rays.down_step, eye_ ? rays.corner : rays.sight))),
        from_(eye_ ? *rays.eye : rays.corner),
        to_eye_(-rays.sight),
        width_(rays.width),
        height_(rays.height) {
    const glm::vec3 across = glm::cross(rays.right_step, rays.down_step);
    facing_ = eye_ ? glm::normalize(across) : rays.sight;
    beam_ = std::abs(double{glm::dot(across, facing_)});
  }

  // From the picture's first corner, right and down [pixel]; z: with an eye, how many times as far before it as the
  // plane of the picture's corner [1], above 0 if before it.
  glm::vec3 place(const glm::vec3& point) const {
    const glm::vec3 at = to_pixels_ * (point - from_);
    return eye_ ? glm::vec3(at.x / at.z, at.y / at.z, at.z) : at;
  }

  struct Seen {
    std::size_t pixel;  // number, row after row
    Direction to_eye;
    float beam;  // area of the pixel's beam where the point is, across it, as a share of beam() [1]
  };
  // None outside of the picture.
  std::optional<Seen> seen(const glm::vec3& point) const {
    const glm::vec3 at = place(point);
    const bool inside = at.x >= 0.f && at.x < static_cast<float>(width_) && at.y >= 0.f &&
                        at.y < static_cast<float>(height_) && (!eye_ || at.z > 0.f);
    if (!inside) return std::nullopt;
    Seen seen{
        .pixel = static_cast<std::size_t>(at.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(at.x),
        .to_eye = to_eye_,
        .beam = 1.f};
    if (eye_) {
      seen.to_eye = glm::normalize(from_ - point);
      seen.beam = at.z * at.z * std::abs(glm::dot(facing_, seen.to_eye));
    }
    return seen;
  }
  // Area of a pixel's beam across it; with an eye, on the plane of the picture's corner, across the middle one [m^2].
  double beam() const { return beam_; }
  bool fromEye() const { return eye_; }

 private:
  bool eye_;
  glm::mat3 to_pixels_;
  glm::vec3 from_;    // the eye or the corner
  Direction to_eye_;  // of an orthographic picture
  int width_, height_;
  glm::vec3 facing_{0.f};  // normal of the plane that pixels are even on; of an orthographic picture its sight
  double beam_ = 0.;
};

}  // namespace sunfleck::detail
