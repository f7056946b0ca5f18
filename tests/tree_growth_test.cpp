#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "plants/leaf_shape.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"

using namespace sunfleck;

namespace {

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool sameBytes(const TreeMesh& a, const TreeMesh& b) {
  return sameBytes(a.vertices, b.vertices) && sameBytes(a.leaf_triangles, b.leaf_triangles) &&
         sameBytes(a.wood_triangles, b.wood_triangles) && sameBytes(a.leaf_of_triangle, b.leaf_of_triangle) &&
         a.leaf_count == b.leaf_count;
}

// FNV-1a of the vertices' bytes.
std::uint64_t hashOf(const TreeMesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const glm::vec3& v : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &v[axis], sizeof bits);
      for (int byte = 0; byte < 4; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 0xffu)) * 0x100000001b3u;
    }
  return hash;
}

// A straight upright trunk of 10 m that bears leaves of 0.1 m.
WeberPenn trunkWithLeaves(int leaves) {
  WeberPenn p;
  p.scale = 10.f;
  p.levels = 1;
  p.ratio = 0.002f;
  p.leaves = leaves;
  p.leaf_scale = 0.1f;
  p.level[0].length = 1.f;
  p.level[0].curve_res = 5;
  return p;
}

// Tips of branches, whose tubes have eight sides: fans of eight triangles about one vertex.
std::vector<glm::vec3> tipsOfBranches(const TreeMesh& mesh) {
  std::vector<glm::vec3> tips;
  for (std::size_t i = 0; i + 7 < mesh.wood_triangles.size(); ++i) {
    const glm::uvec3 &a = mesh.wood_triangles[i], &b = mesh.wood_triangles[i + 7];
    const bool first = i == 0 || mesh.wood_triangles[i - 1].z != a.z;
    if (first && a.z == b.z && a.x + 8 == a.z) tips.push_back(mesh.vertices[a.z]);
  }
  return tips;
}

// First vertex of each leaf of a plain-leaved tree: leaves have four in a row.
struct PlainLeaf {
  glm::dvec3 base, along;
};
std::vector<PlainLeaf> plainLeaves(const TreeMesh& mesh) {
  std::vector<PlainLeaf> leaves;
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); i += 2) {
    const glm::uvec3& t = mesh.leaf_triangles[i];
    const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    leaves.push_back({0.5 * (a + c), glm::normalize(b - c)});
  }
  return leaves;
}

double degrees(double radians) {
  return radians * 180. / std::numbers::pi;
}

}  // namespace

// Check that any number of threads grows the same bytes, of stems that grow together and of ones that hang together by
// their splits, with shaped leaves, blossoms and petioles.
TEST(TreeGrowth, IsTheSameForAnyNumberOfThreads) {
  for (const std::string name : {"black_oak", "apple", "quaking_aspen"}) {
    const auto grownBy = [&](std::size_t threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return grow(species(name), 3);
    };
    const TreeMesh alone = grownBy(1);
    for (const std::size_t threads : {2, 5}) EXPECT_TRUE(sameBytes(alone, grownBy(threads))) << name;
  }
}

// Check the bytes of trees against what they were: they hang on no processor and no C library.
TEST(TreeGrowth, KeepsItsBytes) {
  EXPECT_EQ(hashOf(grow(species("cherry"), 1)), 16319908883772566539u);
  EXPECT_EQ(hashOf(grow(species("maple"), 1)), 16379854266847264220u);
  EXPECT_EQ(hashOf(grow(species("quaking_aspen"), 1)), 5096695611490303268u);
  EXPECT_EQ(hashOf(grow(species("apple"), 1)), 4797147102438737601u);
}

// Check that grown trees number their leaves as finish() would, and leave nothing for it to drop.
TEST(TreeGrowth, NumbersLeavesAsAllMeshesDo) {
  for (const std::string name : {"cherry", "aspen", "japanese_maple"}) {
    const TreeMesh grown = grow(species(name), 1);
    TreeMesh finished = grown;
    const Dropped dropped = finish(finished, name);
    EXPECT_EQ(dropped.leaf_triangles + dropped.wood_triangles, 0u) << name;
    EXPECT_TRUE(sameBytes(grown, finished)) << name;
  }
}

