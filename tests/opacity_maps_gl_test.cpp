#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "grid/deep_opacity_map.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "render/gl/opacity_map_store.hpp"
#include "render/gl/opacity_maps.hpp"
#include "render/gl/too_large.hpp"
#include "render/stand_geometry.hpp"

namespace {

using namespace sunfleck;

struct Differences {
  std::size_t pixels = 0;  // whose leaves or their order differ
  std::size_t depths = 0;  // of crossings, leaf or wood, that differ in a bit
};

Differences differences(const DeepOpacityMap& a, const DeepOpacityMap& b) {
  EXPECT_EQ(a.size(), b.size());
  EXPECT_EQ(a.corner(), b.corner());
  EXPECT_EQ(a.pixelSize(), b.pixelSize());
  EXPECT_EQ(a.woodDepth().size(), b.woodDepth().size());
  Differences found;
  for (int y = 0; y < a.size().y; ++y)
    for (int x = 0; x < a.size().x; ++x) {
      const auto of_a = a.crossings(x, y), of_b = b.crossings(x, y);
      bool same = of_a.size() == of_b.size();
      for (std::size_t i = 0; same && i < of_a.size(); ++i) {
        same = of_a[i].leaf == of_b[i].leaf;
        found.depths += std::bit_cast<std::uint32_t>(of_a[i].depth) != std::bit_cast<std::uint32_t>(of_b[i].depth);
      }
      found.pixels += !same;
    }
  for (std::size_t i = 0; i < a.woodDepth().size(); ++i) found.depths += a.woodDepth()[i] != b.woodDepth()[i];
  return found;
}

// (D14) Check that the map that the graphics card makes is the one that the processor makes, along several directions
// and at several sizes. Both work in double precision: a pixel's centre would have to lie within 1e-12 of a pixel of an
// edge to be told apart, which no centre of some 2 million crossings does by chance (1e-5); a depth is then rounded to
// single precision, the other way where the two differ in their last bit of 53 right at a bound: once in 1e8.
TEST(D14_OpacityMapOnTheGpu, IsTheProcessorsToTheBit) {
  const gl::Context context;
  const gl::OpacityMapMaker maker(context);
  for (const TreeMesh& mesh :
       {randomCrown({.leaves = 3000}, 4), grow(species("cherry"), 1), grow(species("maple"), 1)}) {
    const gl::MappedTree tree(mesh);
    for (const Direction& along : {Direction(0.f, 0.f, -1.f), spreadAxes(7)[2], -spreadAxes(7)[4]})
      for (const int resolution : {1, 97, 512}) {
        const DeepOpacityMap expected(mesh, along, resolution);
        const Differences found = differences(maker.make(tree, along, resolution).read(), expected);
        EXPECT_EQ(found.pixels, 0u) << "of " << expected.first().size();
        EXPECT_EQ(found.depths, 0u) << "of " << expected.crossings().size();
      }
  }
}

// (D14) Check that a leaf whose edges pass exactly through centres of pixels, and a trunk behind it, lie in the pixels
// that the processor says.
TEST(D14_OpacityMapOnTheGpu, DecidesCentresOnEdgesAlike) {
  TreeMesh mesh;
  const auto square = [&](std::vector<glm::uvec3>& triangles, glm::vec2 low, glm::vec2 high, float z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec2 at : {low, {high.x, low.y}, high, {low.x, high.y}}) mesh.vertices.push_back({at, z});
    for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) triangles.push_back(t + first);
  };
  square(mesh.leaf_triangles, glm::vec2(-2.f), glm::vec2(2.f), 0.f);  // the pixels of a map of 8: sides of 0.5 m
  square(mesh.leaf_triangles, {-1.25f, -0.75f}, {0.75f, 1.25f}, 1.f);
  square(mesh.wood_triangles, {0.25f, -1.75f}, {1.25f, -0.25f}, 2.f);
  finish(mesh, "squares");
  const gl::Context context;
  const gl::OpacityMapMaker maker(context);
  const gl::MappedTree tree(mesh);
  for (const float z : {1.f, -1.f}) {
    const Direction along(0.f, 0.f, z);
    const DeepOpacityMap made = maker.make(tree, along, 8).read();
    EXPECT_EQ(made.crossings().size(), 64u + 16u);
    EXPECT_EQ(std::ranges::count(made.woodDepth(), 2.f * z), 6);
    const Differences found = differences(made, DeepOpacityMap(mesh, along, 8));
    EXPECT_EQ(found.pixels + found.depths, 0u);
  }
}

