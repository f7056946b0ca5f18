#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace sunfleck::detail {

// Appends the triangles of a polygon, given by `corners`, indices of `vertices`: by cutting ears in the plane of its
// mean normal (Newell), so that a plane polygon, convex or not, keeps its area. O(n^2) to O(n^3).
void triangulate(const std::vector<glm::vec3>& vertices, std::span<const std::uint32_t> corners,
                 std::vector<glm::uvec3>& triangles);

}  // namespace sunfleck::detail