// Check the areas of outlines, flat, folded about the midrib or bent along it in flat pieces, which all keep it: to the
// rounding of floats of up to 10 m, 1e-6 m on leaves of 0.1 m, which averages out. The shape's share is a polygon's, by
// the shoelace formula. Both together stretch the joints of the pieces: by tan 15 deg of the height over the midrib,
// 0.009 of the length on either side.
TEST(TreeGrowth, LeavesHaveTheAreaOfTheirOutline) {
  for (const LeafShape shape : leafShapes()) {
    WeberPenn p = trunkWithLeaves(50);
    p.leaf_shape = shape;
    p.leaf_scale_x = 0.7f;
    const double whole = 50. * 0.1 * 0.1 * 0.7 * areaShare(shape);
    const TreeMesh flat = grow(p, 1);
    EXPECT_EQ(flat.leaf_count, 50u) << nameOf(shape);
    EXPECT_NEAR(leafArea(flat) / whole, 1., 2e-5) << nameOf(shape);
    p.leaf_fold = 30.f;
    EXPECT_NEAR(leafArea(grow(p, 1)) / whole, 1., 2e-5) << nameOf(shape);
    p.leaf_fold = 0.f;
    for (const float curl : {-60.f, 30.f, 100.f}) {
      p.leaf_curl = curl;
      EXPECT_NEAR(leafArea(grow(p, 1)) / whole, 1., 2e-5) << nameOf(shape) << " bent by " << curl;
    }
    p.leaf_fold = p.leaf_curl = 30.f;
    EXPECT_NEAR(leafArea(grow(p, 1)) / whole, 1., 0.03) << nameOf(shape);
  }
}

// Check the shares of shapes that geometry tells: a rectangle is 1, an ellipse pi / 4 less what its twelve chords cut
// off; and that all outlines run from base to tip within their width.
TEST(TreeGrowth, OutlinesAreSound) {
  EXPECT_EQ(areaShare(LeafShape::rectangle), 1.);
  EXPECT_NEAR(areaShare(LeafShape::elliptic), std::numbers::pi / 4., 0.04);
  for (const LeafShape shape : leafShapes()) {
    const auto half = halfOutline(shape);
    EXPECT_EQ(half.front(), glm::dvec2(0., 0.)) << nameOf(shape);
    EXPECT_EQ(half.back(), glm::dvec2(0., 1.)) << nameOf(shape);
    double widest = 0.;
    for (const glm::dvec2& p : half) {
      EXPECT_GE(p.x, 0.) << nameOf(shape);
      widest = std::max(widest, p.x);
    }
    EXPECT_EQ(widest, 1.) << nameOf(shape);
    EXPECT_GT(areaShare(shape), 0.3) << nameOf(shape);
    EXPECT_LE(areaShare(shape), 1.) << nameOf(shape);
  }
}

// Check that sizes vary as they say: lengths uniform in +-30 % give a mean area of 1 + 0.3^2 / 3 times the plain one.
// The area's standard deviation is below 2 * 0.3 / sqrt 3 * 1.1 = 0.38 of it; 4 standard errors are allowed.
TEST(TreeGrowth, LeafSizesVaryAsTheySay) {
  WeberPenn p = trunkWithLeaves(1000);
  p.leaf_scale_v = 0.3f;
  EXPECT_NEAR(leafArea(grow(p, 1)) / (1000. * 0.01), 1. + 0.03, 4. * 0.38 / std::sqrt(1000.));
}

// Check the share of blossoms: binomial; 4 standard errors are allowed. Blossoms have ten times the triangles.
TEST(TreeGrowth, BlossomsTakeTheirShare) {
  WeberPenn p = trunkWithLeaves(1000);
  p.blossom_rate = 0.35f;
  const TreeMesh tree = grow(p, 1);
  std::vector<int> triangles(tree.leaf_count, 0);
  for (const std::uint32_t leaf : tree.leaf_of_triangle) ++triangles[leaf];
  const auto blossoms = std::count_if(triangles.begin(), triangles.end(), [](int n) { return n > 2; });
  EXPECT_EQ(tree.leaf_count, 1000u);
  EXPECT_NEAR(static_cast<double>(blossoms) / 1000., 0.35, 4. * std::sqrt(0.35 * 0.65 / 1000.));
}

// Check that a leaf on a petiole stands off the axis of its twig by the petiole's length, and that the petiole is wood.
TEST(TreeGrowth, PetiolesCarryTheirLeaves) {
  WeberPenn p = trunkWithLeaves(40);
  p.level[1].down_angle = 90.f;
  const std::size_t bare_wood = grow(p, 1).wood_triangles.size();
  p.leaf_petiole = 0.6f;
  const TreeMesh tree = grow(p, 1);
  EXPECT_EQ(tree.wood_triangles.size(), bare_wood + 3 * 40);
  for (const PlainLeaf& leaf : plainLeaves(tree))
    EXPECT_NEAR(std::hypot(leaf.base.x, leaf.base.y), 0.6 * 0.1, 1e-5);  // rounding of floats of up to 10 m
}