// (D14) Check that a stand whose light's maps come from the graphics card has the same G to the bit, and that maps stay
// there while they are in use, and no longer.
TEST(D14_OpacityMapOnTheGpu, ServesAStand) {
  Scene scene;
  scene.kinds[0].mesh = std::make_shared<TreeMesh>(randomCrown({.leaves = 500}, 4));
  scene.stand.trees = {{.position = {0.f, 0.f, 0.f}}, {.position = {2.5f, 0.5f, 0.f}}};
  const gl::Context context;
  gl::OpacityMapStore store(context);
  const GeometryEffort effort{.light_resolution = 64, .sample_directions = 6, .sample_resolution = 32, .cells = 8};
  StandGeometry expected(effort);
  int made = 0;
  StandGeometry stand(effort, [&](const std::shared_ptr<const TreeMesh>& mesh, Direction along, int resolution) {
    ++made;
    return store.map(mesh, along, resolution).read();
  });
  std::vector<Direction> suns;
  for (int sun = 0; sun < 6; ++sun) {
    scene.suns[0].zenith = 0.2f * static_cast<float>(sun);
    suns.push_back(scene.suns[0].light());
    stand.update(scene);
    expected.update(scene);
    EXPECT_EQ(made, sun + 1);
    for (std::size_t tree = 0; tree < 2; ++tree) {
      const std::span<const float> compensation = stand.compensation(tree, 0);
      EXPECT_GT(std::ranges::max(compensation), 0.5f);
      EXPECT_TRUE(std::ranges::equal(compensation, expected.compensation(tree, 0)));
    }
  }
  std::shared_ptr<const TreeMesh> tree = scene.kinds[0].mesh;
  const gl::OpacityMap& kept = store.map(tree, suns[5], 64);
  EXPECT_EQ(&store.map(tree, suns[5], 64), &kept);
  EXPECT_EQ(store.find(tree, suns[5], 64), &kept);
  EXPECT_EQ(store.find(tree, suns[5], 32), nullptr);
  EXPECT_EQ(store.find(tree, suns[5 - kMostSuns], 64), nullptr);
  store.map(tree, suns[5], 32);
  EXPECT_EQ(store.find(tree, suns[5], 64), &kept);
  const std::weak_ptr<const TreeMesh> former = std::exchange(tree, nullptr);
  scene.kinds[0].mesh = std::make_shared<TreeMesh>(randomCrown({.leaves = 300}, 5));
  expected.update(scene);
  stand.update(scene);
  EXPECT_TRUE(former.expired());
}

// (D14) Check that the same map is the same on every run, though crossings come in another order.
TEST(D14_OpacityMapOnTheGpu, IsTheSameOnEveryRun) {
  const TreeMesh mesh = randomCrown({.leaves = 3000}, 4);
  const gl::Context context;
  const gl::OpacityMapMaker maker(context);
  const DeepOpacityMap first = maker.make(gl::MappedTree(mesh), spreadAxes(7)[2], 300).read();
  for (int run = 0; run < 4; ++run) {
    const Differences found = differences(maker.make(gl::MappedTree(mesh), spreadAxes(7)[2], 300).read(), first);
    EXPECT_EQ(found.pixels + found.depths, 0u);
  }
}

