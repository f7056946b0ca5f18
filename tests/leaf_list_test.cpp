// Check lists of leaves, a line `radius x y z nx ny nz` for each.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/require.hpp"
#include "plants/import.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

class LeafList : public testing::Test {
 protected:
  fs::path file(const std::string& content) const { return folder_.write("t.txt", content); }
  std::string refusal(const std::string& content, const ImportRules& rules = {}) const {
    try {
      importTree(file(content), rules);
    } catch (const InvalidInput& e) {
      return folder_.without(e.what());
    }
    return "";
  }

  TemporaryFolder folder_;
};

}  // namespace

// Check two leaves: polygons of 12 corners of their discs' area about their centres, across their normals of any
// length; within the rounding of floats of a metre. Comments, blank lines and lines of other systems are taken.
TEST_F(LeafList, LeavesAreDiscs) {
  const ImportedTree tree = importTree(file("# made for a test\n\n0.1 1 2 3 0 0 5 # up\r\n+2e-1\t0 0 1  1 -1 0"));
  const TreeMesh& mesh = tree.mesh;
  ASSERT_EQ(mesh.leaf_count, 2u);
  EXPECT_EQ(mesh.leaf_triangles.size(), 20u);
  EXPECT_EQ(mesh.vertices.size(), 24u);
  const std::vector<double> areas = leafAreas(mesh);
  EXPECT_NEAR(areas[0], std::numbers::pi * 0.01, 1e-7);
  EXPECT_NEAR(areas[1], std::numbers::pi * 0.04, 1e-7);
  for (std::size_t i = 0; i < 24; ++i) {
    const glm::vec3 from = mesh.vertices[i] - (i < 12 ? glm::vec3(1, 2, 3) : glm::vec3(0, 0, 1));
    EXPECT_NEAR(glm::dot(from, i < 12 ? glm::vec3(0, 0, 1) : glm::vec3(1, -1, 0)), 0.f, 1e-6f) << i;
    // 12 corners of the disc's area lie 2.3 % further out than its edge: sqrt(pi / (6 sin 30)).
    EXPECT_NEAR(glm::length(from), (i < 12 ? 0.1f : 0.2f) * 1.0233267f, 1e-6f) << i;
  }
  ImportRules rules;
  rules.scale = 10.f;
  EXPECT_NEAR(leafArea(importTree(folder_ / "t.txt", rules).mesh), std::numbers::pi * 5., 1e-4);
}

TEST_F(LeafList, BrokenListsAreRefused) {
  EXPECT_EQ(refusal("# nothing\n"), "t.txt: has no leaves");
  EXPECT_EQ(refusal("0.1 0 0 0 0 0 1\n0.1 0 0 0 0 0\n"), "t.txt line 2: nz = (missing): must be a finite number");
  EXPECT_EQ(refusal("0.1 0 0 0 0 0 1 1\n"),
            "t.txt line 1: eighth number = 1: must be absent: a leaf is radius x y z nx ny nz");
  EXPECT_EQ(refusal("0 0 0 0 0 0 1\n"), "t.txt line 1: radius = 0: must be above 0");
  EXPECT_EQ(refusal("0.1 0 0 0 0 0 0\n"), "t.txt line 1: length of the normal = 0: must be above 0");
  EXPECT_EQ(refusal("0.1 0 nan 0 0 0 1\n"), "t.txt line 1: y = nan: must be a finite number");
  EXPECT_EQ(refusal("0.1 0 1e99 0 0 0 1\n"), "t.txt line 1: y = 1e99: must be a finite number");
  EXPECT_EQ(refusal("\x7f\x45\x4c\x46 1 2"), "t.txt line 1: radius = ?ELF: must be a finite number");
  EXPECT_EQ(refusal("0.1 0 0 2e4 0 0 1\n").substr(0, 17), "t.txt: vertex 1 z");
  ImportRules named;
  named.wood = {"bark"};
  EXPECT_NE(refusal("0.1 0 0 0 0 0 1\n", named).find("has no names"), std::string::npos);
}

// Check the reference canopy, where it lies beside the repository: 59,683 leaves of 0.1 m radius over 25 x 25 m are a
// leaf area index of 3 by the discs' area, to the rounding of its seven digits.
TEST_F(LeafList, ReferenceCanopy) {
  const fs::path canopy = fs::path(SUNFLECK_SOURCE_DIR) / ".." / "shared" / "reference" / "canopy_leaves.txt";
  if (!fs::exists(canopy)) return;
  const TreeMesh mesh = importTree(canopy).mesh;
  EXPECT_EQ(mesh.leaf_count, 59'683u);
  EXPECT_NEAR(leafArea(mesh) / 625., 59'683. * std::numbers::pi * 0.01 / 625., 1e-5);
}
