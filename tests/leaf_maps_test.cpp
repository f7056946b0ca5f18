// Check which share of the leaf area lies at each place of its images, the mean of what it does there, and what is
// refused.
#include "core/leaf_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "core/require.hpp"

using namespace sunfleck;

namespace {

// Two triangles of 2 m^2 and 1 m^2 beside each other, each with its part of the images.
TreeMesh twoLeaves(const ImageCorners& first, const ImageCorners& second) {
  TreeMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {5, 0, 0}, {6, 0, 0}, {5, 2, 0}};
  mesh.leaf_triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.patches = {{.corners = first}, {.corners = second}};
  mesh.patch_of_triangle = {0, 1};
  finish(mesh, "leaves");
  return mesh;
}

constexpr ImageCorners kLowerLeft{glm::vec2(0.f), {1.f, 0.f}, {0.f, 1.f}};
constexpr ImageCorners kUpperRight{glm::vec2(1.f), {0.f, 1.f}, {1.f, 0.f}};

double sum(const std::vector<float>& shares) {
  return std::accumulate(shares.begin(), shares.end(), 0.);
}

}  // namespace

// Check the halves of an image that two leaves show, above and below its diagonal: two thirds and a third.
TEST(LeafMaps, SharesOfLeafArea) {
  const TreeMesh mesh = twoLeaves(kLowerLeft, kUpperRight);
  constexpr int kSide = 200;
  const std::vector<float> shares = leafAreaShares(mesh, kSide, kSide);
  EXPECT_NEAR(sum(shares), 1., 1e-5);  // 40,000 floats
  double below = 0.;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < y; ++x) below += double{shares[static_cast<std::size_t>(y * kSide + x)]};
  EXPECT_NEAR(below, 2. / 3., 2. / kSide);  // the places on the diagonal
}

// Check that a part smaller than a place counts where it lies, whatever the repeats; that a mask takes its places out;
// and that leaves without places are spread evenly.
TEST(LeafMaps, SharesOfSmallCutAndUnknownParts) {
  const auto tiny = [](float u, float v) { return ImageCorners{glm::vec2(u, v), {u + 0.01f, v}, {u, v + 0.01f}}; };
  const std::vector<float> corners = leafAreaShares(twoLeaves(tiny(0.1f, 0.1f), tiny(1.9f, -0.1f)), 2, 2);
  EXPECT_NEAR(corners[2], 2. / 3., 1e-6);  // lower left
  EXPECT_NEAR(corners[1], 1. / 3., 1e-6);  // upper right

  TreeMesh cut = twoLeaves(kLowerLeft, kLowerLeft);
  cut.masks.push_back(std::make_shared<const LeafMask>(LeafMask{.width = 2, .height = 1, .opaque = {1, 0}}));
  cut.patches[0].mask = 0;
  cut.patches[1].mask = 0;
  const std::vector<float> masked = leafAreaShares(cut, 64, 64);
  EXPECT_NEAR(sum(masked), 1., 1e-5);
  for (std::size_t row = 0; row < 64; ++row)
    for (std::size_t i = 32; i < 64; ++i) EXPECT_EQ(masked[64 * row + i], 0.f) << row << " " << i;

  TreeMesh unknown = twoLeaves(kLowerLeft, kLowerLeft);
  unknown.patch_of_triangle.clear();
  for (const float share : leafAreaShares(unknown, 2, 2)) EXPECT_EQ(share, 0.25f);
  // Patches of no use are none.
  const TreeMesh flat = twoLeaves({glm::vec2(0.f), {1, 1}, {0.5f, 0.5f}}, {glm::vec2(std::nanf("")), {1, 1}, {0, 1}});
  EXPECT_EQ(patchOf(flat, 0), nullptr);
  EXPECT_EQ(patchOf(flat, 1), nullptr);
}

TEST(LeafMaps, MeanOverBothSidesAndTheArea) {
  LeafMaps maps{.width = 2, .height = 1, .places = std::vector<LeafPlace>(2), .roughnesses = {0.1f, 0.5f}};
  maps.places[0].transmittance = {0.1f, 0.2f, 0.3f};
  maps.places[0].faces[0] = {.reflectance = {0.2f, 0.3f, 0.4f}, .gloss = glm::vec3(0.3f), .roughness = 0};
  maps.places[0].faces[1] = {.reflectance = {0.4f, 0.5f, 0.6f}, .gloss = glm::vec3(0.1f), .roughness = 1};
  validate(maps, "maps");
  const std::vector<float> shares{0.75f, 0.25f};  // the second is black
  const BandOptics mean = meanOptics(maps, shares);
  EXPECT_NEAR(mean[0].reflectance, 0.75 * 0.3, 1e-6);
  EXPECT_NEAR(mean[2].reflectance, 0.75 * 0.5, 1e-6);
  EXPECT_NEAR(mean[1].transmittance, 0.75 * 0.2, 1e-6);
  EXPECT_NEAR(mean[1].gloss, 0.75 * 0.2, 1e-6);
  EXPECT_NEAR(mean[1].gloss_roughness, (0.3 * 0.1 + 0.1 * 0.5) / 0.4, 1e-6);
  EXPECT_TRUE(maps.glossy());
  EXPECT_EQ(maps.placeAt({0.2f, 0.9f}), 0u);
  EXPECT_EQ(maps.placeAt({-0.2f, 3.1f}), 1u);
}

TEST(LeafMaps, RefusesWhatNoLeafIs) {
  const LeafMaps black{.places = std::vector<LeafPlace>(1)};
  EXPECT_NO_THROW(validate(black, "maps"));
  const auto refused = [&](const auto& change) {
    LeafMaps wrong = black;
    change(wrong);
    EXPECT_THROW(validate(wrong, "maps"), InvalidInput);
  };
  refused([](LeafMaps& maps) { maps.width = 2; });
  refused([](LeafMaps& maps) { maps.roughnesses = {}; });
  refused([](LeafMaps& maps) { maps.roughnesses = {0.01f}; });
  refused([](LeafMaps& maps) { maps.places[0].faces[1].roughness = 1; });
  refused([](LeafMaps& maps) { maps.places[0].transmittance.y = std::nanf(""); });
  refused([](LeafMaps& maps) { maps.places[0].faces[0].gloss.x = 1.1f; });
  refused([](LeafMaps& maps) {
    maps.places[0].transmittance.z = 0.6f;
    maps.places[0].faces[1].reflectance.z = 0.5f;
  });
}
