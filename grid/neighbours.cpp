#include "grid/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/require.hpp"

namespace sunfleck {
namespace {

// Whether the line through the origin along `direction` meets the box centred at `centre`.
bool meets(glm::vec3 centre, glm::vec3 half_size, Direction direction) {
  float enter = -std::numeric_limits<float>::infinity();
  float leave = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1e-9f) {
      if (std::abs(centre[axis]) > half_size[axis]) return false;
      continue;
    }
    const float a = (centre[axis] - half_size[axis]) / direction[axis];
    const float b = (centre[axis] + half_size[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

}  // namespace

glm::ivec2 periodsAround(const Stand& stand, const Bounds& box) {
  if (!stand.period) return {0, 0};
  glm::ivec2 around(0);
  for (int axis = 0; axis < 2; ++axis) {
    const float period = (*stand.period)[axis], width = box.size()[axis];
    require(period * kMostOverlap >= width, "period", period,
            "at least 1/" + std::to_string(kMostOverlap) + " of the tree's width, " + std::to_string(width) + " m");
    around[axis] = static_cast<int>(std::ceil(kWidthsAround * std::max(period, width) / period));
  }
  return around;
}

std::vector<glm::vec3> neighbourDisplacements(const Stand& stand, const Bounds& box, std::size_t index) {
  std::vector<glm::vec3> displacements;
  const glm::ivec2 around = periodsAround(stand, box);
  const glm::vec2 period = stand.period.value_or(glm::vec2(0.f));
  for (std::size_t i = 0; i < stand.trees.size(); ++i)
    for (int row = -around.y; row <= around.y; ++row)
      for (int column = -around.x; column <= around.x; ++column) {
        if (i == index && row == 0 && column == 0) continue;
        const glm::vec3 shift(static_cast<float>(column) * period.x, static_cast<float>(row) * period.y, 0.f);
        displacements.push_back(stand.trees[i].position - stand.trees[index].position + shift);
      }
  return displacements;
}

// Some point of the box reaches the box displaced by t exactly if the line through the origin meets the box of twice
// the size about t: their Minkowski difference.
std::vector<glm::vec3> neighboursAlong(std::span<const glm::vec3> displacements, const Bounds& box,
                                       Direction direction) {
  std::vector<glm::vec3> met;
  for (const glm::vec3& t : displacements)
    if (meets(t, box.size(), direction)) met.push_back(t);
  return met;
}

}  // namespace sunfleck
