// Check that the grid of facets tells of what stands in the way of parallel light what Embree tells, wherever it is
// used, and that it leaves to Embree what it is not for.
#include "render/reference/detail/parallel_shadows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/random.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::detail;
using namespace sunfleck::shapes;

namespace {

// Leaves of all kinds: discs of ten triangles, rectangles, which are quads, and bent quads; and a trunk.
TreeMesh mixedTree() {
  TreeMesh mesh = leafBox(60, 3);
  Random random(5, 0);
  for (int i = 0; i < 120; ++i) {
    const glm::vec3 centre(2.f * random.uniform() - 1.f, random.uniform() - 0.5f, random.uniform() - 0.5f);
    const Axes axes = axesAlong(onSphere(random));
    std::vector<glm::vec3> corners = rectangle(centre, 0.08f * axes.right, 0.05f * axes.up);
    if (i % 2 == 0) corners[2] += 0.03f * axes.along;
    addPolygon(mesh, mesh.leaf_triangles, corners);
  }
  addPolygon(mesh, mesh.wood_triangles, rectangle({0.f, 0.f, 0.f}, {0.03f, 0.f, 0.f}, {0.f, 0.f, 0.5f}));
  mesh.leaf_of_triangle.clear();
  mesh.leaf_count = 0;
  finish(mesh, "mixed tree");
  return mesh;
}

// Points on both sides of surfaces, as rays in all directions find them, and some in the air.
std::vector<glm::vec3> points(const RayScene::Geometry& scene) {
  Random random(7, 0);
  std::vector<glm::vec3> found;
  while (found.size() < 20'000) {
    const glm::vec3 at(random.uniform(), random.uniform(), random.uniform());
    const glm::vec3 from = scene.box.low + at * scene.box.size();
    found.push_back(from);
    const Hit hit = scene.closest(from, onSphere(random), Coherence::incoherent);
    if (hit.surface == Surface::none) continue;
    found.push_back(scene.leave(hit.position, hit.normal));
    found.push_back(scene.leave(hit.position, -hit.normal));
  }
  return found;
}

void expectAsEmbree(const TreeMesh& mesh, const Stand& stand, bool with_wood) {
  setenv("SUNFLECK_SIMD", "baseline", 1);  // single rays are then Embree's (R36)
  const RayScene of(mesh, stand, with_wood);
  unsetenv("SUNFLECK_SIMD");
  const RayScene::Geometry& scene = of.geometry();
  const std::vector<glm::vec3> from = points(scene);
  Random random(9, 0);
  std::vector<glm::vec3> directions{{0.f, 0.f, 1.f}, {0.f, 0.f, -1.f}, {1.f, 0.f, 0.f}, {0.f, -1.f, 0.f}};
  for (int i = 0; i < 4; ++i) directions.push_back(onSphere(random));
  int asked = 0, blocked = 0, otherwise = 0;
  for (const glm::vec3& to : directions) {
    const ParallelShadows shadows(scene, to);
    ASSERT_FALSE(shadows.asksEmbree());
    for (const glm::vec3& point : from) {
      const bool is_blocked = shadows.blocked(point);
      ++asked;
      blocked += is_blocked;
      otherwise += is_blocked != scene.blocked(point, to);
    }
  }
  EXPECT_GT(blocked, asked / 10);
  EXPECT_LT(blocked, asked * 9 / 10);
  // Edges of 0.1 m, a few above each point, are missed or met otherwise within some 1e-6 m, rounding of single
  // precision in a stand of a few metres: a few of a million lines.
  EXPECT_LE(otherwise, 5) << "of " << asked;
}

}  // namespace

TEST(ParallelShadows, AreThoseOfEmbree) {
  expectAsEmbree(mixedTree(), Stand{}, true);
  expectAsEmbree(leafBox(300, 1), Stand{}, false);
}

TEST(ParallelShadows, AreThoseOfEmbreeInAStand) {
  const Stand stand{.trees = {{.position = {1.f, 2.f, 0.f}, .rotation = 0.7f}, {.position = {-0.5f, 3.f, 0.2f}}}};
  expectAsEmbree(mixedTree(), stand, true);
}

