#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "tests/leaf_shapes.hpp"

// Light does not know where in the world a stand is.
using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Leaves and a plank whose corners are multiples of 1/1024 m, so that they can be moved by 8192 m without rounding.
TreeMesh onGrid() {
  TreeMesh mesh = leafBox(60, 4);
  addPolygon(mesh, mesh.wood_triangles, rectangle({0.f, 0.f, -0.7f}, {0.3f, 0.f, 0.f}, {0.f, 0.2f, 0.1f}));
  for (glm::vec3& vertex : mesh.vertices) vertex = glm::round(1024.f * vertex) / 1024.f;
  finish(mesh, "leaf box");
  return mesh;
}

TreeMesh moved(TreeMesh mesh, const glm::vec3& by) {
  for (glm::vec3& vertex : mesh.vertices) vertex += by;
  finish(mesh, "moved");
  return mesh;
}

void expectSame(const ForwardResult& a, const ForwardResult& b) {
  EXPECT_EQ(a.leaf_irradiance, b.leaf_irradiance);
  EXPECT_EQ(a.leaf_standard_error, b.leaf_standard_error);
  EXPECT_EQ(a.reflected.value, b.reflected.value);
  EXPECT_EQ(a.absorbed_wood.value, b.absorbed_wood.value);
  EXPECT_EQ(a.arriving_ground.value, b.arriving_ground.value);
}

}  // namespace

// Check that a tree whose vertices are 8 km from the origin, nearly as far as a mesh may be, or that stands 1000 km
// from it, as far as a tree may, is traced to the same bits, as is its picture: rays start as exactly there as
// anywhere.
TEST(R1_TraceMoved, FarFromTheOriginNothingChanges) {
  const TreeMesh mesh = onGrid();
  const glm::vec3 by(8192.f, -8192.f, 512.f);
  const TreeMesh far = moved(mesh, by);
  const TraceLight light{.sun = sunlight(0.7f, 1.f)};
  const TraceEffort effort{.paths = 20'000};
  const ForwardResult here = traceForward(RayScene(mesh, Stand{}, true), light, effort);
  expectSame(here, traceForward(RayScene(far, Stand{}, true), light, effort));
  const Stand remote{.trees = {{.position = {-1e6f, 1e6f, 1e6f}}}};
  expectSame(here, traceForward(RayScene(mesh, remote, true), light, effort));
  expectSame(here, traceForward(RayScene(far, remote, true), light, effort));

  const auto seen = [&](const TreeMesh& of, const glm::vec3& at) {
    const PixelRays rays{.corner = at + glm::vec3(-1.f, 0.5f, 2.f),
                         .right_step = {0.0625f, 0.f, 0.f},
                         .down_step = {0.f, -0.0625f, 0.f},
                         .width = 32,
                         .height = 16};
    return traceCamera(RayScene(of, Stand{}, true), light, rays, at.z - 1.f, effort);
  };
  EXPECT_EQ(seen(mesh, glm::vec3(0.f)).radiance.values, seen(far, by).radiance.values);
}

// Check a stand of turned trees against the same stand turned about z with its sun and moved by 10 km, by placing it
// there and by its vertices, within five standard errors; and a periodic one, turned by a quarter with its period. 10
// km away a place is known to 1 mm: leaves of 0.1 m, half a metre apart, shade each other the same to 1 % of the 5 %
// that they do, 5e-4.
TEST(R1_TraceMoved, AStandTurnedWithItsSunIsTheSame) {
  const TreeMesh mesh = onGrid(), far = moved(mesh, {8192.f, 4096.f, 0.f});
  const auto stand = [](float turn, const glm::vec3& by, const glm::vec3& pivot) {
    Stand result{.trees = {}};
    for (int i = 0; i < 4; ++i) {
      const glm::vec3 place(2.5f * static_cast<float>(i % 2), 1.5f * static_cast<float>(i / 2),
                            0.1f * static_cast<float>(i));
      const auto turned = [](const glm::dvec3& v, float angle) {
        const double c = std::cos(double{angle}), s = std::sin(double{angle});
        return glm::vec3(glm::dvec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z));
      };
      const float rotation = 0.9f * static_cast<float>(i) + turn;
      result.trees.push_back({.position = by + turned(place, turn) - turned(pivot, rotation), .rotation = rotation});
    }
    return result;
  };
  const auto expectAlike = [&](const ForwardResult& a, const ForwardResult& b, double known) {
    for (std::size_t leaf = 0; leaf < a.leaf_irradiance.size(); ++leaf)
      EXPECT_NEAR(a.leaf_irradiance[leaf], b.leaf_irradiance[leaf],
                  known + 5. * std::hypot(a.leaf_standard_error[leaf], b.leaf_standard_error[leaf]))
          << leaf;
  };
  const auto trace = [&](const TreeMesh& of, const Stand& in, float turn, std::uint64_t seed) {
    return traceForward(RayScene(of, in, true), {.sun = sunlight(0.7f, 1.f + turn)}, {.paths = 60'000, .seed = seed});
  };
  const glm::vec3 none(0.f), away(1e4f, -1e4f, 300.f), pivot(8192.f, 4096.f, 0.f);
  const ForwardResult here = trace(mesh, stand(0.f, none, none), 0.f, 1);
  expectAlike(here, trace(mesh, stand(0.8f, away, none), 0.8f, 2), 5e-4);
  expectAlike(here, trace(far, stand(0.8f, none, pivot), 0.8f, 3), 5e-4);

  Stand periodic = stand(0.f, none, none), turned = stand(0.5f * kPi, away, none);
  periodic.period = glm::vec2(5.f, 3.f);
  turned.period = glm::vec2(3.f, 5.f);
  const ForwardResult a = trace(mesh, periodic, 0.f, 1), b = trace(mesh, turned, 0.5f * kPi, 2);
  expectAlike(a, b, 5e-4);
  const auto expectNear = [](const Estimate& x, const Estimate& y) {
    EXPECT_NEAR(x.value, y.value, 5e-4 + 5. * std::hypot(x.standard_error, y.standard_error));
  };
  expectNear(a.reflected, b.reflected);
  expectNear(a.absorbed_leaves, b.absorbed_leaves);
  expectNear(a.absorbed_wood, b.absorbed_wood);
  expectNear(a.arriving_ground, b.arriving_ground);
}
