#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "render/reference/camera_trace.hpp"
#include "render/reference/ray_scene.hpp"

namespace sunfleck {

inline constexpr std::uint32_t kNothingSeen = 0xffffffffu;

// (R32) What is seen along lines of sight: of pixel (x, y), at y * width + x, in .x the number of the tree in the stand
// or kNothingSeen, and in .y the triangle of its kind, leaves first and wood after them; 0 where no tree is seen. Works
// in parallel; the same for any number of threads. Throws InvalidInput for pixels out of their ranges and for a
// periodic stand, whose copies have no numbers.
//   within  place in each pixel from its corner, in steps to the right and down; 0 .. 1
std::vector<glm::uvec2> visibleSurfaces(const RayScene& scene, const PixelRays& rays, const glm::vec2& within);

}  // namespace sunfleck
