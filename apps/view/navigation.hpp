#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "render/camera.hpp"

namespace sunfleck::view {

// How the mouse and the keys move the camera.
enum class Navigation { orbit, fly, walk };

inline constexpr float kWalkersEye = 1.7f;      // above the ground [m]
inline constexpr float kWideView = 1.0472f;     // field of view of a camera that had none, 60 degrees [rad]
inline constexpr float kSteepest = 1.5707963f;  // elevation of a camera at most [rad]

// Each gives the moved camera; all that is not named stays.
//   turned about the target; the elevation stops at straight up and down
Camera orbited(Camera camera, float azimuth, float elevation);
//   shifted in the plane of the picture, so that what is under the mouse follows it
//     pixels  right and down
Camera panned(Camera camera, glm::vec2 pixels);
//   nearer by a factor: what is under `place` stays there, as far as it is as far away as the target
//     factor  > 0; below 1 it comes nearer      place  from the upper left corner of the picture [pixel]
Camera zoomed(Camera camera, float factor, glm::vec2 place);

// In perspective, as the following need it: the same picture of all that is as far away as the target.
Camera inPerspective(Camera camera, float field_of_view);
Camera orthographic(Camera camera);
//   turned about the eye: azimuth and elevation of the camera as seen from the target [rad]
Camera lookedAround(Camera camera, float azimuth, float elevation);
//   moved along its own axes [m]
Camera flown(Camera camera, float right, float up, float ahead);
//   moved level, and its eye kWalkersEye above the ground [m]
Camera walked(Camera camera, float right, float ahead, float ground_height);

// Where the line of sight through a place of the picture meets the level ground at this height [m]; none where it does
// not before the eye, or only beyond 1e5 m.
//   place  from the picture's upper left corner, right and down [pixel]
std::optional<glm::vec3> groundAt(const Camera& camera, glm::vec2 place, float height);
// Pixel at which a point is seen, from the upper left corner; none of a point at or behind the eye.
std::optional<glm::vec2> pixelOf(const Camera& camera, const glm::vec3& point);

}  // namespace sunfleck::view