// A leaf on its own, level: in the way of what is right below it alone, and of no level line.
TEST(ParallelShadows, OfOneLeafAreItsOutline) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0.f, 0.f, 0.f}, {0.5f, 0.f, 0.f}, {0.f, 0.25f, 0.f}));
  finish(mesh, "leaf");
  const RayScene scene(mesh, Stand{}, false);
  const ParallelShadows up(scene.geometry(), {0.f, 0.f, 1.f}), level(scene.geometry(), {1.f, 0.f, 0.f});
  ASSERT_FALSE(up.asksEmbree());
  for (const float x : {-0.501f, -0.499f, 0.f, 0.499f, 0.501f})
    for (const float y : {-0.251f, -0.249f, 0.f, 0.249f, 0.251f}) {
      const bool inside = std::abs(x) < 0.5f && std::abs(y) < 0.25f;
      EXPECT_EQ(up.blocked({x, y, -1.f}), inside) << x << ' ' << y;
      EXPECT_FALSE(up.blocked({x, y, 1e-4f}));
      EXPECT_FALSE(level.blocked({x - 2.f, y, 0.f}));
    }
}

// Where it says that nothing is met through a square, nothing is; and of squares all over and around it finds most.
TEST(ParallelShadows, TellWhereNothingIsMet) {
  const RayScene made(leafBox(30, 2), Stand{}, false);
  const RayScene::Geometry& scene = made.geometry();
  const Direction sight = sunlight(0.9f, 0.4f);
  const ParallelShadows before_eye(scene, -sight);
  const Axes axes = axesAlong(sight);
  constexpr int kSide = 40, kLines = 8;
  constexpr float kStep = 0.08f;  // [m]
  int free = 0, told = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::vec3 right = kStep * axes.right, up = kStep * axes.up;
      const glm::vec3 corner = static_cast<float>(x - kSide / 2) * right + static_cast<float>(y - kSide / 2) * up;
      bool met = false;
      for (int i = 0; i <= kLines; ++i)
        for (int k = 0; k <= kLines; ++k) {
          const glm::vec3 at = corner + (right * static_cast<float>(i) + up * static_cast<float>(k)) / float{kLines};
          met = met || scene.blocked(at - 10.f * sight, sight);
        }
      const bool nothing = before_eye.nothingThrough(corner, right, up);
      EXPECT_FALSE(met && nothing) << x << ' ' << y;
      free += !met;
      told += nothing;
    }
  // A cell of the grid that a leaf reaches into makes its squares unsure; most of the picture is around the tree.
  EXPECT_GT(told, free * 3 / 4) << "of " << free;
}

TEST(ParallelShadows, LeavePeriodsAndCrowdsToEmbree) {
  const TreeMesh tree = leafBox(50, 4);
  const RayScene periodic(tree, Stand{.period = glm::vec2(2.f, 2.f)}, false);
  EXPECT_TRUE(ParallelShadows(periodic.geometry(), {0.f, 0.f, 1.f}).asksEmbree());
  Stand many;
  for (int i = 0; i < 900; ++i) many.trees.push_back({.position = {3.f * static_cast<float>(i), 0.f, 0.f}});
  const RayScene large(tree, many, false);
  EXPECT_TRUE(ParallelShadows(large.geometry(), {0.f, 0.f, 1.f}).asksEmbree());

  // Leaves in a small heap beside one a hundred times as large: the heap's cells would hold hundreds each.
  TreeMesh heap;
  Random random(3, 0);
  for (int i = 0; i < 2000; ++i) {
    const Axes axes = axesAlong(onSphere(random));
    const glm::vec3 centre = 0.01f * onSphere(random);
    addPolygon(heap, heap.leaf_triangles, rectangle(centre, 0.01f * axes.right, 0.01f * axes.up));
  }
  addPolygon(heap, heap.leaf_triangles, rectangle({5.f, 0.f, -1.f}, {10.f, 0.f, 0.f}, {0.f, 10.f, 0.f}));
  finish(heap, "heap");
  const RayScene crowded(heap, Stand{}, false);
  EXPECT_TRUE(ParallelShadows(crowded.geometry(), {0.f, 0.f, 1.f}).asksEmbree());
  EXPECT_TRUE(ParallelShadows(crowded.geometry(), {0.f, 0.f, 1.f}).blocked({5.f, 0.f, -2.f}));
}
