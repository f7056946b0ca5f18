#pragma once

#include <cstdint>
#include <vector>

#include "core/leaf_patch.hpp"

namespace sunfleck {

// An image that cuts leaves out of the triangles that bear them.
struct LeafMask {
  int width = 0, height = 0;         // [pixel], > 0
  std::vector<std::uint8_t> opaque;  // 1 where there is leaf, else 0; rows from top to bottom

  // Whether there is leaf at the point of a triangle with these weights of its second and third corner [1].
  bool at(const ImageCorners& corners, float second, float third) const;
};

// Share of a triangle that is leaf [1], exactly.
double opaqueShare(const LeafMask& mask, const ImageCorners& corners);

}  // namespace sunfleck
