#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace sunfleck {

// Corners of a triangle in a mask: u to the right and v up, both 0 .. 1 over the image, which repeats without end.
using MaskCorners = std::array<glm::vec2, 3>;

// An image that cuts leaves out of the triangles that bear them.
struct LeafMask {
  int width = 0, height = 0;         // [pixel], > 0
  std::vector<std::uint8_t> opaque;  // 1 where there is leaf, else 0; rows from top to bottom

  // Whether there is leaf at the point of a triangle with these weights of its second and third corner [1].
  bool at(const MaskCorners& corners, float second, float third) const;
};

// Share of a triangle that is leaf [1], exactly.
double opaqueShare(const LeafMask& mask, const MaskCorners& corners);

// What cuts a leaf triangle out.
struct LeafCut {
  static constexpr std::uint32_t kWhole = ~0u;
  std::uint32_t mask = kWhole;  // of those of the mesh, or kWhole: nothing is cut away
  MaskCorners corners{};
};

// Throws InvalidInput("<what>: ...") on corners that are not finite, beyond kMostMaskRepeats in size, or on one line.
void validate(const MaskCorners& corners, const std::string& what);
inline constexpr float kMostMaskRepeats = 8.f;

}  // namespace sunfleck
