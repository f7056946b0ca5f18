#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/directions.hpp"

namespace sunfleck::gl {

// A tree that may stand in the light, or its copy in another period.
struct Caster {
  glm::vec3 position{0.f};  // [m]
  std::uint32_t tree = 0;   // of the stand
};

// A rectangle across a light [m].
struct LightBox {
  glm::vec2 low{0.f}, high{0.f};
};

// (R4) Which trees may stand in the light of a place: those whose maps the line along the light through the place may
// meet. The plane across the light is divided into square cells that list them.
struct LightGrid {
  glm::vec2 low{0.f};                      // corner of cell (0, 0) [m]
  float cell_size = 1.f;                   // [m]
  glm::ivec2 size{1};                      // [cell]
  std::vector<std::uint32_t> first{0, 0};  // those of cell i are casters[first[i]] .. casters[first[i + 1] - 1]
  std::vector<std::uint32_t> casters;      // numbers, ascending in each cell
};

//   casters  their maps' rectangles, with all that is read of them
//   lit      what places can be asked for; beyond it are no lists
LightGrid lightGrid(std::span<const LightBox> casters, const LightBox& lit);

// The picture of a box along a light.
LightBox across(const Axes& axes, const Bounds& box);

}  // namespace sunfleck::gl
