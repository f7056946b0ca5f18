#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "plants/detail/leaf_or_wood.hpp"

namespace sunfleck::detail {

// Triangles as a file has them, in its units and axes, before it is told what of them is leaf.
struct NamedTriangles {
  static constexpr std::uint32_t kNoTexture = ~0u;

  std::vector<glm::vec3> vertices;
  std::vector<glm::vec2> texture;           // u to the right and v up, 0 .. 1 over an image
  std::vector<glm::uvec3> triangles;        // corners, as indices of `vertices`
  std::vector<glm::uvec3> texture_corners;  // of each triangle, as indices of `texture`; or
                                            // kNoTexture; empty where nothing has any
  std::vector<std::uint32_t> part_of_triangle;
  std::vector<Part> parts;
};

}  // namespace sunfleck::detail
