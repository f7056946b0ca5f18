#include "render/reference/ray_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "core/require.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::detail;
using namespace sunfleck::shapes;

namespace {

// Whether the line from `from` along `along` crosses a triangle, in double precision (Moeller & Trumbore 1997).
bool crosses(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& from,
             const glm::dvec3& along) {
  const glm::dvec3 p = glm::cross(along, c - a);
  const double determinant = glm::dot(b - a, p);
  const double u = glm::dot(from - a, p) / determinant;
  const glm::dvec3 q = glm::cross(from - a, b - a);
  const double v = glm::dot(along, q) / determinant;
  return u >= 0. && v >= 0. && u + v <= 1. && glm::dot(c - a, q) / determinant > 0.;
}

}  // namespace

// Check that a pile of leaves is counted leaf by leaf, also along the seam of their two triangles and from inside the
// pile, and that wood is not counted.
TEST(R5_LeafCrossings, CountsSharedEdgesOnce) {
  TreeMesh mesh;
  for (int i = 0; i < 5; ++i)
    addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 0.1f * static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}));
  addPolygon(mesh, mesh.wood_triangles, rectangle({0, 0, 2}, {1, 0, 0}, {0, 1, 0}));
  finish(mesh, "pile");
  const RayScene scene(mesh, Stand{}, true);
  for (float x : {0.25f, 0.5f, -0.125f}) {
    EXPECT_EQ(scene.crossings({x, x, 5.f}, {0, 0, -1}), 5);
    EXPECT_EQ(scene.crossings({x, 0.3f, 5.f}, {0, 0, -2}), 5);
    EXPECT_EQ(scene.crossings({x, x, 0.25f}, {0, 0, -1}), 3);
    EXPECT_EQ(scene.crossings({x, x, 0.25f}, {0, 0, 1}), 2);
  }
  EXPECT_EQ(scene.crossings({3, 3, 5.f}, {0, 0, -1}), 0);
}

// Check counts through random crowns of two kinds, turned and moved, against every triangle tried in double precision.
// A line that passes an edge within rounding (1e-7 of 0.1 m, some 1e4 edges: 1e-2 over all lines) could differ; these
// do not.
TEST(R5_LeafCrossings, MatchesEveryTriangleTried) {
  const TreeMesh one = leafBox(300, 4), other = leafBox(200, 5);
  const std::array kinds{&one, &other};
  const Stand stand{.trees = {{.position = {0.5f, 0.f, 0.25f}, .rotation = 0.f, .kind = 1},
                              {.position = {0.f, 0.5f, 0.f}, .rotation = 2.1f},
                              {.position = {0.f, 0.f, 0.2f}, .rotation = -1.f, .kind = 1}}};
  const RayScene scene(kinds, stand, true);
  Random random(6, 0);
  int total = 0;
  for (int line = 0; line < 300; ++line) {
    const glm::vec3 from = 3.f * onSphere(random);
    const glm::vec3 along = glm::normalize(0.7f * onSphere(random) - from);
    int expected = 0;
    for (const Placement& tree : stand.trees) {
      const TreeMesh& mesh = *kinds[tree.kind];
      const double c = std::cos(double{tree.rotation}), s = std::sin(double{tree.rotation});
      const auto placed = [&](std::uint32_t vertex) {
        const glm::dvec3 v = mesh.vertices[vertex];
        return glm::dvec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z) + glm::dvec3(tree.position);
      };
      for (const glm::uvec3& t : mesh.leaf_triangles)
        expected += crosses(placed(t.x), placed(t.y), placed(t.z), from, along);
    }
    EXPECT_EQ(scene.crossings(from, along), expected) << line;
    total += expected;
  }
  EXPECT_GT(total, 300);
}

