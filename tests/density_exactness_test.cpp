#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "plants/import.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

// The integral of the density is the leaf area, for 8, 128 (the default) and 256 cells along the tree. Error: each
// density is rounded to a float, 6e-8 at most.
void expectExact(const TreeMesh& mesh, const std::string& name) {
  const glm::vec3 size = leafBounds(mesh).size();
  const double area = leafArea(mesh);
  for (const float cells : {8.f, 128.f, 256.f}) {
    const DensityGrid grid = DensityGrid::voxelize(mesh, std::max({size.x, size.y, size.z}) / cells);
    EXPECT_NEAR(grid.leafArea() / area, 1., 1e-7) << name << ", " << cells << " cells along the tree";
  }
}

}  // namespace

// Check that the grids of grown trees hold the area of their leaves, from coarse cells to fine.
TEST(D1_DensityExactness, OfGrownTrees) {
  for (const std::string name : {"black_oak", "cherry", "maple", "quaking_aspen", "small_pine"})
    expectExact(grow(species(name), 1), name);
}

// Check the same of the trees that lie beside the repository, as far as they can be imported.
TEST(D1_DensityExactness, OfForeignTrees) {
  const fs::path folder = fs::path(SUNFLECK_SOURCE_DIR) / ".." / "shared" / "trees";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const fs::path kind = entry.path().extension(); kind == ".obj" || kind == ".ply" || kind == ".glb")
      files.push_back(entry.path());
  ASSERT_FALSE(files.empty());
  int trees = 0;
  for (const fs::path& file : files) {
    ImportedTree tree;
    try {
      tree = importTree(file);
    } catch (const InvalidInput&) {
      continue;
    }
    ++trees;
    expectExact(tree.mesh, file.filename().string());
  }
  EXPECT_GT(trees, 0);
}
