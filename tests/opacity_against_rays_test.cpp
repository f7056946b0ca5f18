#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

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

// Distance from a line along the map's direction to the nearest edge of a leaf's triangle [m].
double distanceToEdge(const TreeMesh& mesh, const DeepOpacityMap& map, glm::vec3 on_line) {
  const Axes& axes = map.axes();
  const auto projected = [&](glm::dvec3 point) {
    return glm::dvec2(glm::dot(point, glm::dvec3(axes.right)), glm::dot(point, glm::dvec3(axes.up)));
  };
  const glm::dvec2 p = projected(on_line);
  double nearest = 1e9;
  for (const glm::uvec3& t : mesh.leaf_triangles)
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 a = projected(mesh.vertices[t[i]]), b = projected(mesh.vertices[t[(i + 1) % 3]]);
      const double share = glm::clamp(glm::dot(p - a, b - a) / std::max(1e-30, glm::dot(b - a, b - a)), 0., 1.);
      nearest = std::min(nearest, glm::length(p - a - share * (b - a)));
    }
  return nearest;
}

struct LeafCounts {
  std::size_t all = 0, different = 0, unexplained = 0;
};

// Compares n+ and n- at leaves, each where a pixel's line meets it, with the numbers of leaves that rays from there
// find back to the light and onward: about `samples` crossings of the map.
LeafCounts compareAtLeaves(const TreeMesh& mesh, const RayScene& rays, const DeepOpacityMap& map, std::size_t samples) {
  const glm::vec3 largest = glm::max(glm::abs(rays.box().low), glm::abs(rays.box().high));
  const double rounding = 8. * 0x1p-23 * double{std::max({largest.x, largest.y, largest.z})};
  LeafCounts result;
  std::size_t crossing = 0;
  for (int y = 0; y < map.size().y; ++y)
    for (int x = 0; x < map.size().x; ++x)
      for (const Crossing& here : map.crossings(x, y)) {
        if (crossing++ % (1 + map.crossings().size() / samples) != 0) continue;
        const glm::vec3 point = map.inSpace(x, y, here.depth);
        const DeepOpacityMap::Counts counts = map.counts(point, here.leaf);
        ++result.all;
        if (counts.before == rays.crossings(point, -map.along(), here.leaf) &&
            counts.beyond == rays.crossings(point, map.along(), here.leaf))
          continue;
        ++result.different;
        result.unexplained += distanceToEdge(mesh, map, point) > rounding;
      }
  return result;
}

// (D3) (R5) Check that the map tells n+ and n- at the leaves exactly: only on lines that meet a leaf's edge to within
// the rounding of positions, 8 units in the last place of the largest, may rays find another number.
TEST(D3_DeepOpacityMap, IsExactAtEveryLeaf) {
  const auto check = [](const TreeMesh& mesh, std::initializer_list<int> resolutions) {
    const RayScene rays(mesh, Stand{}, false);
    for (const Direction& along : {Direction(0.f, 0.f, -1.f), spreadAxes(7)[2], -spreadAxes(7)[4]})
      for (const int resolution : resolutions) {
        const LeafCounts counts = compareAtLeaves(mesh, rays, DeepOpacityMap(mesh, along, resolution), 1500);
        EXPECT_GT(counts.all, 700u);
        EXPECT_LE(counts.different, counts.all / 500);  // as above; of all 1.8 million crossings 68 are
        EXPECT_EQ(counts.unexplained, 0u);
      }
  };
  check(randomCrown({.leaves = 3000}, 4), {64, 512});
  check(grow(species("cherry"), 1), {64, 512});
  check(grow(species("maple"), 1), {150});
}

}  // namespace
