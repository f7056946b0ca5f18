#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "core/bounds.hpp"
#include "core/leaf_optics.hpp"
#include "grid/density_grid.hpp"
#include "leaves/leaf_description.hpp"

namespace sunfleck {

// What fills space in a scene: leaves so small that there is no end of them, or particles. It stands once, and in a
// periodic stand once in each period.
struct SceneMedium {
  static constexpr float kEndless = std::numeric_limits<float>::infinity();

  bool particles = false;
  LeafDescription description{};  // of the leaves, from which the optics follow unless it is by numbers
  BandOptics optics;              // of the leaves; of particles the reflectance is the albedo
  float asymmetry = 0.f;          // of particles, g of Henyey and Greenstein [1], -1 < g < 1
  std::string angles;             // of leaves: LeafAngles::named(); empty: as the grid says, or spherical
  // The same everywhere in a box; along x and y it may have no end in a periodic stand.
  Bounds box{.low = glm::vec3(-kEndless), .high = glm::vec3(kEndless)};  // [m]
  float density = 0.f;  // leaf area density, or extinction by particles [1/m]
  // Or else cells, cut to the box, whose densities count times the density above.
  std::shared_ptr<const DensityGrid> grid{};
  std::string source{};  // of the grid, for people

  // Box of what is not empty [m].
  Bounds bounds() const {
    if (!grid) return box;
    const Bounds cells = grid->occupied();
    return {.low = glm::max(cells.low, box.low), .high = glm::min(cells.high, box.high)};
  }
};

// The same cut to a period about this place where it has no end [m].
Bounds bounds(const SceneMedium& medium, const std::optional<glm::vec2>& period, const glm::vec2& about);

}  // namespace sunfleck
