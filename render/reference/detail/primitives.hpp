#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "render/reference/detail/embree_calls.hpp"

namespace sunfleck::detail {

inline constexpr unsigned kLeaves = 0, kWood = 1;  // Embree's geometry numbers

// What Embree tests as one: triangles, or quads of two triangles with an edge in common, which most leaves of plant
// models are. A quad 0 1 2 3 is the triangles 0 1 3 and 2 3 1; a triangle among quads has its last corner twice.
struct Primitives {
  std::size_t each = 3;                       // corners
  std::vector<std::uint32_t> corners;         // `each` of every primitive, as indices of the mesh's vertices
  std::vector<std::uint32_t> first_triangle;  // of every primitive, in the mesh

  bool quads() const { return each == 4; }
  bool pair(std::size_t i) const { return quads() && corners[4 * i + 2] != corners[4 * i + 3]; }
};

// As Embree has them.
const glm::vec3* verticesOf(RTCScene scene, unsigned number);

Primitives alone(std::span<const glm::uvec3> triangles);
// As quads where most triangles have an edge in common with the one that follows, of the same leaf and facing the same
// side of it; else alone.
//   leaf  of each triangle; empty for wood
Primitives paired(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> leaf);

}  // namespace sunfleck::detail
