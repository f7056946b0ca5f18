#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/leaf_mask.hpp"

namespace sunfleck::detail {

// The leaf of a mask as triangles.
struct MaskTriangles {
  std::vector<glm::dvec2> corners;    // u to the right and v up, 0 .. 1 over the image
  std::vector<glm::uvec3> triangles;  // counter-clockwise there
};

// Outlines of the mask's leaf, simplified, without specks, cut into triangles. Their area is the mask's to about a
// percent. Throws InvalidInput("<source>: mask ...") on a mask without leaf, and on one so torn that it takes too many
// triangles.
MaskTriangles trianglesOf(const LeafMask& mask, const std::string& source);

}  // namespace sunfleck::detail
