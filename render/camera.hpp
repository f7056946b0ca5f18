#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/directions.hpp"

namespace sunfleck {

// A camera that looks at a point: orthographic, or from an eye in perspective (R30).
struct Camera {
  glm::vec3 target{0.f};          // point in the middle of the picture [m]
  float elevation = 0.f;          // of the camera as seen from the target [rad], -pi/2 .. pi/2
  float azimuth = 0.f;            // of the camera as seen from the target, from +x towards +y [rad]
  float half_width = 1.f;         // half of the picture's width in the scene, in perspective at the target [m], > 0
  float field_of_view = 0.f;      // of the picture's width [rad], 0: orthographic
  int width = 512, height = 512;  // [pixel], > 0

  bool perspective() const { return field_of_view > 0.f; }
  bool operator==(const Camera&) const = default;
};

// Where a scene is looked at from unless it says so: somewhat from above, 10 degrees, and aside, 20 degrees.
inline constexpr Camera kOverview{.elevation = 0.1745f, .azimuth = 0.3491f};

// Right and up of the picture, and the direction of sight of its middle. Seen as people see, right x up points at the
// eye, so that these axes are left-handed: right x up = -along.
Axes viewAxes(const Camera& camera);

// Of a camera in perspective: from its eye to the target, and where its eye is [m].
float eyeDistance(const Camera& camera);
glm::vec3 eyeOf(const Camera& camera);

// The picture in the plane through the target that faces the camera [m].
struct PixelSteps {
  glm::vec3 lower_left;  // of the picture, from the eye, or for parallel lines of sight from the target
  glm::vec3 right, up;   // from a pixel to the next
};
PixelSteps pixelSteps(const Camera& camera);

// A line of sight.
struct Sight {
  glm::vec3 from;   // on the plane through the target that faces the camera, or the eye [m]
  Direction along;  // of unit length, away from the camera
};
// (R30) The line of sight through a place of the picture.
//   place  from the picture's upper left corner, right and down [pixel]
Sight sightThrough(const Camera& camera, const glm::vec2& place);

// Left, right, bottom and top of what the camera sees: dot(xyz, point) + w >= 0 on the side that it does, xyz of unit
// length, so that it is the distance to the side [m].
std::array<glm::vec4, 4> sidesOfSight(const Camera& camera);

}  // namespace sunfleck
