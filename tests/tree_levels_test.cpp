// Check that a tree's levels of detail keep the area of its leaves, and that its triangles keep their numbers.
#include "render/gl/tree_levels.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>
#include <set>

#include "plants/random_leaves.hpp"
#include "plants/species.hpp"

namespace {

using namespace sunfleck;

double areaOf(const gl::TreeLevels& levels, const gl::Level& level) {
  double area = 0.;
  for (std::uint32_t i = level.firstIndex(); i < level.endIndex(); i += 3) {
    const glm::dvec3 a = levels.vertices[levels.indices[i]], b = levels.vertices[levels.indices[i + 1]],
                     c = levels.vertices[levels.indices[i + 2]];
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

std::set<std::uint32_t> leavesOf(const gl::TreeLevels& levels, const gl::Level& level) {
  std::set<std::uint32_t> leaves;
  for (std::uint32_t i = level.firstIndex(); i < level.endIndex(); i += 3)
    leaves.insert(levels.triangles[levels.indices[i + 2]].leaf);
  return leaves;
}

// (R25) Check that each level has the leaves of the one before by the root of 2, to a leaf, all of them among its
// leaves and of one triangle each, and the same area (to the roundings of some thousand vertices), and that it lies
// within the box.
TEST(R25_TreeLevels, KeepTheAreaOfLeaves) {
  const TreeMesh mesh = randomCrown({}, 3);
  const gl::TreeLevels levels = gl::treeLevels(mesh);
  const double area = leafArea(mesh);
  ASSERT_GT(levels.leaves.size(), 4u);
  std::set<std::uint32_t> before = leavesOf(levels, levels.leaves[0]);
  EXPECT_EQ(before.size(), mesh.leaf_count);
  for (std::size_t i = 0; i < levels.leaves.size(); ++i) {
    EXPECT_NEAR(areaOf(levels, levels.leaves[i]), area, 1e-5 * area) << i;
    const std::set<std::uint32_t> now = leavesOf(levels, levels.leaves[i]);
    if (i > 0) {
      EXPECT_NEAR(static_cast<double>(now.size()), std::numbers::sqrt2 / 2. * static_cast<double>(before.size()), 1.);
      EXPECT_EQ(levels.leaves[i].endIndex() - levels.leaves[i].firstIndex(), 3 * now.size());
    }
    for (const std::uint32_t leaf : now) EXPECT_TRUE(before.contains(leaf));
    before = now;
  }
}

// (R25) Check that triangle i is drawn with vertex i last, that the first are the mesh's own, and that clusters hold
// their triangles.
TEST(R25_TreeLevels, NumberTrianglesByTheirLastVertex) {
  const TreeMesh mesh = grow(species("cherry"), 1);
  const gl::TreeLevels levels = gl::treeLevels(mesh);
  const std::size_t leaf_triangles = mesh.leaf_triangles.size();
  std::vector<int> drawn(levels.triangles.size());
  for (const auto* all : {&levels.leaves, &levels.wood})
    for (const gl::Level& level : *all)
      for (const gl::Cluster& cluster : level.clusters)
        for (std::uint32_t i = cluster.first_index; i < cluster.end_index; i += 3) {
          const std::uint32_t number = levels.indices[i + 2];
          ASSERT_LT(number, levels.triangles.size());
          ++drawn[number];
          const gl::TriangleData& data = levels.triangles[number];
          const glm::vec3 normal = glm::normalize(glm::vec3(data.plane));
          for (std::uint32_t corner = i; corner < i + 3; ++corner) {
            const glm::vec3 at = levels.vertices[levels.indices[corner]];
            EXPECT_NEAR(glm::dot(normal, at), data.plane.w, 1e-4f);  // roundings of some 10 m
            EXPECT_EQ(glm::clamp(at, cluster.box.low, cluster.box.high), at);
          }
          if (number >= leaf_triangles + mesh.wood_triangles.size()) continue;
          const glm::uvec3 own =
              number < leaf_triangles ? mesh.leaf_triangles[number] : mesh.wood_triangles[number - leaf_triangles];
          std::set<float> x, expected;
          for (int corner = 0; corner < 3; ++corner) {
            x.insert(levels.vertices[levels.indices[i + static_cast<std::uint32_t>(corner)]].x);
            expected.insert(mesh.vertices[own[corner]].x);
          }
          EXPECT_EQ(x, expected);
        }
  for (const int count : drawn) EXPECT_EQ(count, 1);
}

}  // namespace