// Check the angles of leaves to their twig: uniform in 50 +- 20 degrees, so that their mean is 50 within 4 standard
// errors of 20 / sqrt(3 n), and their variance 20^2 / 3 within 4 of its: var(u^2) = 4 / 45 of v^4.
TEST(TreeGrowth, DownAnglesAreSpreadAsTheySay) {
  WeberPenn p = trunkWithLeaves(1000);
  p.level[1].down_angle = 50.f;
  p.level[1].down_angle_v = 20.f;
  p.level[1].rotate = 77.f;
  const std::vector<PlainLeaf> leaves = plainLeaves(grow(p, 1));
  double sum = 0., squares = 0., most = 0.;
  for (const PlainLeaf& leaf : leaves) {
    const double off = degrees(std::acos(leaf.along.z)) - 50.;
    sum += off;
    squares += off * off;
    most = std::max(most, std::abs(off));
  }
  const auto n = static_cast<double>(leaves.size());
  EXPECT_NEAR(sum / n, 0., 4. * 20. / std::sqrt(3. * n));
  EXPECT_NEAR(squares / n, 400. / 3., 4. * 400. * std::sqrt(4. / 45. / n));
  EXPECT_LT(most, 20.01);  // degrees, from floats
  // Each leaf is turned by 77 degrees about the twig from the one before.
  for (std::size_t i = 1; i < leaves.size(); ++i) {
    const auto azimuth = [&](std::size_t k) { return degrees(std::atan2(leaves[k].along.y, leaves[k].along.x)); };
    EXPECT_NEAR(std::abs(std::remainder(azimuth(i) - azimuth(i - 1), 360.)), 77., 0.02);
  }
}

// Check numbers of branches and leaves that the parameters tell. A trunk of 40 branches bears 40. A branch at the share
// s of the trunk bears leaves * (0.5 + 0.5 s) of them, rounded with the rest carried on: 25 * 40 * 0.75 in all where
// the branches are evenly spread, within the 25 * 40 * 0.5 / 40 / 2 that the random place of the first one changes.
TEST(TreeGrowth, BranchesAndLeavesAreAsManyAsTheySay) {
  WeberPenn p = trunkWithLeaves(25);
  p.levels = 2;
  p.level[1] = {.down_angle = 60.f, .rotate = 140.f, .branches = 40, .length = 0.3f};
  const TreeMesh tree = grow(p, 1);
  EXPECT_EQ(tipsOfBranches(tree).size(), 40u);
  EXPECT_NEAR(tree.leaf_count, 25. * 40. * 0.75, 25. * 40. * 0.5 / 40. / 2. + 1.);
}

// Check a fan of branches at the tip and a fan of leaves: as many as they say, and all at the end of their parent.
TEST(TreeGrowth, NegativeNumbersMakeFans) {
  WeberPenn p = trunkWithLeaves(-7);
  p.levels = 2;
  p.level[1] = {.down_angle = 30.f, .rotate = 120.f, .branches = -9, .length = 0.2f};
  p.level[2] = {.down_angle = 10.f, .rotate = 90.f};
  const TreeMesh tree = grow(p, 1);
  const std::vector<glm::vec3> tips = tipsOfBranches(tree);
  EXPECT_EQ(tips.size(), 9u);
  EXPECT_EQ(tree.leaf_count, 63u);
  for (const glm::vec3& tip : tips) EXPECT_NEAR(glm::distance(tip, glm::vec3(0.f, 0.f, 10.f)), 2.f, 1e-4f);
  for (const PlainLeaf& leaf : plainLeaves(tree)) {
    float nearest = 1e9f;
    for (const glm::vec3& tip : tips) nearest = std::min(nearest, glm::distance(glm::vec3(leaf.base), tip));
    EXPECT_LT(nearest, 1e-5f);
  }
}

