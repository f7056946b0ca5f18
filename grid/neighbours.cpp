#include "grid/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunfleck {
namespace {

// Whether the ray from the origin along `direction` meets the box centred at `centre`.
bool meets(glm::vec3 centre, glm::vec3 half_size, Direction direction, bool both_ways) {
  float enter = both_ways ? -std::numeric_limits<float>::infinity() : 0.f;
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

std::vector<glm::vec3> neighbourDisplacements(const Stand& stand, std::size_t index) {
  std::vector<glm::vec3> displacements;
  const int around = stand.period ? kPeriodsAround : 0;
  for (std::size_t i = 0; i < stand.trees.size(); ++i)
    for (int row = -around; row <= around; ++row)
      for (int column = -around; column <= around; ++column) {
        if (i == index && row == 0 && column == 0) continue;
        glm::vec3 displacement = stand.trees[i].position - stand.trees[index].position;
        if (stand.period)
          displacement +=
              glm::vec3(static_cast<float>(column) * stand.period->x, static_cast<float>(row) * stand.period->y, 0.f);
        displacements.push_back(displacement);
      }
  return displacements;
}

// Some point of the box reaches the box displaced by t exactly if the ray from the origin meets the box of twice the
// size about t: their Minkowski difference.
std::vector<glm::vec3> neighboursAlong(std::span<const glm::vec3> displacements, const Bounds& box, Direction direction,
                                       bool both_ways) {
  std::vector<glm::vec3> met;
  for (const glm::vec3& t : displacements)
    if (meets(t, box.size(), direction, both_ways)) met.push_back(t);
  return met;
}

}  // namespace sunfleck
