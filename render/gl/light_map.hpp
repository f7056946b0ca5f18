#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/directions.hpp"
#include "grid/deep_opacity_map.hpp"
#include "render/gl/opacity_maps.hpp"

namespace sunfleck::gl {

// The plain arrays of a kind's deep opacity map along a light (D3), as the shaders read them.
struct LightMap {
  Axes axes;                             // `along`: the direction in which the light travels
  glm::vec3 origin{0.f};                 // (right, up, depth) of the prototype's origin [m]
  glm::vec2 corner{0.f};                 // (right, up) of pixel (0, 0)'s outer corner [m]
  float pixel_size = 1.f;                // [m], > 0
  glm::ivec2 size{0};                    // [pixel]
  std::span<const std::uint32_t> first;  // those of pixel i are crossings[first[i]] .. crossings[first[i + 1] - 1]
  std::span<const Crossing> crossings;   // sorted by depth within a pixel
  std::span<const float> wood_depth;     // per pixel; infinity where there is no wood [m]
  std::uint64_t revision = 1;            // another whenever the content is another (core/revision.hpp)
  const OpacityMap* made = nullptr;      // the same on the graphics card, if it made the map
};
LightMap lightMap(const DeepOpacityMap& map, std::uint64_t revision = 1);

// (right, up, depth) of a displacement [m].
inline glm::vec3 alongAxes(const Axes& axes, const glm::vec3& displacement) {
  return {glm::dot(displacement, axes.right), glm::dot(displacement, axes.up), glm::dot(displacement, axes.along)};
}

}  // namespace sunfleck::gl