// (D14) Check that lines of hundreds of crossings are sorted, too.
TEST(D14_OpacityMapOnTheGpu, SortsLongLines) {
  TreeMesh mesh;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const float z = static_cast<float>(i * 7919u % 1000u) * (i % 3 == 0 ? -1.f : 1.f);  // in no order, some at once
    for (const glm::vec2 at : {glm::vec2(0.f), {1.f, 0.f}, {0.f, 1.f}}) mesh.vertices.push_back({at, z});
    mesh.leaf_triangles.push_back(glm::uvec3(0, 1, 2) + 3 * i);
  }
  finish(mesh, "pile");
  const gl::Context context;
  const Differences found = differences(gl::OpacityMapMaker(context).make(gl::MappedTree(mesh), {0, 0, -1}, 4).read(),
                                        DeepOpacityMap(mesh, {0, 0, -1}, 4));
  EXPECT_EQ(found.pixels + found.depths, 0u);
}

// (D14) Check that a leaf and a trunk that fill a large map are in all of its pixels: more than a driver may let one
// invocation do.
TEST(D14_OpacityMapOnTheGpu, HoldsLargeTriangles) {
  TreeMesh mesh;
  for (const float z : {1.f, 0.f})
    for (const glm::vec2 at : {glm::vec2(0.f), {1.f, 0.f}, {0.f, 1.f}}) mesh.vertices.push_back({at, z});
  mesh.leaf_triangles.push_back({0, 1, 2});
  mesh.wood_triangles.push_back({3, 4, 5});
  finish(mesh, "two");
  const gl::Context context;
  const DeepOpacityMap expected(mesh, {0, 0, -1}, 700);
  EXPECT_GT(expected.crossings().size(), 700u * 700u / 2 - 700u);
  const Differences found =
      differences(gl::OpacityMapMaker(context).make(gl::MappedTree(mesh), {0, 0, -1}, 700).read(), expected);
  EXPECT_EQ(found.pixels + found.depths, 0u);
}

// (D14) Check that a line of more leaves than shaders sort is refused with its number.
TEST(D14_OpacityMapOnTheGpu, RefusesLinesTooLong) {
  TreeMesh mesh;
  for (std::uint32_t i = 0; i < 1025; ++i) {
    for (const glm::vec2 at : {glm::vec2(0.f), {1.f, 0.f}, {0.f, 1.f}})
      mesh.vertices.push_back({at, static_cast<float>(i)});
    mesh.leaf_triangles.push_back(glm::uvec3(0, 1, 2) + 3 * i);
  }
  finish(mesh, "pile");
  const gl::Context context;
  const gl::OpacityMapMaker maker(context);
  const gl::MappedTree tree(mesh);
  try {
    maker.make(tree, {0, 0, -1}, 4);
    FAIL() << "a map of lines of 1025 leaves was made";
  } catch (const gl::TooLarge& e) {
    EXPECT_NE(std::string(e.what()).find("crosses 1025 leaves"), std::string::npos) << e.what();
  }
}

// (D14) Check that a map of more than a shader may read in one piece is refused with the figure, before it is filled.
TEST(D14_OpacityMapOnTheGpu, RefusesWhatShadersCannotRead) {
  const gl::Context context;
  const std::size_t most = gl::Buffer::largestStorage();
  if (most > 256u << 20) GTEST_SKIP() << "this driver reads " << most << " bytes in one piece";
  constexpr int kSide = 1024;
  TreeMesh mesh;
  const auto leaves = static_cast<std::uint32_t>(2 * most / sizeof(Crossing) / (kSide * kSide) + 3);
  for (std::uint32_t i = 0; i < leaves; ++i) {
    for (const glm::vec2 at : {glm::vec2(0.f), {1.f, 0.f}, {0.f, 1.f}})
      mesh.vertices.push_back({at, static_cast<float>(i)});
    mesh.leaf_triangles.push_back(glm::uvec3(0, 1, 2) + 3 * i);
  }
  finish(mesh, "pile");
  try {
    gl::OpacityMapMaker(context).make(gl::MappedTree(mesh), {0, 0, -1}, kSide);
    FAIL() << "a map of " << leaves << " leaves was made";
  } catch (const gl::TooLarge& e) {
    EXPECT_NE(std::string(e.what()).find("MB in one piece: must be at most 134.2 MB"), std::string::npos) << e.what();
  }
}

}  // namespace
