#include <gtest/gtest.h>

#include "grid/deep_opacity_map.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "render/reference/ray_scene.hpp"

namespace {

using namespace sunfleck;

// Pixels of a tree's map whose line meets another number of leaves by Embree, as a share of all pixels that see leaves.
double disagreement(const TreeMesh& mesh, const Direction& along) {
  const DeepOpacityMap map(mesh, along, 96);
  const RayScene rays(mesh, Stand{}, false);
  std::size_t seen = 0, different = 0;
  for (int y = 0; y < map.size().y; ++y)
    for (int x = 0; x < map.size().x; ++x) {
      const auto by_map = static_cast<int>(map.crossings(x, y).size());
      const int by_rays = rays.crossings(map.inSpace(x, y, -10.f), along);
      seen += by_map > 0 || by_rays > 0;
      different += by_map != by_rays;
    }
  EXPECT_GT(seen, 1000u);
  return static_cast<double>(different) / static_cast<double>(seen);
}

// (D3) (R5) Check the map's counts against an independent count by rays through the pixels' centres. They may differ
// only where a centre lies on a leaf's edge to within the rounding of positions some 10 m from the origin: 1e-6 m, 1e-4
// of a pixel. A line meets some 5 leaves whose edges are 10 pixels long each, so it comes so near to one of them by
// chance once in 500 pixels at the worst. One leaf in 500 miscounted would show as much.
TEST(D3_DeepOpacityMap, CountsAsRaysDo) {
  const TreeMesh crown = randomCrown({.leaves = 3000}, 4);
  for (const Direction& along : spreadAxes(4)) EXPECT_LT(disagreement(crown, along), 2e-3);
  const TreeMesh cherry = grow(species("cherry"), 1);
  EXPECT_LT(disagreement(cherry, {0.f, 0.f, -1.f}), 2e-3);
  EXPECT_LT(disagreement(cherry, spreadAxes(7)[2]), 2e-3);
}

}  // namespace
