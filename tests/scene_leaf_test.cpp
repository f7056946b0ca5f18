// Leaves of scenes and sweeps that are told by what they are.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/require.hpp"
#include "leaves/light_bands.hpp"
#include "leaves/measured_leaves.hpp"
#include "leaves/prospect.hpp"
#include "leaves/slab_leaf.hpp"
#include "render/leaf_texture_file.hpp"
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

// Images that a scene's leaves have, in the test's folder.
void writeTextures(const fs::path& folder) {
  LeafTexture detail{.width = 4, .height = 2, .colour = std::vector<glm::vec3>(8, {0.5f, 0.25f, 1.f}), .alpha = {}};
  for (int i = 0; i < 8; ++i) detail.alpha.push_back(static_cast<float>(i) / 7.f);
  writeLeafTexture(folder / "upper.png", detail);
  detail.colour[0] = glm::vec3(2.f);
  writeLeafTexture(folder / "lower.exr", detail);
  detail.colour.assign(8, glm::vec3(0.125f));
  writeLeafTexture(folder / "gloss.exr", detail);
}

// Check that images and a lower side reach every kind as told, that the leaf is their mean, and that a scene written
// and read again has the same.
TEST_F(SceneLeaf, HasMapsAndALowerSide) {
  writeTextures(folder_.path());
  const Scene scene = readScene(write("s.toml", R"(
[leaf]
slab = { absorption = [2.0, 0.5, 4.0], scattering = 10.0, thickness = 0.2 }
maps = { upper = "upper.png", lower = "lower.exr", upper_gloss = "gloss.exr", albedo = [1.5, 1.0, 1.0], relief = 0.05 }
[[tree]]
file = "tree.obj"
name = "maps"
[[tree]]
file = "tree.obj"
name = "numbers"
leaf_lower = { reflectance = [0.1, 0.2, 0.3], gloss_roughness = 0.5 }
[[tree]]
file = "tree.obj"
name = "even"
leaf_maps = {}
[[tree]]
file = "tree.obj"
name = "two sides"
leaf_reflectance = 0.3
leaf_transmittance = 0.2
leaf_maps = {}
leaf_lower = { reflectance = 0.5 }
[stand]
kind = "positions"
positions = [[0, 0], [3, 0], [6, 0], [9, 0]]
)"));
  const TreeKind& maps = scene.kinds[0];
  ASSERT_TRUE(maps.maps);
  EXPECT_EQ(maps.maps->width, 4);
  const auto& texture = *maps.textures.upper.detail;
  EXPECT_NEAR(texture.colour[3].y, 0.25f, 1e-5f);  // 16 bits, as they stand
  EXPECT_NEAR(texture.alpha[3], 3.f / 7.f, 1e-5f);
  EXPECT_EQ(maps.textures.lower.detail->colour[0], glm::vec3(2.f));  // not multiplied by its alpha of 0
  EXPECT_EQ(maps.leaf, meanOptics(*maps.maps, leafAreaShares(*maps.mesh, 4, 2)));
  EXPECT_NE(maps.leaf, maps.told());
  EXPECT_EQ(maps.maps->places[0].faces[1].gloss, glm::vec3(0.125f));
  ASSERT_TRUE(scene.kinds[1].maps);
  EXPECT_FALSE(scene.kinds[1].textures.lower.any());
  EXPECT_NEAR(scene.kinds[1].maps->places[0].faces[1].reflectance.y, 0.2f, 1e-7f);
  EXPECT_FALSE(scene.kinds[2].maps);
  EXPECT_EQ(scene.kinds[2].leaf, maps.told());
  ASSERT_TRUE(scene.kinds[3].maps);
  EXPECT_EQ(scene.kinds[3].maps->places.size(), 1u);
  EXPECT_NEAR(scene.kinds[3].leaf[0].reflectance, 0.4f, 1e-6f);
  const Scene again = readScene(write("again.toml", sceneText(scene, folder_.path())));
  for (std::size_t kind = 0; kind < 4; ++kind) {
    EXPECT_EQ(again.kinds[kind].leaf, scene.kinds[kind].leaf) << kind;
    EXPECT_EQ(again.kinds[kind].told(), scene.kinds[kind].told()) << kind;
    EXPECT_EQ(again.kinds[kind].textures.underside, scene.kinds[kind].textures.underside) << kind;
    ASSERT_EQ(again.kinds[kind].maps == nullptr, scene.kinds[kind].maps == nullptr) << kind;
    if (scene.kinds[kind].maps) {
      EXPECT_EQ(*again.kinds[kind].maps, *scene.kinds[kind].maps) << kind;
    }
  }
  // Set anew with other tissue, images and shares stay.
  TreeKind edited = maps;
  std::get<LeafByTissue>(edited.description).thickness = 0.4;
  setLeaves(edited, scene.bands, edited.told());
  EXPECT_EQ(edited.shares, maps.shares);
  EXPECT_LT(edited.leaf[0].transmittance, maps.leaf[0].transmittance);
  Scene unsaved = scene;
  auto made = std::make_shared<LeafTexture>(texture);
  made->file.clear();
  unsaved.kinds[0].textures.upper.detail = made;
  EXPECT_THROW(sceneText(unsaved, folder_.path()), InvalidInput);
}

// Check that images that are none, or are made to do harm, are told in one line.
TEST_F(SceneLeaf, RefusesBadMaps) {
  writeTextures(folder_.path());
  const auto refuses = [&](const std::string& keys, const std::string& expected) {
    const std::string message = refusal("[tree]\nfile = \"tree.obj\"\n[leaf]\n" + keys + "\n");
    EXPECT_NE(message.find(expected), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  refuses("maps = 3", "leaf.maps = 3: must be a table");
  refuses("maps = { top = \"upper.png\" }", "unknown key \"top\" in [leaf.maps]");
  refuses("maps = { upper = \"\" }", "leaf.maps.upper = \"\": must be an image's file");
  refuses("maps = { upper = \".\" }", "cannot be read: it is no regular file");
  refuses("maps = { albedo = 2.0 }", "leaf.maps has albedo and no image: must be with an image it counts for");
  refuses("maps = { relief = 0.2 }", "leaf.maps has relief and no image: must be with an image it counts for");
  refuses("maps = { upper = \"none.png\" }", "none.png: cannot be read: there is no such file");
  refuses("maps = { upper = \"upper.png\", albedo = 101 }", "leaf.maps.albedo = 101: must be in [0, 100]");
  refuses("maps = { upper = \"upper.png\", relief = nan }", "leaf.maps.relief = nan: must be in [0, 1000] mm");
  refuses("lower = { reflectance = 1.5 }", "leaf.lower.reflectance = 1.5: must be in [0, 1]");
  refuses("lower = { gloss_roughness = 0.01 }", "leaf.lower.gloss_roughness = 0.01: must be in [0.05, 1]");
  refuses("lower = { reflectance = 0.5 }\nmaps = { lower = \"lower.exr\" }",
          "[leaf]: has both lower images and a lower side by numbers: must be one of them");
  writeLeafTexture(folder_ / "small.png", {.width = 2, .height = 2, .colour = std::vector<glm::vec3>(4), .alpha = {}});
  refuses("maps = { upper = \"upper.png\", lower = \"small.png\" }", "must be of one size");
  refuses("maps = { upper_gloss = \"lower.exr\" }", "lower.exr: a value = 2: must be in [0, 1]");
  std::ifstream whole(folder_ / "upper.png", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(whole)), {});
  write("cut.png", bytes.substr(0, bytes.size() / 2));
  refuses("maps = { upper = \"cut.png\" }", "cut.png: cannot be read");
  write("text.png", "no image at all");
  refuses("maps = { upper = \"text.png\" }", "text.png: cannot be read");
  LeafTexture bad{.width = 1, .height = 1, .colour = {{std::nanf(""), 0.f, 0.f}}, .alpha = {}};
  writeLeafTexture(folder_ / "bad.exr", bad);
  refuses("maps = { upper = \"bad.exr\" }", "it holds a value that is not a finite number");
  bad.colour[0].x = -0.5f;
  writeLeafTexture(folder_ / "bad.exr", bad);
  refuses("maps = { upper = \"bad.exr\" }", "bad.exr: a value = -0.5: must be in [0, 100]");
  writeLeafTexture(folder_ / "wide.png",
                   {.width = 4097, .height = 1, .colour = std::vector<glm::vec3>(4097), .alpha = {}});
  refuses("maps = { upper = \"wide.png\" }", "must be at most 4096 x 4096");
  refuses("maps = { upper = \"upper.png\" }\n[medium]\ndensity = 1.0\nbox = [0, 0, 0, 1, 1, 1]",
          "[medium] has the leaves of [leaf], which have maps or a lower side");
  refuses("[medium]\ndensity = 1.0\nbox = [0, 0, 0, 1, 1, 1]\nmaps = {}", "unknown key \"maps\" in [medium]");
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