// Check the box of turned copies, of leaves alone, and of a period around the stand's middle. Error: a few ulp of 10 m.
TEST(RayScene, BoxHoldsWhatCanBeHit) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 2}, {3, 0, 0}, {0, 1, 0}));
  addPolygon(mesh, mesh.wood_triangles, rectangle({0, 0, 0}, {.1f, 0, 0}, {0, .1f, 0}));
  finish(mesh, "table");
  EXPECT_EQ(RayScene(mesh, Stand{}, true).box().low, glm::vec3(-3, -1, 0));
  EXPECT_EQ(RayScene(mesh, Stand{}, false).box().low, glm::vec3(-3, -1, 2));
  const Placement turned{.position = {10, 0, 1}, .rotation = glm::half_pi<float>()};
  const Bounds box = RayScene(mesh, {.trees = {turned}}, true).box();
  EXPECT_NEAR(glm::length(box.low - glm::vec3(9, -3, 1)), 0.f, 4e-6f);
  EXPECT_NEAR(glm::length(box.high - glm::vec3(11, 3, 3)), 0.f, 4e-6f);
  const Bounds cell = RayScene(mesh, {.trees = {turned}, .period = glm::vec2(4, 5)}, true).box();
  EXPECT_NEAR(glm::length(cell.low - glm::vec3(8, -2.5f, 1)), 0.f, 4e-6f);
  EXPECT_NEAR(glm::length(cell.high - glm::vec3(12, 2.5f, 3)), 0.f, 4e-6f);
}

TEST(RayScene, RefusesInvalidStands) {
  const TreeMesh mesh = leafBox(3, 1);
  const auto make = [&](const Stand& stand) { RayScene(mesh, stand, true); };
  EXPECT_THROW(make({.trees = {{.kind = 1}}}), InvalidInput);
  EXPECT_THROW(RayScene(std::array<const TreeMesh*, 2>{&mesh, &mesh}, Stand{}, true),
               InvalidInput);  // none of the second
  EXPECT_THROW(make({.trees = {}}), InvalidInput);
  EXPECT_THROW(make({.trees = {{.position = {0, std::nanf(""), 0}}}}), InvalidInput);
  EXPECT_THROW(make({.trees = {{.rotation = std::numeric_limits<float>::infinity()}}}), InvalidInput);
  EXPECT_THROW(make({.period = glm::vec2(0, 1)}), InvalidInput);
  EXPECT_THROW(make({.period = glm::vec2(1, -1)}), InvalidInput);
  EXPECT_THROW(make({.period = glm::vec2(1e-6f)}), InvalidInput);
  EXPECT_THROW(RayScene(mesh, {.period = glm::vec2(1)}, true).crossings({0, 0, 9}, {0, 0, -1}), InvalidInput);
}

// Check that packets that are full, partly filled and empty come back, each with what its rays meet alone, whatever lay
// in memory where the packet is made.
TEST(RayScene, PacketsOfAnyNumberMeetWhatRaysMeetAlone) {
  using Geometry = RayScene::Geometry;
  const TreeMesh tree = leafBox(300, 8);
  const Stand stand{.trees = {{.position = {0.5f, 0.f, 0.25f}}, {.position = {0.f, 0.5f, 0.f}, .rotation = 2.1f}}};
  const RayScene made(tree, stand, true);
  const Geometry& scene = made.geometry();
  const Direction along = glm::normalize(glm::vec3(0.2f, 0.1f, -1.f));
  const float reach = std::numeric_limits<float>::infinity();
  Random random(11, 0);
  int met = 0;
  for (int round = 0; round < 50; ++round)
    for (std::size_t count = 0; count <= Geometry::kPacket; ++count) {
      std::vector<glm::vec3> from;
      for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 at(random.uniform(), random.uniform(), 1.f);
        from.push_back(scene.box.low + at * scene.box.size());
      }
      const std::vector<Direction> directions(count, along);
      const std::vector<float> reaches(count, reach);
      std::vector<Hit> hits(count);
      scene.closest(from, directions, reaches, hits);
      std::array<bool, Geometry::kPacket> blocked{};
      for (std::size_t i = 0; i < count; ++i) blocked[i] = random.uniform() < 0.5f;
      const std::array<bool, Geometry::kPacket> before = blocked;
      scene.blocked(from, along, std::span(blocked).first(count));
      for (std::size_t i = 0; i < count; ++i) {
        const Hit alone = scene.closest(from[i], along, Coherence::incoherent, reach);
        EXPECT_EQ(hits[i].surface, alone.surface);
        EXPECT_EQ(hits[i].leaf, alone.leaf);
        EXPECT_EQ(blocked[i], before[i] || alone.surface != Surface::none);
        met += alone.surface != Surface::none;
      }
    }
  EXPECT_GT(met, 50);
}
