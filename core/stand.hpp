#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace sunfleck {

// Where a tree stands, a copy of the prototype of its kind.
struct Placement {
  glm::vec3 position{0.f};  // added to the prototype's vertices [m]
  float rotation = 0.f;     // about the vertical through the prototype's origin, counter-clockwise from above [rad]
  std::uint32_t kind = 0;   // of those of the scene
  bool operator==(const Placement&) const = default;
};

// The arrangement of the trees. With a period, the whole arrangement repeats without end in x and y.
struct Stand {
  std::vector<Placement> trees{Placement{}};
  std::optional<glm::vec2> period{};  // side lengths of the repeated rectangle [m], > 0
  bool operator==(const Stand&) const = default;
};

}  // namespace sunfleck