// Check that a curve turns a stem by what it says: a branch that leaves an upright trunk at 90 degrees and curves by 60
// ends at 150 degrees after n segments of a circle's chords; its rise is the sum of their cosines. With curve_back the
// first half turns by the one and the second by the other.
TEST(TreeGrowth, StemsCurveAsTheySay) {
  WeberPenn p = trunkWithLeaves(1);
  p.levels = 2;
  p.level[1] = {.down_angle = 90.f, .rotate = 140.f, .branches = 12, .length = 0.2f, .curve_res = 6, .curve = 60.f};
  const auto expectRise = [&](double rise) {
    const TreeMesh tree = grow(p, 1);
    const std::vector<glm::vec3> tips = tipsOfBranches(tree);
    ASSERT_EQ(tips.size(), 12u);
    const double spacing = 5. / 12.;
    std::vector<double> heights;
    for (const glm::vec3& tip : tips) heights.push_back(double{tip.z});
    std::sort(heights.begin(), heights.end());
    // Feet are spaced evenly; their tips lie higher by the same rise on branches of the same length.
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double length = 2., foot = heights[i] - length * rise;
      EXPECT_NEAR(foot, heights[0] - length * rise + static_cast<double>(i) * spacing, 1e-4);
      EXPECT_GT(foot, 5. - 1e-4);
      EXPECT_LT(foot, 5. + static_cast<double>(i + 1) * spacing + 1e-4);
    }
  };
  p.level[0].base_size = 0.5f;              // above the ground, which would shorten them
  p.shape = WeberPenn::Shape::cylindrical;  // all branches of 2 m
  const auto riseOf = [](const std::vector<double>& turns) {
    double angle = 90., rise = 0.;
    for (const double turn : turns) {
      angle += turn;
      rise += std::cos(angle * std::numbers::pi / 180.) / static_cast<double>(turns.size());
    }
    return rise;
  };
  expectRise(riseOf({10., 10., 10., 10., 10., 10.}));
  p.level[1].curve = -60.f;
  expectRise(riseOf({-10., -10., -10., -10., -10., -10.}));
  p.level[1].curve = 30.f;
  p.level[1].curve_back = -90.f;
  expectRise(riseOf({10., 10., 10., -30., -30., -30.}));
}

// Check a helix: its segments stand at the angle to the axis that it says, and four of them make a turn, so that the
// tip of a stem of eight lies on the axis again, at the cosine of the angle times the length.
TEST(TreeGrowth, NegativeCurveVariationWindsAHelix) {
  WeberPenn p = trunkWithLeaves(1);
  p.level[0].curve_res = 8;
  p.level[0].curve_v = -30.f;
  const TreeMesh tree = grow(p, 1);
  EXPECT_NEAR(bounds(tree).high.z, 10. * std::cos(std::numbers::pi / 6.), 0.1);  // a leaf of 0.1 m at its tip
  glm::vec3 tip(0.f);
  for (const glm::uvec3& t : tree.wood_triangles)
    for (int corner = 0; corner < 3; ++corner)
      if (tree.vertices[t[corner]].z > tip.z) tip = tree.vertices[t[corner]];
  EXPECT_NEAR(std::hypot(tip.x, tip.y), 0., 1e-5);
  EXPECT_NEAR(tip.z, 10. * std::cos(std::numbers::pi / 6.), 1e-5);
}

// Check that base splits at random take every number from 0 on as often as the others: 3 of them, by the trees of 300
// seeds; a share's standard error is sqrt(2 / 9 / 300) = 0.027.
TEST(TreeGrowth, NegativeBaseSplitsAreRandom) {
  WeberPenn p = trunkWithLeaves(1);
  p.base_splits = -2;
  const auto wood = [&](std::uint64_t seed) { return grow(p, seed).wood_triangles.size(); };
  std::map<std::size_t, int> seen;
  for (std::uint64_t seed = 0; seed < 300; ++seed) ++seen[wood(seed)];
  ASSERT_EQ(seen.size(), 3u);
  for (const auto& [triangles, count] : seen) EXPECT_NEAR(count / 300., 1. / 3., 4. * 0.027);
}

// Check the carried rounding of splits: 60 branches of 10 segments with 0.1 splits each. A branch that has split asks
// for half as many on each of its two strands, so in all one for each branch but the last places, where none follows:
// between 0.5 and 1 a branch.
TEST(TreeGrowth, SplitsCarryTheirRoundingOn) {
  WeberPenn p = trunkWithLeaves(1);
  p.levels = 2;
  p.level[1] = {.down_angle = 60.f,
                .rotate = 140.f,
                .branches = 60,
                .length = 0.2f,
                .seg_splits = 0.1f,
                .split_angle = 20.f,
                .curve_res = 11};
  const std::size_t strands = tipsOfBranches(grow(p, 1)).size();
  EXPECT_NEAR(static_cast<double>(strands), 60. * (1. + 10. * 0.1),
              6.);  // of 10 places each, and what strands late in a stem owe
}

// Check that four levels of stems bear leaves, on the fourth.
TEST(TreeGrowth, GrowsFourLevels) {
  WeberPenn p = trunkWithLeaves(10);
  for (std::size_t n = 1; n < 4; ++n) p.level[n] = {.down_angle = 50.f, .rotate = 140.f, .branches = 6, .length = 0.4f};
  p.levels = 3;
  const std::uint32_t three = grow(p, 1).leaf_count;
  p.levels = 4;
  EXPECT_GT(grow(p, 1).leaf_count, 2 * three);
}
