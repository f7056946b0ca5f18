#include <gtest/gtest.h>

#include <bit>

#include "grid/deep_opacity_map.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "render/gl/opacity_maps.hpp"

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
  for (const TreeMesh& mesh : {randomCrown({.leaves = 3000}, 4), grow(species("cherry"), 1), grow(species("maple"), 1)}) {
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

}  // namespace
