#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/directions.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck::detail {

// The faces through which the sun shines into the traced box, and points on them spread evenly by flux.
class SunlitFaces {
 public:
  SunlitFaces(const RayScene::Geometry& scene, Direction sun) {
    // A flat stand still has an inside for the sun to shine into.
    const glm::vec3 size = glm::max(scene.box.size(), glm::vec3(scene.lift));
    for (int axis = 0; axis < 3; ++axis) {
      if (scene.period && axis != 2) continue;
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      Face& face = faces_[static_cast<std::size_t>(axis)];
      face.corner = scene.box.low;
      if (sun[axis] < 0.f) face.corner[axis] = scene.box.high[axis];
      face.first[a] = size[a];
      face.second[b] = size[b];
      face.flux = double{size[a]} * double{size[b]} * std::abs(double{sun[axis]});
      flux_ += face.flux;
    }
    // Rays start a little outside, to meet what lies on the face itself.
    start_ = scene.period ? glm::vec3(0.f, 0.f, scene.high - scene.box.high.z) : -8.f * scene.lift * sun;
  }

  double flux() const { return flux_; }  // for sun irradiance 1 [m^2]

  // The point at (u, v) of [0, 1)^2, which maps to all faces one after the other.
  glm::vec3 start(double u, double v) const {
    double share = u * flux_;
    for (const Face& face : faces_) {
      if (share < face.flux)
        return face.corner + static_cast<float>(share / face.flux) * face.first + static_cast<float>(v) * face.second +
               start_;
      share -= face.flux;
    }
    return faces_[2].corner + faces_[2].first + start_;  // rounding alone leads here
  }

 private:
  struct Face {
    glm::vec3 corner{0.f}, first{0.f}, second{0.f};  // [m]
    double flux = 0.;                                // for sun irradiance 1 [m^2]
  };
  std::array<Face, 3> faces_;  // across x, y and z
  double flux_ = 0.;
  glm::vec3 start_{0.f};
};

}  // namespace sunfleck::detail
