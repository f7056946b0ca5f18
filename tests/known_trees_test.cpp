// Check trees of other programs, where they lie beside the repository: leaves, leaf triangles and wood triangles as
// their makers made them, and the leaves' area as it was measured before. Without them, trees of ours stand in.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "plants/import.hpp"
#include "plants/species.hpp"
#include "plants/write_obj.hpp"
#include "render/image_file.hpp"
#include "render/scene_file.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

const fs::path kTrees = fs::path(SUNFLECK_SOURCE_DIR) / ".." / "shared" / "trees";

struct Known {
  std::string name;
  std::uint32_t leaves;
  std::size_t leaf_triangles, wood_triangles;  // in the file, those of no area among them
  double area;                                 // one-sided, of leaves [m^2]
};

}  // namespace

TEST(KnownTrees, AreReadAsTheirMakersMadeThem) {
  const TemporaryFolder own;
  const TreeMesh maple = grow(species("maple"), 1);
  writeObj(own / "own.obj", maple);
  const TreeMesh read = importTree(own / "own.obj").mesh;
  EXPECT_EQ(read.leaf_count, maple.leaf_count);
  EXPECT_EQ(leafArea(read), leafArea(maple));

  for (const Known& known : {Known{"AlmondWP.obj", 24'150, 48'300, 116'936, 289.8},
                             Known{"treegen_acer_s2.obj", 2'429, 21'861, 54'012, 29.9},
                             Known{"treegen_acer_s2_difftrans.glb", 2'429, 21'861, 54'012, 29.9},
                             Known{"treegen_quaking_aspen_s1.obj", 15'364, 138'276, 57'980, 105.3},
                             Known{"treegen_quaking_aspen_s1.glb", 15'364, 138'276, 57'980, 105.3},
                             Known{"leafcube_lai2_spherical.obj", 20'665, 41'335, 0, 1.988},
                             Known{"ellipsoid18k.ply", 9'000, 18'000, 0, 22.5}}) {
    if (!fs::exists(kTrees / known.name)) continue;
    const ImportedTree tree = importTree(kTrees / known.name, {}, readOpacity);
    EXPECT_EQ(tree.mesh.leaf_count, known.leaves) << known.name;
    EXPECT_EQ(tree.mesh.leaf_triangles.size() + tree.dropped.leaf_triangles + tree.dropped.doubled,
              known.leaf_triangles)
        << known.name;
    EXPECT_EQ(tree.mesh.wood_triangles.size() + tree.dropped.wood_triangles, known.wood_triangles) << known.name;
    EXPECT_NEAR(leafArea(tree.mesh), known.area, 5e-4 * known.area) << known.name;  // as many digits as are known
    EXPECT_EQ(tree.card_area, 0.) << known.name;
  }
}

// Check the oak of cards: 5,320 twigs, of whose cards about a quarter is leaf, cut within a percent of the mask's exact
// area; other commands than trace take it then.
TEST(KnownTrees, OakOfCardsIsCut) {
  const fs::path oak = kTrees / "eztree_oak_medium.obj";
  if (!fs::exists(oak)) return;
  const ImportedTree cut = importTree(oak, {}, readOpacity);
  const ImportedTree masked =
      importTree(oak, {.leaf = {}, .wood = {}, .cards = ImportRules::Cards::mask, .mesh = {}}, readOpacity);
  EXPECT_EQ(cut.mesh.leaf_count, 5'320u);
  EXPECT_EQ(masked.mesh.leaf_count, 5'320u);
  EXPECT_EQ(masked.mesh.leaf_triangles.size(), 10'640u);
  EXPECT_NEAR(masked.cut_area / masked.card_area, 0.25, 0.03);
  EXPECT_NEAR(cut.cut_area / masked.cut_area, 1., 0.01);
  EXPECT_NEAR(leafArea(cut.mesh), cut.cut_area, 1e-9 * cut.cut_area);
  EXPECT_LT(cut.mesh.leaf_triangles.size(), 5'320u * 450u);
}

// Check that a file's own colours of leaves reach the scene: (1 - .5) of the base colour reflected, .5 of the other
// passed, as the acer's material says.
TEST(KnownTrees, GltfBringsItsLeafColours) {
  const fs::path acer = kTrees / "treegen_acer_s2_difftrans.glb";
  if (!fs::exists(acer)) return;
  const Scene scene = readScene(acer.string());
  const BandOptics& leaf = scene.kinds.front().leaf;
  EXPECT_NEAR(leaf[0].reflectance, 0.5 * 0.11764705882352941, 1e-6);
  EXPECT_NEAR(leaf[1].reflectance, 0.5 * 0.35294117647058826, 1e-6);
  EXPECT_NEAR(leaf[1].transmittance, 0.5 * 0.45, 1e-6);
  EXPECT_NEAR(leaf[2].transmittance, 0.5 * 0.05, 1e-6);
}
