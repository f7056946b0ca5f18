#pragma once

#include <glm/vec3.hpp>

namespace sunfleck {

// Linear RGB of BT.709 (sRGB's primaries and white, IEC 61966-2-1) from CIE XYZ. Colours outside of what the primaries
// can mix have negative components.
inline glm::dvec3 linearRgb(const glm::dvec3& xyz) {
  return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z, -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
          0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

}  // namespace sunfleck
