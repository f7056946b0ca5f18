#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/directions.hpp"
#include "grid/deep_opacity_map.hpp"

namespace sunfleck::gl {

// The plain arrays of a prototype's deep opacity map along the sun (D3), as the shaders read them.
struct SunMap {
  Axes axes;                             // `along`: the direction in which sunlight travels
  glm::vec3 origin{0.f};                 // (right, up, depth) of the prototype's origin [m]
  glm::vec2 corner{0.f};                 // (right, up) of pixel (0, 0)'s outer corner [m]
  float pixel_size = 1.f;                // [m], > 0
  glm::ivec2 size{0};                    // [pixel]
  std::span<const std::uint32_t> first;  // those of pixel i are crossings[first[i]] .. crossings[first[i + 1] - 1]
  std::span<const Crossing> crossings;   // sorted by depth within a pixel
  std::span<const float> wood_depth;     // per pixel; infinity where there is no wood [m]

  // (right, up, depth) of a displacement [m].
  glm::vec3 alongAxes(glm::vec3 displacement) const {
    return {glm::dot(displacement, axes.right), glm::dot(displacement, axes.up), glm::dot(displacement, axes.along)};
  }
};

}  // namespace sunfleck::gl
