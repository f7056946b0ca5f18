#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace sunfleck::detail {

// A triangle, or two that make up a parallelogram: `corner` + u `first` + v `second`.
struct Facet {
  glm::dvec3 corner, first, second;  // [m]
  bool parallelogram = false;
  std::uint32_t primitive = 0;  // among those of the leaves, or of the wood
  bool wood = false;
};

}  // namespace sunfleck::detail
