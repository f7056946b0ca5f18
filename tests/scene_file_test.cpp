#include "render/scene_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/require.hpp"
#include "render/stand_geometry.hpp"

namespace {

using namespace sunfleck;
namespace fs = std::filesystem;

// A folder of its own for each test, removed afterwards.
class SceneFile : public testing::Test {
 protected:
  SceneFile() { fs::create_directory(folder_); }
  ~SceneFile() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  // The message of the refusal, without the folder's name.
  std::string refusal(const std::string& toml) const {
    try {
      readScene(write("s.toml", toml));
    } catch (const InvalidInput& e) {
      std::string message = e.what();
      const std::size_t at = message.find(folder_.string());
      if (at != std::string::npos) message.erase(at, folder_.string().size() + 1);
      return message;
    }
    return "accepted";
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / ("sunfleck_scene_file_" + std::to_string(::getpid()));
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
  EXPECT_NEAR(scene.sun().y, -std::sqrt(0.75f), 1e-6f);  // from +y, 60 degrees from overhead
  EXPECT_NEAR(scene.sun().z, -0.5f, 1e-6f);
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->target, glm::vec3(1.f, 2.f, 3.f));
  EXPECT_NEAR(scene.camera->elevation, 0.5235988f, 1e-6f);
  EXPECT_EQ(scene.camera->half_width, 2.5f);
  EXPECT_EQ(scene.camera->height, 32);
}

// Check that what is wrong is named with its file, line, key, value and rule.
TEST_F(SceneFile, NamesWhatIsWrong) {
  write("tree.obj", kSquare);
  EXPECT_EQ(refusal("[sun]\nzenith_deg = 95\n"), "s.toml:2: sun.zenith_deg = 95: must be in [0, 89.9]");
  EXPECT_EQ(refusal("[sun]\nzenith_deg = nan\n"), "s.toml:2: sun.zenith_deg = nan: must be in [0, 89.9]");
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
// far apart have the G of a lone one, and two that touch have more of it; and that rotated trees are refused.
TEST_F(SceneFile, StandsOfSeveralTreesShareTheirLight) {
  Scene scene = readScene("slab");
  scene.stand = Stand{};
  StandGeometry stand({.light_resolution = 64, .sample_resolution = 64, .cells = 6});
  const auto updated = [&]() -> const std::vector<std::vector<float>>& {
    stand.update(scene, Model::sppg);
    return stand.compensation();
  };
  const auto mean = [](const std::vector<float>& g) {
    double sum = 0.;
    for (const float value : g) sum += double{value};
    return sum / static_cast<double>(g.size());
  };
  const double lone = mean(updated()[0]);
  scene.stand.trees = {{.position = glm::vec3(0.f)}, {.position = glm::vec3(1000.f, 0.f, 0.f)}};
  ASSERT_EQ(updated().size(), 2u);
  EXPECT_DOUBLE_EQ(mean(updated()[0]), lone);
  scene.stand.trees[1].position.x = 2.f;
  EXPECT_GT(mean(updated()[0]), lone);
  scene.stand.trees[1].rotation = 0.1f;
  EXPECT_THROW(updated(), InvalidInput);
}

}  // namespace
