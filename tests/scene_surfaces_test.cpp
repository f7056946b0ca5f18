// Check that a scene file brings gloss, grounds and masks, from files that it names; that it refuses what is wrong with
// them in one line; and that the models refuse such scenes.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/require.hpp"
#include "render/image_file.hpp"
#include "render/scene_file.hpp"
#include "render/stand_geometry.hpp"
#include "tests/temporary_folder.hpp"

namespace {

using namespace sunfleck;
namespace fs = std::filesystem;

class SceneSurfaces : public testing::Test {
 protected:
  SceneSurfaces() {
    write("tree.obj",
          "mtllib tree.mtl\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
          "usemtl leaf\nf 1/1 2/2 3/3 4/4\n");
  }

  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text).string();
  }
  Scene read(const std::string& toml) const {
    return readScene(write("s.toml", "[tree]\nfile = \"tree.obj\"\n" + toml));
  }
  // The one line of the refusal, by the models if reading does not refuse, without the folder's name.
  std::string refusal(const std::string& toml) const {
    try {
      requireModelled(read(toml));
    } catch (const InvalidInput& e) {
      std::string message = e.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return folder_.without(message);
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

}  // namespace

TEST_F(SceneSurfaces, BringsGloss) {
  const Scene scene = read("leaf_gloss_roughness = 0.5\n[leaf]\ngloss = [0.1, 0.2, 0.3]\ngloss_roughness = 0.2\n");
  EXPECT_FLOAT_EQ(scene.kinds[0].leaf[1].gloss, 0.2f);
  EXPECT_FLOAT_EQ(scene.kinds[0].leaf[1].gloss_roughness, 0.5f);
  EXPECT_EQ(refusal("[leaf]\ngloss = 1.5\n"),
            "s.toml:4: leaf.gloss = 1.5: must be in [0, 1]: one number, or three for red, green and blue");
  EXPECT_EQ(refusal("[leaf]\ngloss_roughness = 0.01\n"), "s.toml:4: leaf.gloss_roughness = 0.01: must be in [0.05, 1]");
  EXPECT_NE(refusal("[leaf]\ngloss = 0.1\n").find("must be 0 for the models"), std::string::npos);
}

TEST_F(SceneSurfaces, BringsRpvGround) {
  const Scene scene = read("[ground]\nkind = \"rpv\"\nrpv = [[0.1, 0.8, -0.1, 0.2], [0.2, 1, 0, 1], [0.3, 1, 0, 1]]\n");
  EXPECT_EQ((*scene.ground_rpv)[0], (RpvGround{0.1f, 0.8f, -0.1f, 0.2f}));
  EXPECT_EQ((*scene.ground_rpv)[2], (RpvGround{0.3f, 1.f, 0.f, 1.f}));
  EXPECT_EQ((*read("[ground]\nkind = \"rpv\"\nrpv = [0.1, 1, 0, 1]\n").ground_rpv)[2], (RpvGround{}));
  for (const char* wrong : {"rpv = [0.1, 1, 0]", "rpv = [[0.1, 1, 0, 1]]", "rpv = 0.1", "rpv = [0.1, 1, 0, 3]",
                            "rpv = []", "rpv = [[0.1, 1, 0, 1], 1, 2]"})
    EXPECT_NE(refusal(std::string("[ground]\nkind = \"rpv\"\n") + wrong + "\n").find("must be [rho0, k, theta, rho_c]"),
              std::string::npos)
        << wrong;
  EXPECT_NE(refusal("[ground]\nkind = \"rpv\"\nrpv = [0.9, 0.4, -0.5, 0.1]\n").find("must be at most 1: rho0 must be"),
            std::string::npos);
  EXPECT_EQ(refusal("[ground]\nkind = \"rpv\"\n"), "s.toml: [ground] of kind \"rpv\" has no key rpv");
  EXPECT_NE(refusal("[ground]\nkind = \"rpv\"\nrpv = [0.1, 1, 0, 1]\nalbedo = 0.1\n").find("unknown key \"albedo\""),
            std::string::npos);
  EXPECT_EQ(refusal("[ground]\nkind = \"sand\"\n"), "s.toml: ground.kind = \"sand\": must be lambert, rpv or texture");
  EXPECT_NE(refusal("[ground]\nkind = \"rpv\"\nrpv = [0.1, 1, 0, 1]\n").find("must be \"lambert\" for the models"),
            std::string::npos);
}

// Check textures from files: sRGB in a PNG, to half a step of its 8 bits, and as they stand in an EXR.
TEST_F(SceneSurfaces, BringsATexture) {
  const Image image{
      .width = 2, .height = 1, .channels = {"R", "G", "B"}, .values = {0.25f, 0.5f, 0.75f, 1.f, 0.f, 0.125f}};
  for (const char* file : {"ground.png", "ground.exr"}) {
    writeImage(folder_ / file, image, 1.f);
    const Scene scene =
        read(std::string("[ground]\nkind = \"texture\"\ntexture = \"") + file + "\"\ntexture_size = 3.0\n");
    for (std::size_t band = 0; band < 3; ++band)
      for (std::size_t x = 0; x < 2; ++x)
        EXPECT_NEAR(scene.ground_texture[band]->albedo[x], image.values[3 * x + band], 0.005) << file;
    EXPECT_EQ(scene.ground_texture[0]->size, 3.f);
  }
  EXPECT_NE(refusal("[ground]\nkind = \"texture\"\ntexture = \"ground.png\"\n").find("for the models"),
            std::string::npos);
  EXPECT_EQ(refusal("[ground]\nkind = \"texture\"\ntexture = \"none.png\"\n"),
            "s.toml: none.png: cannot be read: there is no such file");
  write("broken.png", "this is no picture");
  EXPECT_NE(refusal("[ground]\nkind = \"texture\"\ntexture = \"broken.png\"\n").find("broken.png: cannot be read: "),
            std::string::npos);
  writeImage(folder_ / "bright.exr", {.width = 1, .height = 1, .channels = {"Y"}, .values = {1.5f}}, 1.f);
  EXPECT_NE(refusal("[ground]\nkind = \"texture\"\ntexture = \"bright.exr\"\n").find("must be in [0, 1]"),
            std::string::npos);
}

// Check how a scene's file is read: its unit, its upward axis, and what is no name of either.
TEST_F(SceneSurfaces, ReadsUnitsAndAxes) {
  fs::remove(folder_ / "tree.mtl");
  const auto corner = [&](const std::string& keys) { return read(keys).kinds[0].mesh->vertices[2]; };
  EXPECT_EQ(corner(""), glm::vec3(2.f, 1.f, 1.f));
  EXPECT_EQ(corner("unit = \"ft\"\n"), 0.3048f * glm::vec3(2.f, 1.f, 1.f));
  EXPECT_EQ(corner("up = \"y\"\n"), glm::vec3(2.f, -1.f, 1.f));
  EXPECT_EQ(corner("up = \"x\"\nscale = 2.0\n"), glm::vec3(2.f, 2.f, 4.f));
  EXPECT_EQ(refusal("unit = \"furlong\"\n"),
            "s.toml:1: tree.unit = \"furlong\": must be one of m, dm, cm, mm, km, in, ft");
  EXPECT_EQ(refusal("up = \"w\"\n"), "s.toml:1: tree.up = \"w\": must be one of x, y, z");
  EXPECT_EQ(refusal("cards = \"trumps\"\n"), "s.toml:1: tree.cards = \"trumps\": must be one of cut, mask, whole");
  EXPECT_EQ(refusal("unit = \"cm\"\nscale = 2.0\n"), "s.toml:1: [tree] has both scale and unit: must be one of them");
  EXPECT_EQ(refusal("mesh = \"oak\"\n"), "s.toml:1: tree.obj: mesh \"oak\": must be of a glTF file");
}

// Check a mask from a PNG whose left half is leaf, where the code value is at least half of the largest whatever light
// that stands for.
TEST_F(SceneSurfaces, CutsLeavesByAMask) {
  write("tree.mtl", "newmtl leaf\nmap_d mask.png\n");
  EXPECT_NE(refusal("").find("mask.png: cannot be read"), std::string::npos);
  writeImage(folder_ / "mask.png", {.width = 2, .height = 1, .channels = {"Y"}, .values = {0.3f, 0.1f}}, 1.f);
  EXPECT_NEAR(leafArea(*read("").kinds[0].mesh), 1., 1e-6);
  EXPECT_EQ(refusal(""), "accepted");
  EXPECT_NEAR(leafArea(*read("cards = \"whole\"\n").kinds[0].mesh), 2., 1e-12);
  EXPECT_NEAR(leafArea(*read("cards = \"mask\"\n").kinds[0].mesh), 1., 1e-12);
  const std::string refused = refusal("cards = \"mask\"\n");
  EXPECT_NE(refused.find("has leaves that masks cut out (cards = \"mask\"): must be cut to triangles for the models"),
            std::string::npos)
      << refused;
}
