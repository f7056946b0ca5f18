// Check that what rays meet by the walk through trees of facets is what they meet by Embree, and that it is walked
// where the machine is one for it.
#include "render/reference/detail/ray_trees.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include "core/random.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::detail;
using namespace sunfleck::shapes;

namespace {

// The same stand, asked of Embree and walked.
struct Both {
  Both(std::span<const TreeMesh* const> kinds, const Stand& stand) {
    setenv("SUNFLECK_SIMD", "baseline", 1);
    embree = std::make_unique<RayScene>(kinds, stand, true);
    unsetenv("SUNFLECK_SIMD");
    walked = std::make_unique<RayScene>(kinds, stand, true);
  }
  std::unique_ptr<RayScene> embree, walked;
};

// Leaves that are parallelograms, bent pairs of triangles and single ones; upright and level; and a trunk.
TreeMesh mixedTree(int leaves, std::uint64_t seed) {
  TreeMesh mesh;
  Random random(seed, 0);
  for (int i = 0; i < leaves; ++i) {
    const glm::vec3 centre(2.f * random.uniform() - 1.f, random.uniform() - 0.5f, random.uniform() - 0.5f);
    const Axes axes = axesAlong(i % 5 == 0 ? glm::vec3(0.f, 0.f, 1.f) : onSphere(random));
    std::vector<glm::vec3> corners = rectangle(centre, 0.08f * axes.right, 0.05f * axes.up);
    if (i % 4 == 1) corners[2] += 0.03f * axes.along;
    if (i % 11 == 0) corners.pop_back();
    addPolygon(mesh, mesh.leaf_triangles, corners);
  }
  addPolygon(mesh, mesh.wood_triangles, rectangle({0.f, 0.f, 0.f}, {0.03f, 0.f, 0.f}, {0.f, 0.f, 0.5f}));
  finish(mesh, "mixed tree");
  return mesh;
}

void expectAlike(const Both& both, float least_met, int rays = 20'000) {
  const RayScene::Geometry &embree = both.embree->geometry(), &walked = both.walked->geometry();
  Random random(7, 0);
  int met = 0, otherwise = 0, blocked = 0;
  for (int i = 0; i < rays; ++i) {
    const glm::vec3 at(random.uniform(), random.uniform(), random.uniform());
    const glm::vec3 from = walked.box.low + at * walked.box.size();
    Direction along = onSphere(random);
    if (i % 8 == 0) along = Direction(0.f);
    if (i % 8 == 0) along[i / 8 % 3] = i % 16 == 0 ? 1.f : -1.f;
    const Hit a = embree.closest(from, along, Coherence::incoherent),
              b = walked.closest(from, along, Coherence::incoherent);
    const bool alike = a.surface == b.surface && a.kind == b.kind && a.leaf == b.leaf;
    met += b.surface != Surface::none;
    otherwise += !alike;
    blocked += walked.blocked(from, along) != (b.surface != Surface::none);
    if (!alike || b.surface == Surface::none) continue;
    // Both put the point on the facet's plane; along the ray they differ by rounding, more where it grazes.
    const float slant = std::max(0.01f, std::abs(glm::dot(along, b.normal)));
    EXPECT_LE(glm::length(a.position - b.position), walked.lift / slant);
    EXPECT_EQ(a.front, b.front);
    EXPECT_LE(glm::length(a.normal - b.normal), 1e-4f);
  }
  EXPECT_GT(static_cast<float>(met), least_met * static_cast<float>(rays));
  EXPECT_EQ(blocked, 0);
  // Lines that pass an edge of 0.1 m within rounding, 1e-7 of some metres: a few of a million.
  EXPECT_LE(otherwise, 2) << "of " << rays;
}

}  // namespace

TEST(R36_RayTrees, MeetWhatEmbreeMeets) {
  const TreeMesh tree = mixedTree(2000, 3), small = mixedTree(5, 4);
  expectAlike(Both(std::array{&tree}, Stand{}), 0.5f);
  expectAlike(Both(std::array{&small}, Stand{}), 0.f);
}

TEST(R36_RayTrees, MeetWhatEmbreeMeetsInAStand) {
  const TreeMesh one = mixedTree(600, 3), other = leafBox(100, 4), bare;
  Stand stand;
  Random random(5, 0);
  for (int i = 0; i < 40; ++i)
    stand.trees.push_back({.position = {4.f * random.uniform(), 4.f * random.uniform(), random.uniform()},
                           .rotation = 6.f * random.uniform(),
                           .kind = i % 7 == 0   ? 2u
                                   : i % 3 == 0 ? 1u
                                                : 0u});
  expectAlike(Both(std::array{&one, &other, &bare}, stand), 0.5f);
}

TEST(R36_RayTrees, MeetWhatEmbreeMeetsInPeriods) {
  const TreeMesh tree = mixedTree(300, 6);
  expectAlike(Both(std::array{&tree}, Stand{.period = glm::vec2(2.5f, 1.5f)}), 0.3f, 1'000);
}

// All leaves in one place: no cut by area parts them.
TEST(R36_RayTrees, HoldLeavesOnTopOfEachOther) {
  TreeMesh mesh;
  for (int i = 0; i < 1000; ++i)
    addPolygon(mesh, mesh.leaf_triangles, rectangle({0.f, 0.f, 0.f}, {1.f, 0.f, 0.f}, {0.f, 1.f, 0.f}));
  finish(mesh, "pile");
  const RayScene scene(mesh, Stand{}, false);
  const Hit hit = scene.geometry().closest({0.3f, 0.2f, 1.f}, {0.f, 0.f, -1.f}, Coherence::incoherent);
  EXPECT_EQ(hit.surface, Surface::leaf);
  EXPECT_FLOAT_EQ(hit.position.x, 0.3f);
  EXPECT_FALSE(scene.geometry().blocked({0.3f, 0.2f, 1.f}, {0.f, 0.f, 1.f}));
}
