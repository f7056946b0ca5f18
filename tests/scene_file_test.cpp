#include "render/scene_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/require.hpp"
#include "render/image_file.hpp"
#include "render/stand_geometry.hpp"
#include "tests/temporary_folder.hpp"

namespace {

using namespace sunfleck;
namespace fs = std::filesystem;

// A folder of its own for each test, removed afterwards.
class SceneFile : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text).string();
  }
  // The message of the refusal, without the folder's name.
  std::string refusal(const std::string& toml) const {
    try {
      readScene(write("s.toml", toml));
    } catch (const InvalidInput& e) {
      return folder_.without(e.what());
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

constexpr const char* kSquare = "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nusemtl leaf\nf 1 2 3 4\n";

// Check that every key arrives, in the units of the program.
TEST_F(SceneFile, BringsEveryKey) {
  write("tree.obj", kSquare);
  const Scene scene = readScene(write("s.toml", R"(
name = "A name"
[tree]
file = "tree.obj"
scale = 2.0
[stand]
kind = "periodic"
period = [7.0, 8.0]
positions = [[1, 2], [3, 4, 90]]
[leaf]
reflectance = [0.1, 0.2, 0.3]
transmittance = 0.4
[wood]
reflectance = 0.25
[ground]
albedo = [0.5, 0.6, 0.7]
[sun]
zenith_deg = 60
azimuth_deg = 90.0
[camera]
target = [1.0, 2.0, 3.0]
elevation_deg = 30
azimuth_deg = -45
half_width = 2.5
field_of_view_deg = 60
width = 64
height = 32
)"));
  EXPECT_EQ(scene.name, "A name");
  EXPECT_EQ(scene.kinds[0].mesh->leaf_count, 1u);
  EXPECT_DOUBLE_EQ(leafArea(*scene.kinds[0].mesh), 8.);
  ASSERT_TRUE(scene.stand.period);
  EXPECT_EQ(*scene.stand.period, glm::vec2(7.f, 8.f));
  ASSERT_EQ(scene.stand.trees.size(), 2u);
  EXPECT_EQ(scene.stand.trees[1].position, glm::vec3(3.f, 4.f, 0.f));
  EXPECT_NEAR(scene.stand.trees[1].rotation, 1.5707963f, 1e-6f);
  EXPECT_FLOAT_EQ(scene.kinds[0].leaf[2].reflectance, 0.3f);
  EXPECT_FLOAT_EQ(scene.kinds[0].leaf[2].transmittance, 0.4f);
  EXPECT_EQ(scene.kinds[0].wood_reflectance, glm::vec3(0.25f));
  EXPECT_EQ(scene.ground_albedo, glm::vec3(0.5f, 0.6f, 0.7f));
  EXPECT_NEAR(scene.sun().light().y, -std::sqrt(0.75f), 1e-6f);  // from +y, 60 degrees from overhead
  EXPECT_NEAR(scene.sun().light().z, -0.5f, 1e-6f);
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->target, glm::vec3(1.f, 2.f, 3.f));
  EXPECT_NEAR(scene.camera->elevation, 0.5235988f, 1e-6f);
  EXPECT_EQ(scene.camera->half_width, 2.5f);
  EXPECT_NEAR(scene.camera->field_of_view, 1.0471976f, 1e-6f);
  EXPECT_EQ(scene.camera->height, 32);
}

// Check several kinds of trees: each with its name, its source, its optics or those of the scene; named by positions or
// taken in turn.
TEST_F(SceneFile, HoldsSeveralKinds) {
  write("oak.obj", kSquare);
  const std::string kinds = R"(
[[tree]]
species = "cherry"
leaf_transmittance = 0.25
[[tree]]
file = "oak.obj"
leaf_reflectance = [0.1, 0.2, 0.3]
wood_reflectance = 0.125
[[tree]]
species = "cherry"
seed = 2
name = "second cherry"
[leaf]
reflectance = 0.5
transmittance = 0.375
)";
  const Scene scene = readScene(write("s.toml", kinds + R"(
[stand]
kind = "positions"
positions = [[0, 0], [9, 0, 90, "second cherry"], [18, 0, "cherry"], [27, 0], [36, 0, 45], [45, 0, "oak"]]
)"));
  ASSERT_EQ(scene.kinds.size(), 3u);
  EXPECT_EQ(scene.kinds[0].name, "cherry");
  EXPECT_EQ(scene.kinds[1].name, "oak");
  EXPECT_EQ(scene.kinds[1].mesh->leaf_count, 1u);
  EXPECT_EQ(scene.kinds[2].source, "species cherry, seed 2");
  EXPECT_EQ(scene.kinds[0].leaf[2].reflectance, 0.5f);
  EXPECT_EQ(scene.kinds[0].leaf[2].transmittance, 0.25f);
  EXPECT_EQ(scene.kinds[1].leaf[2].reflectance, 0.3f);
  EXPECT_EQ(scene.kinds[1].leaf[2].transmittance, 0.375f);
  EXPECT_EQ(scene.kinds[1].wood_reflectance, glm::vec3(0.125f));
  EXPECT_EQ(scene.kinds[2].wood_reflectance, glm::vec3(0.3f));
  std::vector<std::uint32_t> kind_of_tree;
  for (const Placement& tree : scene.stand.trees) kind_of_tree.push_back(tree.kind);
  EXPECT_EQ(kind_of_tree, (std::vector<std::uint32_t>{0, 2, 0, 0, 1, 1}));
  EXPECT_NEAR(scene.stand.trees[1].rotation, 1.5707963f, 1e-6f);
  EXPECT_EQ(bounds(scene).high.x, std::max(47.f, bounds(scene).high.x));

  const Scene grid = readScene(write("s.toml", kinds + "[stand]\nkind = \"grid\"\nside = 2\n"));
  kind_of_tree.clear();
  for (const Placement& tree : grid.stand.trees) kind_of_tree.push_back(tree.kind);
  EXPECT_EQ(kind_of_tree, (std::vector<std::uint32_t>{0, 1, 1, 2}));

  EXPECT_EQ(refusal(kinds),
            "s.toml: [stand] has no place for a tree of kind \"oak\": must have a tree of each of the 3 kinds, in "
            "positions or in a grid");
  EXPECT_EQ(refusal(kinds + "[stand]\nkind = \"positions\"\npositions = [[0, 0, \"elm\"]]\n"),
            "s.toml:18: stand.positions = 'elm': must be the name of a kind of tree: \"cherry\", \"oak\", \"second "
            "cherry\"");
  EXPECT_NE(refusal(kinds + "[stand]\nkind = \"positions\"\npositions = [[0, \"oak\"]]\n").find("a list of [x, y]"),
            std::string::npos);
  EXPECT_EQ(refusal("[[tree]]\n[[tree]]\nseed = 2\n"),
            "s.toml:2: tree.name = \"cherry\": must differ from that of the other kinds of trees");
  EXPECT_NE(refusal("tree = []\n").find("tree = []: must be a table [tree]"), std::string::npos);
  EXPECT_NE(refusal("[tree]\nleaf_reflectance = 0.7\n").find("at most 1"), std::string::npos);
}

// Check that what is wrong is named with its file, line, key, value and rule.
TEST_F(SceneFile, NamesWhatIsWrong) {
  write("tree.obj", kSquare);
  EXPECT_EQ(refusal("[sun]\nzenith_deg = 195\n"), "s.toml:2: sun.zenith_deg = 195: must be in [0, 180]");
  EXPECT_EQ(refusal("[sun]\nzenith_deg = nan\n"), "s.toml:2: sun.zenith_deg = nan: must be in [0, 180]");
  EXPECT_EQ(refusal("[[saved_camera]]\nwidth = 3\n"), "s.toml:1: saved_camera.name = \"\": must be 1 to 64 characters");
  EXPECT_EQ(refusal("[[saved_camera]]\nname = \"a\"\n[[saved_camera]]\nname = \"a\"\n"),
            "s.toml:3: saved_camera.name = \"a\": must differ from that of the other ones");
  EXPECT_EQ(refusal("[[saved_camera]]\nname = \"a\"\nwidth = 0\n"),
            "s.toml:3: saved_camera.width = 0: must be a whole number, 1 to 8192");
  EXPECT_EQ(refusal("saved_camera = 3\n"), "s.toml:1: saved_camera: must be a [[saved_camera]] for each");
  EXPECT_EQ(refusal("[camera]\nfield_of_view_deg = 0.05\n"),
            "s.toml:2: camera.field_of_view_deg = 0.05: must be 0 or in [0.1, 150]");
  EXPECT_EQ(refusal("[sun]\nzenit = 1\n"), "s.toml:2: unknown key \"zenit\" in [sun]; see: sunfleck --help scene");
  EXPECT_EQ(refusal("\n[moon]\n"), "s.toml:2: unknown key \"moon\"; see: sunfleck --help scene");
  EXPECT_EQ(refusal("sun = 3\n"), "s.toml:1: sun = 3: must be a table: [sun]");
  EXPECT_NE(refusal("[leaf]\nreflectance = [0.1, 0.2]\n").find("s.toml:2: leaf.reflectance"), std::string::npos);
  EXPECT_NE(refusal("[leaf]\nreflectance = 0.7\n").find("at most 1"), std::string::npos);
  EXPECT_NE(refusal("[stand]\nkind = \"heap\"\n").find("stand.kind = \"heap\""), std::string::npos);
  EXPECT_NE(refusal("[stand]\nkind = \"periodic\"\nperiod = [0, 1]\n").find("s.toml:3: stand.period"),
            std::string::npos);
  EXPECT_NE(refusal("[tree]\nfile = \"none.obj\"\n").find("none.obj"), std::string::npos);
  EXPECT_NE(refusal("[tree]\nfile = \"tree.obj\"\nspecies = \"cherry\"\n").find("both"), std::string::npos);
  EXPECT_NE(refusal("[sun\n").find("s.toml:1"), std::string::npos);
}

// Check the built-in names, and that an unknown one is refused with the list of them.
TEST_F(SceneFile, KnowsBuiltinScenes) {
  EXPECT_EQ(readScene("cherry16").stand.trees.size(), 16u);
  EXPECT_TRUE(readScene("periodic").stand.period);
  EXPECT_TRUE(readScene("slab").stand.period);
  for (const char* unknown : {"cherry2", "baobab", "16", ""}) EXPECT_THROW(readScene(unknown), InvalidInput) << unknown;
}

// Check the geometry of a stand of several trees: a tree beside another loses G on the far side only, so that two trees
// far apart have the G of a lone one, and two that touch have more of it.
TEST_F(SceneFile, StandsOfSeveralTreesShareTheirLight) {
  Scene scene = readScene("slab");
  scene.stand = Stand{};
  StandGeometry stand({.light_resolution = 64, .sample_resolution = 64, .cells = 6});
  const auto mean = [&](std::size_t tree) {
    stand.update(scene);
    double sum = 0.;
    for (const float value : stand.compensation(tree, 0)) sum += double{value};
    return sum / static_cast<double>(stand.compensation(tree, 0).size());
  };
  const double lone = mean(0);
  scene.stand.trees = {{.position = glm::vec3(0.f)}, {.position = glm::vec3(1000.f, 0.f, 0.f)}};
  EXPECT_DOUBLE_EQ(mean(0), lone);
  scene.stand.trees[1].position.x = 2.f;
  EXPECT_GT(mean(0), lone);
}

// Check that trees of a periodic stand that are written a whole number of periods apart come together, so that the
// camera that shows them all shows one period; and that trees within one period stay where they are.
TEST_F(SceneFile, PlacesPeriodicTreesInOnePeriod) {
  write("tree.obj", kSquare);
  const auto positions = [&](const std::string& list) {
    std::vector<float> all;
    for (const Placement& tree : readScene(write("s.toml",
                                                 "[tree]\nfile = \"tree.obj\"\n[stand]\nkind = \"periodic\"\n"
                                                 "period = [8, 4]\npositions = [" +
                                                     list + "]\n"))
                                     .stand.trees)
      all.insert(all.end(), {tree.position.x, tree.position.y});
    return all;
  };
  EXPECT_EQ(positions("[-1, 2], [803, -18], [7, 2]"), (std::vector<float>{-1, -18, 3, -18, -1, -18}));
  EXPECT_EQ(positions("[-1, 2], [6.5, -1.5]"), (std::vector<float>{-1, 2, 6.5, -1.5}));
}

}  // namespace

// Check that every key of the sun and of each kind of sky arrives, and the light that follows from it: irradiances as
// asked for, or Preetham's own with its sun's colour at the same luminance.
TEST_F(SceneFile, BringsSunAndSky) {
  const auto lightOf = [&](const std::string& toml) { return sunAndSky(readScene(write("s.toml", toml))); };
  const Scene scene = readScene(write("s.toml", "[sun]\nirradiance = [1, 0.9, 0.5]\ndiameter_deg = 0.533\n"));
  EXPECT_EQ(scene.sun().irradiance, glm::vec3(1.f, 0.9f, 0.5f));
  EXPECT_NEAR(scene.sun().diameter, 0.0093026, 1e-6);
  EXPECT_EQ(sunAndSky(scene).sky, nullptr);
  EXPECT_NEAR(lightOf("[sky]\nkind = \"uniform\"\n").sky->irradiance().y, 0.2, 1e-7);
  const glm::dvec3 coloured = lightOf("[sky]\nkind = \"overcast\"\nirradiance = [0.1, 0.2, 0.3]\n").sky->irradiance();
  EXPECT_NEAR(coloured.x, 0.1, 1e-6);
  EXPECT_NEAR(coloured.z, 0.3, 1e-6);

  const std::string clear = "[sun]\nzenith_deg = 60\nazimuth_deg = 90\n[sky]\nkind = \"preetham\"\nturbidity = 2.5\n";
  const SunAndSky own = lightOf(clear);
  EXPECT_GT(own.sky->irradiance().z, own.sky->irradiance().x);                                       // blue
  EXPECT_GT(own.sky->radiance({0.f, 0.8f, 0.6f}).x, 2.f * own.sky->radiance({0.f, -0.8f, 0.6f}).x);  // towards the sun
  EXPECT_EQ(own.suns.front(), glm::vec3(1.f));
  const SunAndSky warm = lightOf(clear + "coloured_sun = true\nirradiance = 0.25\n");
  const glm::vec3 sun = warm.suns.front();
  EXPECT_NEAR(0.2126f * sun.x + 0.7152f * sun.y + 0.0722f * sun.z, 1.f, 1e-6f);
  EXPECT_GT(sun.x, 1.2f * sun.z);
  const glm::dvec3 sky = warm.sky->irradiance();
  EXPECT_NEAR((sky.x + sky.y + sky.z) / 3., 0.25, 1e-6);
  EXPECT_NEAR(sky.z / sky.x, own.sky->irradiance().z / own.sky->irradiance().x, 1e-5);
  EXPECT_NEAR(lightOf(clear + "irradiance = [0.1, 0.1, 0.1]\n").sky->irradiance().z, 0.1, 1e-6);

  Image panorama{.width = 4, .height = 2, .channels = {"R", "G", "B"}, .values = std::vector<float>(24, 1.f)};
  for (std::size_t pixel = 0; pixel < 4; ++pixel) panorama.values[3 * pixel] = static_cast<float>(pixel);
  panorama.values[1] = -1.f;
  write("sky.exr", "");
  const std::string file = write("s.toml", "[sky]\nkind = \"image\"\nfile = \"sky.exr\"\nrotation_deg = 90\n");
  writeImage(std::filesystem::path(file).parent_path() / "sky.exr", panorama, 1.f);
  const Scene photographed = readScene(file);
  EXPECT_EQ(photographed.sky.negative_values, 1u);
  const std::shared_ptr<const SkyMap> seen = sunAndSky(photographed).sky;
  EXPECT_NEAR((seen->irradiance().x + seen->irradiance().y + seen->irradiance().z) / 3., 0.2, 1e-6);
  // The third pixel is right of the middle, which looks along +y: from there 45 degrees towards +x.
  EXPECT_NEAR(seen->radiance({0.6f, 0.6f, 0.5f}).x, 2.f * seen->radiance({0.6f, 0.6f, 0.5f}).z, 1e-6f);
}

// Check several suns, each with its own keys; that one below the horizon gives no light, nor lights a clear sky; and
// that more than four are refused.
TEST_F(SceneFile, BringsSeveralSuns) {
  const Scene scene = readScene(write("s.toml", R"([[sun]]
zenith_deg = 95
irradiance = 2
[[sun]]
zenith_deg = 60
azimuth_deg = 90
irradiance = [0.1, 0.2, 0.3]
[sky]
kind = "preetham"
)"));
  ASSERT_EQ(scene.suns.size(), 2u);
  EXPECT_EQ(scene.suns[0].irradiance, glm::vec3(2.f));
  EXPECT_NEAR(scene.suns[1].light().z, -0.5f, 1e-6f);
  const SunAndSky light = sunAndSky(scene);
  EXPECT_EQ(light.suns, (std::vector<glm::vec3>{glm::vec3(0.f), {0.1f, 0.2f, 0.3f}}));
  EXPECT_EQ(light.sky, nullptr);
  EXPECT_EQ(refusal("[[sun]]\n[[sun]]\n[[sun]]\n[[sun]]\n[[sun]]\n"),
            "s.toml:1: number of [[sun]] = 5: must be from 1 to 4");
  EXPECT_EQ(refusal("[[sun]]\n[[sun]]\nzenith_deg = 195\n"), "s.toml:3: sun.zenith_deg = 195: must be in [0, 180]");
}

TEST_F(SceneFile, RefusesWhatNoSunOrSkyIs) {
  EXPECT_EQ(refusal("[sky]\nkind = \"clear\"\n"),
            "s.toml: sky.kind = \"clear\": must be none, uniform, overcast, preetham or image");
  EXPECT_EQ(refusal("[sky]\nkind = \"uniform\"\nturbidity = 3\n"),
            "s.toml:3: unknown key \"turbidity\" in [sky]; see: sunfleck --help scene");
  EXPECT_EQ(refusal("[sky]\nirradiance = 0.3\n"),
            "s.toml:2: unknown key \"irradiance\" in [sky]; see: sunfleck --help scene");
  EXPECT_EQ(refusal("[sky]\nkind = \"preetham\"\nturbidity = 1.5\n"),
            "s.toml:3: sky.turbidity = 1.5: must be in [1.7, 10]");
  EXPECT_EQ(refusal("[sky]\nkind = \"preetham\"\ncoloured_sun = 1\n"),
            "s.toml:3: sky.coloured_sun = 1: must be true or false");
  EXPECT_NE(
      refusal("[sky]\nkind = \"preetham\"\nturbidity = 8\n[sun]\nzenith_deg = 89.9\n").find("told by [sky] irradiance"),
      std::string::npos);
  EXPECT_EQ(refusal("[sky]\nkind = \"preetham\"\nturbidity = 8\nirradiance = 0.3\n[sun]\nzenith_deg = 89.9\n"),
            "accepted");
  EXPECT_EQ(refusal("[sky]\nkind = \"image\"\n"), "s.toml: [sky] of kind \"image\" has no key file");
  EXPECT_NE(refusal("[sky]\nkind = \"image\"\nfile = \"no.exr\"\n").find("no.exr: must be a file that can be read"),
            std::string::npos);
  write("bad.exr", "this is no picture");
  EXPECT_NE(refusal("[sky]\nkind = \"image\"\nfile = \"bad.exr\"\n").find("bad.exr: cannot be read"),
            std::string::npos);
  write("sky.png", "");
  EXPECT_NE(refusal("[sky]\nkind = \"image\"\nfile = \"sky.png\"\n").find("must be .exr or .hdr"), std::string::npos);
  EXPECT_EQ(refusal("[sun]\ndiameter_deg = 0.1\n"), "s.toml:2: sun.diameter_deg = 0.1: must be 0 or in [0.25, 60]");
  EXPECT_EQ(refusal("[sun]\nirradiance = 11\n"),
            "s.toml:2: sun.irradiance = 11: must be in [0, 10]: one number, or three for red, green and blue");
}

// Check that the models, which know the sun as a point alone, refuse other light.
TEST_F(SceneFile, LightThatTheModelsDoNotKnowIsRefused) {
  write("tree.obj", kSquare);
  const std::string tree = "[tree]\nfile = \"tree.obj\"\n";
  EXPECT_NO_THROW(requireModelled(readScene(write("s.toml", tree))));
  for (const char* light : {"[sky]\nkind = \"uniform\"\n", "[sun]\ndiameter_deg = 0.5\n", "[sun]\nirradiance = 0.5\n"})
    EXPECT_THROW(requireModelled(readScene(write("s.toml", tree + light))), InvalidInput) << light;
}

// Check media, alone and among trees, and what is refused of them.
TEST_F(SceneFile, Media) {
  write("tree.obj", kSquare);
  const Scene alone = readScene(write("s.toml", R"(
[[medium]]
density = 2.0
bottom = 1.0
top = 3.0
angles = "erectophile"
[[medium]]
kind = "particles"
extinction = 0.5
box = [-1, -2, 0, 1, 2, 4]
albedo = [0.1, 0.2, 0.3]
asymmetry = -0.5
[leaf]
reflectance = 0.4
transmittance = 0.3
[stand]
kind = "periodic"
)"));
  ASSERT_EQ(alone.media.size(), 2u);
  EXPECT_EQ(alone.kinds[0].mesh->leaf_count, 0u);
  EXPECT_EQ(alone.stand.period, glm::vec2(2.f, 4.f));  // of the box
  const SceneMedium &leaves = alone.media[0], &fog = alone.media[1];
  EXPECT_FALSE(leaves.particles);
  EXPECT_EQ(leaves.density, 2.f);
  EXPECT_EQ(leaves.angles, "erectophile");
  EXPECT_EQ(leaves.box.low.z, 1.f);
  EXPECT_EQ(leaves.box.high.z, 3.f);
  EXPECT_EQ(leaves.optics[2], (LeafOptics{.reflectance = 0.4f, .transmittance = 0.3f}));
  EXPECT_TRUE(fog.particles);
  EXPECT_EQ(fog.density, 0.5f);
  EXPECT_EQ(fog.asymmetry, -0.5f);
  EXPECT_EQ(fog.optics[1].reflectance, 0.2f);
  EXPECT_EQ(fog.box.high, glm::vec3(1.f, 2.f, 4.f));
  EXPECT_EQ(bounds(alone).size(), glm::vec3(2.f, 4.f, 4.f));

  const Scene among = readScene(write("t.toml", "[tree]\nfile = \"tree.obj\"\n[medium]\ndensity = 1\n"));
  EXPECT_EQ(among.kinds[0].mesh->leaf_count, 1u);
  EXPECT_EQ(among.media.size(), 1u);

  EXPECT_EQ(refusal("[medium]\n"), "s.toml: [medium] has neither file nor density: must have one of them");
  EXPECT_EQ(refusal("[medium]\nkind = \"fog\"\n"), "s.toml: medium.kind = \"fog\": must be leaves or particles");
  EXPECT_EQ(refusal("[medium]\ndensity = -1\n"), "s.toml:2: medium.density = -1: must be in [0, 1e6] 1/m");
  EXPECT_EQ(refusal("[medium]\ndensity = 1\nalbedo = 1\n"),
            "s.toml:3: unknown key \"albedo\" in [medium]; see: sunfleck --help scene");
  EXPECT_EQ(refusal("[medium]\ndensity = 1\ntop = -1\n"), "s.toml: medium.top = -1: must be above the bottom");
  EXPECT_EQ(refusal("[medium]\ndensity = 1\nbox = [0, 0, 0, 1, 0, 1]\n"),
            "s.toml: medium.box: must have its low corner first and be wider than 0");
  EXPECT_EQ(refusal("[medium]\ndensity = 1\nfile = \"x.vdb\"\n"),
            "s.toml: [medium] has both file and density: must be one of them");
  EXPECT_EQ(refusal("[medium]\ndensity = 1\n[stand]\nkind = \"grid\"\n"),
            "s.toml: stand.kind = \"grid\": must be single or periodic in a scene without trees");
  EXPECT_EQ(refusal("medium = []\n"), "s.toml: medium = []: must be a table [medium], or a [[medium]] for each");
}
