#include "grid/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "core/require.hpp"

namespace sunfleck {
namespace {

// How many of the places that are whole periods away from `distance` are at most `reach` away from the origin; of two
// at that very distance, one.
double within(double distance, double reach, double period) {
  return std::floor((reach - distance) / period) - std::floor((-reach - distance) / period);
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

void requireApart(const Stand& stand, std::span<const Bounds> kinds) {
  std::vector<glm::dvec2> halves;  // the shortest period may be rounded
  for (const Bounds& box : kinds) halves.push_back(0.49999 * glm::dvec2(box.size()));
  double most = 0.;
  for (const Placement& tree : stand.trees) {
    double here = 0.;
    for (const Placement& other : stand.trees) {
      const glm::dvec2 away = glm::dvec2(other.position) - glm::dvec2(tree.position);
      const glm::dvec2 half = glm::min(halves[tree.kind], halves[other.kind]);
      here += stand.period
                  ? within(away.x, half.x, double{stand.period->x}) * within(away.y, half.y, double{stand.period->y})
                  : (std::abs(away.x) <= half.x && std::abs(away.y) <= half.y ? 1. : 0.);
    }
    most = std::max(most, here);
  }
  constexpr int kMost = kMostOverlap * kMostOverlap;
  require(most <= kMost, "trees within one tree's width and depth", most,
          "at most " + std::to_string(kMost) + ": no medium is like so many crowns in one place");
}

}  // namespace sunfleck
