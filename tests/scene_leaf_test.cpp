// Leaves of scenes and sweeps that are told by what they are.
#include <gtest/gtest.h>

#include "core/require.hpp"
#include "leaves/light_bands.hpp"
#include "leaves/measured_leaves.hpp"
#include "leaves/prospect.hpp"
#include "leaves/slab_leaf.hpp"
#include "render/scene_file.hpp"
#include "render/scene_writer.hpp"
#include "render/sweep_file.hpp"
#include "tests/temporary_folder.hpp"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

// A folder of its own for each test, with a tree of one leaf, removed afterwards.
class SceneLeaf : public testing::Test {
 protected:
  SceneLeaf() { write("tree.obj", "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nusemtl leaf\nf 1 2 3 4\n"); }

  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text).string();
  }
  std::string refusal(const std::string& toml) const {
    try {
      readScene(write("s.toml", toml));
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

// Check that species and contents reach the leaves of every kind of tree and of a medium, that a tree has the scene's
// unless it has its own, and that a gloss stays beside them.
TEST_F(SceneLeaf, ComesFromSpeciesAndContents) {
  const Scene scene = readScene(write("s.toml", R"(
[leaf]
species = "beech"
gloss = 0.25
[[tree]]
file = "tree.obj"
name = "a"
[[tree]]
file = "tree.obj"
name = "b"
leaf_prospect = { chlorophyll = 10.0 }
[[tree]]
file = "tree.obj"
name = "c"
leaf_species = "corn"
leaf_prospect = { chlorophyll = 10.0 }
leaf_gloss = 0.0
[[tree]]
file = "tree.obj"
name = "d"
leaf_reflectance = 0.1
[medium]
density = 1.0
box = [0, 0, 0, 1, 1, 1]
species = "clover"
[stand]
kind = "positions"
positions = [[0, 0], [3, 0], [6, 0], [9, 0]]
)"));
  const auto expect = [](const BandOptics& leaf, const LeafContents& contents) {
    const BandOptics expected = bandOptics(prospect(contents));
    for (std::size_t band = 0; band < kBands; ++band) {
      EXPECT_EQ(leaf[band].reflectance, expected[band].reflectance);
      EXPECT_EQ(leaf[band].transmittance, expected[band].transmittance);
    }
  };
  const LeafContents beech = measuredLeaf("beech").contents;
  LeafContents pale_corn = measuredLeaf("corn").contents;
  pale_corn.chlorophyll = 10.;
  expect(scene.kinds[0].leaf, beech);
  expect(scene.kinds[1].leaf, {.chlorophyll = 10.});
  expect(scene.kinds[2].leaf, pale_corn);
  expect(scene.media[0].optics, measuredLeaf("clover").contents);
  for (const std::size_t kind : {0u, 1u, 3u}) EXPECT_EQ(scene.kinds[kind].leaf[1].gloss, 0.25f);
  EXPECT_EQ(scene.kinds[2].leaf[1].gloss, 0.f);
  EXPECT_EQ(scene.media[0].optics[1].gloss, 0.f);
  const BandOptics of_beech = bandOptics(prospect(beech));
  EXPECT_EQ(scene.kinds[3].leaf[1].reflectance, 0.1f);
  EXPECT_EQ(scene.kinds[3].leaf[1].transmittance, of_beech[1].transmittance);
}

// Check that bands_nm says what the bands are, and that a scene written and read again has the same leaves.
TEST_F(SceneLeaf, HasTheBandsItIsTold) {
  const Scene scene = readScene(write("s.toml", R"(
[tree]
file = "tree.obj"
[leaf]
species = "walnut"
bands_nm = [[620, 680], 850, 450.5]
)"));
  const LeafSpectrum walnut = prospect(measuredLeaf("walnut").contents);
  EXPECT_EQ(scene.kinds[0].leaf[0], leafOptics(meanIn(walnut, {620., 680.})));
  EXPECT_EQ(scene.kinds[0].leaf[1], leafOptics(meanIn(walnut, {850., 850.})));
  EXPECT_EQ(scene.kinds[0].leaf[2], leafOptics(meanIn(walnut, {450.5, 450.5})));
  writeScene(folder_ / "again.toml", scene);
  EXPECT_EQ(readScene((folder_ / "again.toml").string()).kinds[0].leaf, scene.kinds[0].leaf);
}

// Check that a scene written and read again tells the leaves of its kinds and media as it did, to the bit, and writes
// no more than what is different from a species.
TEST_F(SceneLeaf, IsWrittenAsItIsTold) {
  for (const std::string bands : {"", "bands_nm = [[620, 680.5], 550, 850]\n"}) {
    const Scene scene = readScene(write("s.toml", "[leaf]\n" + bands + R"(gloss = 0.1
slab = { absorption = [2.0, 0.3, 4.0], scattering = 10.1, thickness = 0.123456789012345 }
[[tree]]
file = "tree.obj"
name = "tissue"
[[tree]]
file = "tree.obj"
name = "species"
leaf_species = "beech"
[[tree]]
file = "tree.obj"
name = "changed"
leaf_species = "corn"
leaf_prospect = { protein = 0.001, carbon_constituents = 0.004 }
[[tree]]
file = "tree.obj"
name = "contents"
leaf_prospect = { chlorophyll = 31.41592653589793, dry_matter = 0.0 }
[[tree]]
file = "tree.obj"
name = "usual"
leaf_prospect = {}
[[tree]]
file = "tree.obj"
name = "numbers"
leaf_reflectance = 0.1
[[medium]]
density = 1.0
box = [0, 0, 0, 1, 1, 1]
species = "clover"
[[medium]]
density = 1.0
box = [0, 0, 0, 1, 1, 1]
[stand]
kind = "positions"
positions = [[0, 0], [3, 0], [6, 0], [9, 0], [12, 0], [15, 0]]
)"));
    EXPECT_TRUE(std::holds_alternative<LeafByNumbers>(scene.kinds[5].description));
    EXPECT_EQ(scene.kinds[0].description, scene.media[1].description);
    const std::string text = sceneText(scene, folder_.path());
    for (const char* line :
         {"leaf_slab = { absorption = [2, 0.3, 4], scattering = 10.1, thickness = 0.123456789012345 }",
          "leaf_species = \"beech\"\nleaf_gloss", "leaf_prospect = {}\n",
          "leaf_prospect = { chlorophyll = 31.41592653589793, dry_matter = 0 }", "leaf_reflectance = 0.1\n",
          "\nspecies = \"clover\"\n"})
      EXPECT_NE(text.find(line), std::string::npos) << line << " is not in\n" << text;
    const Scene again = readScene(write("again.toml", text));
    EXPECT_EQ(again.bands, scene.bands);
    EXPECT_EQ(again.bands.has_value(), !bands.empty());
    ASSERT_EQ(again.kinds.size(), 6u);
    for (std::size_t kind = 0; kind < 6; ++kind) {
      EXPECT_EQ(again.kinds[kind].description, scene.kinds[kind].description) << kind;
      EXPECT_EQ(again.kinds[kind].leaf, scene.kinds[kind].leaf) << kind;
    }
    ASSERT_EQ(again.media.size(), 2u);
    for (std::size_t medium = 0; medium < 2; ++medium) {
      EXPECT_EQ(again.media[medium].description, scene.media[medium].description);
      EXPECT_EQ(again.media[medium].optics, scene.media[medium].optics);
    }
  }
  // Of a medium alone.
  const Scene alone = readScene(write("s.toml",
                                      "[leaf]\nspecies = \"beech\"\nbands_nm = [650, 550, 450]\n[medium]\ndensity = "
                                      "1.0\nbottom = 0\ntop = 1\n[stand]\nkind = \"periodic\"\nperiod = [1, 1]\n"));
  const Scene again = readScene(write("again.toml", sceneText(alone, folder_.path())));
  EXPECT_EQ(again.bands, alone.bands);
  EXPECT_EQ(again.kinds[0].description, LeafDescription(leafOfSpecies("beech")));
  EXPECT_EQ(again.media[0].description, alone.media[0].description);
  EXPECT_EQ(again.media[0].optics, alone.media[0].optics);
}

// Check leaves that are slabs of tissue, and that three numbers are those of the three bands.
TEST_F(SceneLeaf, IsASlabOfTissue) {
  const Scene scene = readScene(write("s.toml", R"(
[tree]
file = "tree.obj"
leaf_slab = { absorption = [2.0, 0.5, 4.0], scattering = 10.0, thickness = 0.2 }
)"));
  const double absorption[] = {2., 0.5, 4.};
  for (std::size_t band = 0; band < kBands; ++band)
    EXPECT_EQ(scene.kinds[0].leaf[band],
              leafOptics(slabLeaf({.absorption = absorption[band], .scattering = 10., .thickness = 0.2}).sides));
}

// Check that each mistake is told with its file, key, value and rule.
TEST_F(SceneLeaf, RefusesWhatIsNoLeaf) {
  const auto refuses = [&](const std::string& keys, const std::string& expected) {
    const std::string message = refusal("[tree]\nfile = \"tree.obj\"\n[leaf]\n" + keys + "\n");
    EXPECT_NE(message.find(expected), std::string::npos) << message;
  };
  refuses("species = \"oak\"", "s.toml:3: leaf.species = \"oak\": must be one of: almond, beech");
  refuses("species = 3", "s.toml:4: leaf.species = 3: must be a text in quotes");
  refuses("prospect = { sugar = 1 }", "s.toml:4: unknown key \"sugar\" in [leaf.prospect]");
  refuses("prospect = { structure = 0.5 }", "s.toml:4: leaf.prospect.structure = 0.5: must be in [1, 10]");
  refuses("prospect = { water = nan }", "s.toml:4: leaf.prospect.water = nan: must be in [0, 10] cm");
  refuses("prospect = 40", "s.toml:4: leaf.prospect = 40: must be a table: [leaf.prospect]");
  refuses("prospect = { protein = 0.001, dry_matter = 0.01 }", "leaf.prospect.dry_matter = 0.01: must be 0 beside");
  refuses("bands_nm = [450, 550]", "s.toml:4: leaf.bands_nm = [ 450, 550 ]: must be three bands");
  refuses("bands_nm = [450, 550, 2501]", "s.toml:4: leaf.bands_nm = 2501: must be three bands");
  refuses("bands_nm = [[600, 500], 550, 450]", "s.toml:4: leaf.bands_nm = [ 600, 500 ]: must be three bands");
  refuses("bands_nm = [[600], 550, 450]", "s.toml:4: leaf.bands_nm = [ 600 ]: must be three bands");
  refuses("species = \"corn\"\nreflectance = 0.4", "[leaf] has both species and reflectance: must be one of them");
  refuses("prospect = { }\ntransmittance = 0.4", "[leaf] has both prospect and transmittance: must be one of them");
  refuses("slab = { absorption = 1.0, scattering = 10.0 }",
          "s.toml:3: leaf.slab has no thickness: must have absorption");
  refuses("slab = { absorption = -1.0, scattering = 10.0, thickness = 0.2 }", "leaf.slab.absorption = -1: must be in");
  refuses("slab = { absorption = 1.0, scattering = 10.0, thickness = 0.2, h = 1 }", "unknown key \"h\" in [leaf.slab]");
  refuses("slab = { absorption = 1.0, scattering = 10.0, thickness = 0.2 }\nspecies = \"corn\"",
          "[leaf] has both species and slab: must be one of them");
  EXPECT_NE(refusal("[tree]\nfile = \"tree.obj\"\nleaf_species = \"oak\"\n").find("tree.leaf_species = \"oak\""),
            std::string::npos);
}

// Check a sweep over species and wavelengths: every one at every one.
TEST_F(SceneLeaf, IsSwept) {
  const SweepFile sweep = readSweepFile(
      write("sweep.toml",
            "scenes = [\"cherry\"]\nleaf.species = [\"beech\", \"corn\"]\nleaf.wavelength_nm = [550, 850.5]\n"));
  ASSERT_EQ(sweep.optics.size(), 4u);
  const LeafSpectrum corn = prospect(measuredLeaf("corn").contents);
  EXPECT_EQ(sweep.optics[2].leaf, leafOptics(meanIn(corn, {550., 550.})));
  EXPECT_EQ(sweep.optics[3].leaf, leafOptics(meanIn(corn, {850.5, 850.5})));
  for (const char* leaf : {"leaf.species = \"beech\"", "leaf.species = \"oak\"\nleaf.wavelength_nm = 550",
                           "leaf.species = \"beech\"\nleaf.wavelength_nm = 300",
                           "leaf.species = \"beech\"\nleaf.wavelength_nm = 550\nleaf.albedo = 0.5"})
    EXPECT_THROW(readSweepFile(write("sweep.toml", std::string("scenes = [\"cherry\"]\n") + leaf + "\n")), InvalidInput)
        << leaf;
}

}  // namespace
}  // namespace sunfleck
