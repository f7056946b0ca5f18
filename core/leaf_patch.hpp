#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <string>

namespace sunfleck {

// Corners of a triangle in the images of its leaf: u to the right and v up, both 0 .. 1 over an image, which repeats
// without end.
using ImageCorners = std::array<glm::vec2, 3>;

// The part of its leaf's images that a leaf triangle shows: of the mask that cuts the leaf out, and of maps.
struct LeafPatch {
  static constexpr std::uint32_t kNoMask = ~0u;
  ImageCorners corners{};
  std::uint32_t mask = kNoMask;  // of those of the mesh, or kNoMask: nothing is cut away
};

inline constexpr float kMostImageRepeats = 8.f;

// Whether they are finite, at most kMostImageRepeats in size, and not on one line.
bool isUsable(const ImageCorners& corners);
// Throws InvalidInput("<what>: ...") where they are not.
void validate(const ImageCorners& corners, const std::string& what);

}  // namespace sunfleck
