#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "core/require.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"

using namespace sunfleck;

namespace {

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// A straight trunk of 10 m with four leaves: what it must measure is known.
WeberPenn bareTrunk() {
  WeberPenn p;
  p.scale = 10.f;
  p.levels = 1;
  p.ratio = 0.02f;
  p.leaves = 4;
  p.leaf_scale = 0.1f;
  p.leaf_scale_x = 0.5f;
  p.level[0].length = 1.f;
  p.level[0].curve_res = 5;
  return p;
}

// Largest horizontal distance from the trunk's axis of wood vertices at heights [low, high].
float radiusBetween(const TreeMesh& mesh, float low, float high) {
  float radius = 0.f;
  for (const glm::uvec3& t : mesh.wood_triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 v = mesh.vertices[t[corner]];
      if (v.z >= low && v.z <= high) radius = std::max(radius, std::hypot(v.x, v.y));
    }
  return radius;
}

std::string message(const WeberPenn& parameters) {
  try {
    grow(parameters, 1);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "";
}

}  // namespace

// Check that the same seed gives the same bytes and another seed another tree.
TEST(WeberPennTree, IsDeterministic) {
  const TreeMesh once = grow(species("cherry"), 7), again = grow(species("cherry"), 7);
  EXPECT_TRUE(sameBytes(once.vertices, again.vertices));
  EXPECT_TRUE(sameBytes(once.leaf_triangles, again.leaf_triangles));
  EXPECT_TRUE(sameBytes(once.wood_triangles, again.wood_triangles));
  EXPECT_TRUE(sameBytes(once.leaf_of_triangle, again.leaf_of_triangle));
  EXPECT_FALSE(sameBytes(once.vertices, grow(species("cherry"), 8).vertices));
}

// Check that the cherry has the size of the paper's: about 18,000 leaf triangles, and no more wood than it takes.
TEST(WeberPennTree, CherryHasThePapersSize) {
  const TreeMesh cherry = grow(species("cherry"), 1);
  EXPECT_GE(cherry.leaf_triangles.size(), 17'000u);
  EXPECT_LE(cherry.leaf_triangles.size(), 19'000u);
  EXPECT_GT(cherry.wood_triangles.size(), 10'000u);
  EXPECT_LE(cherry.wood_triangles.size(), 100'000u);
}

// Check the species of plain leaves: leaves are pairs of triangles of the stated size, the tree stands on the ground at
// the origin with its crown above, and the height is scale +- scale_v, give or take a branch that overtops the trunk.
class PlainSpecies : public testing::TestWithParam<std::string> {};
TEST_P(PlainSpecies, StandsAndBearsLeavesOfItsSize) {
  const WeberPenn& parameters = species(GetParam());
  const TreeMesh tree = grow(parameters, 1);
  EXPECT_EQ(tree.leaf_triangles.size(), 2u * tree.leaf_count);
  const double one = double{parameters.leaf_scale} * double{parameters.leaf_scale} * double{parameters.leaf_scale_x};
  // Corners are floats of up to 15 m: 1e-6 m of rounding on leaves of 0.08 m, and it averages out over the leaves.
  EXPECT_NEAR(leafArea(tree) / (tree.leaf_count * one), 1., 1e-5);

  const Bounds crown = leafBounds(tree), all = bounds(tree);
  EXPECT_NEAR(all.low.z, 0.f, 0.02f * parameters.scale);
  EXPECT_GT(crown.high.z, 0.6f * (parameters.scale - parameters.scale_v));
  EXPECT_LT(crown.high.z, 1.3f * (parameters.scale + parameters.scale_v));
  EXPECT_LT(std::max(crown.size().x, crown.size().y), 2.f * parameters.scale);
  // At breast height the trunk stands near the origin and is thinner than at the ground.
  EXPECT_LT(radiusBetween(tree, 0.f, 1e-3f), 0.1f * parameters.scale);
  EXPECT_GT(radiusBetween(tree, 0.f, 1e-3f), 0.f);
}

// Check that no leaf floats: the middle of its base edge, which lies on a twig's axis, is no further from an edge of
// the wood's triangles than twigs are thick, 3 cm.
TEST_P(PlainSpecies, LeavesAreAttachedToWood) {
  const TreeMesh tree = grow(species(GetParam()), 1);
  const auto distanceToEdge = [](const glm::vec3& p, const glm::vec3& a, const glm::vec3& b) {
    const float along = glm::dot(p - a, b - a) / std::max(1e-12f, glm::dot(b - a, b - a));
    return glm::distance(p, a + std::clamp(along, 0.f, 1.f) * (b - a));
  };
  const std::size_t step = 2 * (tree.leaf_count / 30);  // some 30 leaves: the search is by brute force
  for (std::size_t i = 0; i < tree.leaf_triangles.size(); i += step) {
    const glm::uvec3& leaf = tree.leaf_triangles[i];
    const glm::vec3 base = 0.5f * (tree.vertices[leaf.x] + tree.vertices[leaf.z]);
    float nearest = 1e9f;
    for (const glm::uvec3& t : tree.wood_triangles)
      nearest = std::min(nearest, distanceToEdge(base, tree.vertices[t.x], tree.vertices[t.z]));
    ASSERT_LT(nearest, 0.03f) << "leaf " << i / 2;
  }
}
INSTANTIATE_TEST_SUITE_P(Plants, PlainSpecies, testing::Values("black_oak", "cherry", "maple", "quaking_aspen"),
                         [](const auto& species_name) { return species_name.param; });

// Check a straight trunk against what its parameters say: height, radius = length * ratio at the ground, half of that
// half way up (taper 1 is a cone), a point at the top; and leaves of 0.1 x 0.05 m.
TEST(WeberPennTree, TrunkIsTheConeItsParametersSay) {
  const TreeMesh tree = grow(bareTrunk(), 3);
  EXPECT_NEAR(radiusBetween(tree, 0.f, 0.01f), 0.2f, 1e-5f);
  EXPECT_NEAR(radiusBetween(tree, 5.f, 10.f), 0.12f * 5.f / 6.f, 0.021f);  // rings stand every 2 m: at 6 m, 0.08 m
  EXPECT_NEAR(radiusBetween(tree, 9.99f, 10.01f), 0.f, 1e-5f);
  EXPECT_EQ(tree.leaf_count, 4u);
  EXPECT_NEAR(leafArea(tree), 4. * 0.1 * 0.05, 1e-7);
}

// Check that flare widens the foot by 1 + flare, and that the widening is over an eighth of the way up (Weber & Penn).
TEST(WeberPennTree, FlareWidensTheFootOnly) {
  WeberPenn parameters = bareTrunk();
  parameters.level[0].curve_res = 8;
  parameters.flare = 0.5f;
  const TreeMesh flared = grow(parameters, 3);
  EXPECT_NEAR(radiusBetween(flared, 0.f, 1e-3f), 0.2f * (1.f + 0.5f * 99.f / 100.f), 1e-5f);
  EXPECT_NEAR(radiusBetween(flared, 1.24f, 1.26f), 0.2f * 7.f / 8.f, 1e-5f);
}

// Check that splits multiply the trunk, and that pruning and the ground bound the crown. The envelope holds stems;
// leaves may stick out by their length.
TEST(WeberPennTree, SplitsPruningAndGroundShapeTheTree) {
  WeberPenn parameters = bareTrunk();
  const std::size_t single = grow(parameters, 3).wood_triangles.size();
  parameters.base_splits = 2;
  EXPECT_GT(grow(parameters, 3).wood_triangles.size(), 2 * single);

  WeberPenn cherry = species("cherry");
  cherry.prune_ratio = 1.f;
  cherry.prune_width = 0.3f;
  const Bounds narrow = leafBounds(grow(cherry, 1));
  const float limit = 0.3f * (cherry.scale + cherry.scale_v) + cherry.leaf_scale * 1.5f;
  EXPECT_LT(std::max({-narrow.low.x, -narrow.low.y, narrow.high.x, narrow.high.y}), limit);

  WeberPenn drooping = species("maple");
  drooping.level[1].down_angle = 150.f;
  EXPECT_GT(bounds(grow(drooping, 1)).low.z, -2.f * drooping.leaf_scale);
}

// Check that negative down_angle_v spreads the angle along the parent: low branches of the aspen hang, high ones rise.
TEST(WeberPennTree, NegativeDownAngleVariationRaisesUpperBranches) {
  WeberPenn parameters = bareTrunk();
  parameters.levels = 2;
  parameters.leaves = 3;
  parameters.level[1] = {.down_angle = 60.f, .down_angle_v = -50.f, .rotate = 140.f, .branches = 40, .length = 0.3f};
  const TreeMesh tree = grow(parameters, 1);
  // The last vertex of a branch's tube is its tip; on its 3 m its rise tells the angle. Rings of 8, then the tip.
  std::vector<std::pair<float, float>> rise_at_height;
  for (std::size_t i = 0; i + 8 < tree.wood_triangles.size(); ++i) {
    const glm::uvec3 &a = tree.wood_triangles[i], &b = tree.wood_triangles[i + 7];
    if (a.z != b.z || a.x + 8 != a.z) continue;  // a fan of eight about one tip
    const glm::vec3 foot = tree.vertices[a.x], tip = tree.vertices[a.z];
    rise_at_height.emplace_back(foot.z, (tip.z - foot.z) / glm::distance(tip, foot));
  }
  ASSERT_GE(rise_at_height.size(), 30u);
  std::sort(rise_at_height.begin(), rise_at_height.end());
  EXPECT_LT(rise_at_height.front().second, -0.1f);  // near cos 110 = -0.34 deg
  EXPECT_GT(rise_at_height.back().second, 0.6f);    // near cos 30 = 0.87 deg
}

// Check that parameters out of range are refused with the field, the value and the rule, NaN included.
TEST(WeberPennTree, RefusesParametersOutOfRange) {
  WeberPenn bad = bareTrunk();
  bad.scale = -1.f;
  EXPECT_EQ(message(bad), "WeberPenn.scale = -1: must be in [0.01, 1000]");
  bad = bareTrunk();
  bad.level[2].curve_v = std::nanf("");
  EXPECT_EQ(message(bad), "WeberPenn.level[2].curve_v = nan: must be in [-89, 720]");
  bad = bareTrunk();
  bad.level[1].branches = 1'000'000;
  EXPECT_NE(message(bad).find("level[1].branches"), std::string::npos);
  bad = bareTrunk();
  bad.leaves = 0;
  EXPECT_NE(message(bad).find("has no leaves"), std::string::npos) << message(bad);
}
