#include "render/reference/visible_surfaces.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/require.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of a square picture about the origin, 6 m wide.
PixelRays linesAlong(const Direction& sight, int side) {
  const Axes axes = axesAlong(sight);
  const float pixel = 6.f / static_cast<float>(side);
  return {.corner = -3.f * (axes.right + axes.up) - 50.f * sight,
          .right_step = pixel * axes.right,
          .down_step = pixel * axes.up,
          .sight = sight,
          .width = side,
          .height = side,
          .eye = std::nullopt};
}
// The same picture seen from an eye that far away.
PixelRays linesFrom(float distance, const Direction& sight, int side) {
  PixelRays rays = linesAlong(sight, side);
  rays.corner += (50.f + distance) * sight;
  rays.eye = -distance * sight;
  return rays;
}
constexpr glm::vec2 kWithin(0.25f, 0.75f);

struct Line {
  glm::dvec3 from, along;
};
Line lineOf(const PixelRays& rays, int x, int y) {
  const glm::dvec3 place = glm::dvec3(rays.corner) + (x + double{kWithin.x}) * glm::dvec3(rays.right_step) +
                           (y + double{kWithin.y}) * glm::dvec3(rays.down_step);
  if (!rays.eye) return {place, rays.sight};
  return {*rays.eye, glm::normalize(place)};
}

// Distance at which a line meets a triangle, infinite where it does not (Moeller & Trumbore 1997).
double distanceTo(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const Line& line) {
  const glm::dvec3 p = glm::cross(line.along, c - a), q = glm::cross(line.from - a, b - a);
  const double determinant = glm::dot(b - a, p);
  const double u = glm::dot(line.from - a, p) / determinant, v = glm::dot(line.along, q) / determinant;
  const double t = glm::dot(c - a, q) / determinant;
  return u >= 0. && v >= 0. && u + v <= 1. && t > 0. ? t : kInfinity;
}

// What a line sees first, every triangle of every tree tried.
glm::uvec2 firstOf(std::span<const TreeMesh* const> kinds, const Stand& stand, const Line& line) {
  glm::uvec2 seen(kNothingSeen, 0u);
  double nearest = kInfinity;
  for (std::uint32_t i = 0; i < stand.trees.size(); ++i) {
    const Placement& tree = stand.trees[i];
    const TreeMesh& mesh = *kinds[tree.kind];
    const double c = std::cos(double{tree.rotation}), s = std::sin(double{tree.rotation});
    const auto placed = [&](std::uint32_t vertex) {
      const glm::dvec3 v = mesh.vertices[vertex];
      return glm::dvec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z) + glm::dvec3(tree.position);
    };
    std::uint32_t number = 0;
    for (const auto* triangles : {&mesh.leaf_triangles, &mesh.wood_triangles})
      for (const glm::uvec3& t : *triangles) {
        const double distance = distanceTo(placed(t.x), placed(t.y), placed(t.z), line);
        if (distance < nearest) {
          nearest = distance;
          seen = {i, number};
        }
        ++number;
      }
  }
  return seen;
}

// Leaves with a trunk.
TreeMesh trunkAndLeaves(int leaves, std::uint64_t seed) {
  TreeMesh mesh = leafBox(leaves, seed);
  addPolygon(mesh, mesh.wood_triangles, rectangle({0, 0, -0.75f}, {0.2f, 0, 0}, {0, 0.1f, 0.5f}));
  addPolygon(mesh, mesh.wood_triangles, rectangle({0, 0, -0.75f}, {0, 0.2f, 0}, {0, 0, 0.5f}));
  finish(mesh, "tree");
  return mesh;
}

}  // namespace

// (R32) Check what is seen of trees of two kinds, turned and moved, by parallel lines and from an
// eye, beside and among the trees, against every triangle tried in double precision. A line that passes an edge within
// rounding (1e-6 m of 1e-1 m, some 10 edges in sight of each line: 1e-4) could differ: 10 of 10,000 at the most.
TEST(R32_VisibleSurfaces, AreTheFirstOfAllTriangles) {
  const TreeMesh one = trunkAndLeaves(40, 4), other = trunkAndLeaves(30, 5);
  const std::array kinds{&one, &other};
  const Stand stand{.trees = {{.position = {0.5f, 0.f, 0.25f}, .rotation = 0.f, .kind = 1},
                              {.position = {0.f, 1.5f, 0.f}, .rotation = 2.1f},
                              {.position = {-1.f, -1.f, 0.2f}, .rotation = -1.f, .kind = 1}}};
  const RayScene scene(kinds, stand, true);
  constexpr int kSide = 50;
  const Direction slanting = glm::normalize(glm::vec3(1.f, 2.f, -1.f));
  int different = 0;
  std::array<int, 3> of{};  // lines that see leaves, wood, nothing
  for (const PixelRays& rays : {linesAlong({0.f, 0.f, -1.f}, kSide), linesAlong(slanting, kSide),
                                linesFrom(4.f, slanting, kSide), linesFrom(0.5f, slanting, kSide)}) {
    const std::vector<glm::uvec2> seen = visibleSurfaces(scene, rays, kWithin);
    ASSERT_EQ(seen.size(), std::size_t{kSide} * kSide);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const glm::uvec2 expected = firstOf(kinds, stand, lineOf(rays, x, y));
        different += seen[static_cast<std::size_t>(y * kSide + x)] != expected;
        if (expected.x == kNothingSeen)
          ++of[2];
        else
          ++of[expected.y >= kinds[stand.trees[expected.x].kind]->leaf_triangles.size()];
      }
  }
  EXPECT_LE(different, 10);
  for (const int lines : of) EXPECT_GT(lines, 20);
}

// Check that a tree alone, which Embree holds without an instance, is tree 0, also far from the world's origin and in a
// picture whose sides are no multiples of what is looked at together.
TEST(R32_VisibleSurfaces, OfOneTreeFarAway) {
  TreeMesh leaf;
  addPolygon(leaf, leaf.leaf_triangles, rectangle({0, 0, 0}, {1.25f, 0, 0}, {0, 3, 0}));
  finish(leaf, "leaf");
  const RayScene scene(std::array<const TreeMesh*, 1>{&leaf}, Stand{.trees = {{.position = {5000.f, 0.f, 0.f}}}}, true);
  PixelRays rays = linesAlong({0.f, 0.f, -1.f}, 6);
  rays.corner.x += 5000.f;
  rays.height = 5;
  const std::vector<glm::uvec2> seen = visibleSurfaces(scene, rays, {0.5f, 0.5f});
  ASSERT_EQ(seen.size(), 30u);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::size_t column = i % 6;
    EXPECT_EQ(seen[i].x, column >= 2 && column <= 3 ? 0u : kNothingSeen) << i;
  }
}

TEST(R32_VisibleSurfaces, RefusesWhatHasNoNumbers) {
  const TreeMesh tree = leafBox(5, 1);
  const RayScene periodic(tree, Stand{.period = glm::vec2(3.f)}, true);
  EXPECT_THROW(visibleSurfaces(periodic, linesAlong({0.f, 0.f, -1.f}, 4), kWithin), InvalidInput);
  PixelRays empty = linesAlong({0.f, 0.f, -1.f}, 4);
  empty.width = 0;
  EXPECT_THROW(visibleSurfaces(RayScene(tree, Stand{}, true), empty, kWithin), InvalidInput);
}
