#include "plants/stand_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/require.hpp"
#include "plants/leaf_inclination.hpp"
#include "plants/random_leaves.hpp"

using namespace sunfleck;

namespace {

float leastDistance(const std::vector<Placement>& trees) {
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < trees.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, glm::distance(trees[i].position, trees[j].position));
  return least;
}

}  // namespace

// Check that a regular stand fills its rectangle: 6 x 3 trees of 4 m on 24 x 15 m, about the origin, 4 m apart.
TEST(StandLayout, RegularStandsFillTheirRectangle) {
  const std::vector<Placement> trees = gridStand({24.f, 15.f}, 4.f, 0.f, 1);
  ASSERT_EQ(trees.size(), 18u);
  EXPECT_EQ(leastDistance(trees), 4.f);
  glm::vec3 sum(0.f);
  for (const Placement& tree : trees) {
    EXPECT_LE(std::abs(tree.position.x), 10.f);
    EXPECT_LE(std::abs(tree.position.y), 4.f);
    sum += tree.position;
  }
  EXPECT_EQ(sum, glm::vec3(0.f));
  EXPECT_EQ(gridStand({1.f, 1.f}, 4.f, 0.f, 1).size(), 1u);
}

// Check that jitter moves trees by at most its share of half the spacing and evenly: the mean square of a move along an
// axis is (jitter spacing)^2 / 12 within 4 standard errors, of which each is sqrt(4 / 45 / n) of (jitter spacing /
// 2)^2.
TEST(StandLayout, JitterMovesAsFarAsItSays) {
  const std::vector<Placement> plain = gridStand({200.f, 200.f}, 5.f, 0.f, 7),
                               moved = gridStand({200.f, 200.f}, 5.f, 0.6f, 7);
  ASSERT_EQ(plain.size(), moved.size());
  double squares = 0., most = 0.;
  for (std::size_t i = 0; i < plain.size(); ++i)
    for (int axis = 0; axis < 2; ++axis) {
      const double move = double{moved[i].position[axis]} - double{plain[i].position[axis]};
      squares += move * move;
      most = std::max(most, std::abs(move));
    }
  const double half = 0.5 * 0.6 * 5., n = 2. * static_cast<double>(plain.size());
  EXPECT_LE(most, half + 1e-5);  // rounding of floats of up to 100 m
  EXPECT_NEAR(squares / n, half * half / 3., 4. * half * half * std::sqrt(4. / 45. / n));
  EXPECT_EQ(gridStand({20.f, 20.f}, 5.f, 0.6f, 7), gridStand({20.f, 20.f}, 5.f, 0.6f, 7));
}

// Check that Poisson discs do not overlap and leave no room. Discs thrown at random close at 0.547 of the area (Feder
// 1980); those thrown about others pack a little closer, 30 tries leave some room, and the discs of half the distance
// reach over the rectangle's border by less than half a distance: 0.4 to 0.6 of the area so enlarged.
TEST(StandLayout, PoissonDiscsDoNotOverlap) {
  const std::vector<Placement> trees = poissonStand({60.f, 40.f}, 3.f, 5);
  EXPECT_GE(leastDistance(trees), 3.f - 1e-5f);  // rounding of floats of up to 30 m
  const double filled = static_cast<double>(trees.size()) * std::numbers::pi * 2.25 / (63. * 43.);
  EXPECT_GT(filled, 0.4);
  EXPECT_LT(filled, 0.6);
  for (const Placement& tree : trees) {
    EXPECT_LE(std::abs(tree.position.x), 30.f);
    EXPECT_LE(std::abs(tree.position.y), 20.f);
  }
  // No place of the rectangle is further than two distances from a tree.
  for (float x = -30.f; x <= 30.f; x += 1.f)
    for (float y = -20.f; y <= 20.f; y += 1.f)
      EXPECT_TRUE(std::any_of(trees.begin(), trees.end(), [&](const Placement& tree) {
        return glm::distance(tree.position, glm::vec3(x, y, 0.f)) < 6.f;
      }));
  EXPECT_EQ(poissonStand({60.f, 40.f}, 3.f, 5), trees);
  EXPECT_NE(poissonStand({60.f, 40.f}, 3.f, 6), trees);
}

TEST(StandLayout, RefusesWhatCannotBe) {
  EXPECT_THROW(gridStand({0.f, 1.f}, 1.f, 0.f, 1), InvalidInput);
  EXPECT_THROW(gridStand({1.f, 1.f}, std::nanf(""), 0.f, 1), InvalidInput);
  EXPECT_THROW(gridStand({1e5f, 1e5f}, 0.1f, 0.f, 1), InvalidInput);
  EXPECT_THROW(gridStand({1.f, 1.f}, 1.f, 1.5f, 1), InvalidInput);
  EXPECT_THROW(poissonStand({1e5f, 1e5f}, 0.1f, 1), InvalidInput);
}

// Check the crown's radius and the leaves' angles of one leaf that leans by 45 degrees, and of random leaves, whose
// normals point everywhere alike: the share of each class is cos low - cos high within 4 standard errors of 20,000
// leaves, the mean angle 1 rad, of which the standard deviation is sqrt(pi - 3) = 0.376 rad.
TEST(StandLayout, TellsCrownsAndAngles) {
  TreeMesh leaf;
  leaf.vertices = {{0.f, 0.f, 0.f}, {3.f, 0.f, 3.f}, {3.f, 4.f, 3.f}};
  leaf.leaf_triangles = {{0, 1, 2}};
  finish(leaf, "leaf");
  EXPECT_EQ(crownRadius(leaf), 5.f);
  EXPECT_EQ(leafInclination(leaf).shares[4], 1.);
  EXPECT_NEAR(leafInclination(leaf).mean_angle, std::numbers::pi / 4., 1e-12);

  const TreeMesh random = randomCrown({.leaves = 20'000}, 3);
  const LeafInclination lean = leafInclination(random);
  const auto spherical = sphericalShares();
  double sum = 0.;
  for (std::size_t i = 0; i < spherical.size(); ++i) {
    EXPECT_NEAR(lean.shares[i], spherical[i], 4. * std::sqrt(spherical[i] * (1. - spherical[i]) / 20'000.)) << i;
    sum += spherical[i];
  }
  EXPECT_NEAR(sum, 1., 1e-12);
  EXPECT_NEAR(lean.mean_angle, 1., 4. * 0.376 / std::sqrt(20'000.));
}
