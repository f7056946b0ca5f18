#include "core/leaf_patch.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace sunfleck {
namespace {

// Twice the area of the triangle in its images, which are 1 wide and high.
double twiceArea(const ImageCorners& corners) {
  const glm::dvec2 a = glm::dvec2(corners[1]) - glm::dvec2(corners[0]),
                   b = glm::dvec2(corners[2]) - glm::dvec2(corners[0]);
  return std::abs(a.x * b.y - a.y * b.x);
}

constexpr double kLeastTwiceArea = 1e-12;

}  // namespace

bool isUsable(const ImageCorners& corners) {
  return std::ranges::all_of(corners,
                             [](const glm::vec2& corner) {
                               return std::abs(corner.x) <= kMostImageRepeats &&
                                      std::abs(corner.y) <= kMostImageRepeats;
                             }) &&
         twiceArea(corners) > kLeastTwiceArea;
}

void validate(const ImageCorners& corners, const std::string& what) {
  for (const glm::vec2& corner : corners)
    for (int axis = 0; axis < 2; ++axis)
      require(std::abs(corner[axis]) <= kMostImageRepeats, what + ": texture coordinate", corner[axis],
              "finite and at most 8 in size");
  require(twiceArea(corners) > kLeastTwiceArea, what + ": area of its texture coordinates", 0.5 * twiceArea(corners),
          "above 0, as its material has a mask");
}

}  // namespace sunfleck
