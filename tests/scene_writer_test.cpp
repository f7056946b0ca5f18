#include "render/scene_writer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/image_file.hpp"
#include "render/scene_file.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

class SceneWriter : public testing::Test {
 protected:
  SceneWriter() {
    fs::create_directories(folder_ / "elsewhere");
    write("square.obj", "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nusemtl leaf\nf 1 2 3 4\nusemtl bark\nf 1 2 3\n");
  }

  fs::path write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  Scene read(const std::string& toml) const { return readScene(write("given.toml", toml).string()); }
  // Written to another folder than that of what it names, and read from there.
  Scene roundTrip(const Scene& scene) const {
    const fs::path file = folder_ / "elsewhere" / "written.toml";
    writeScene(file, scene);
    return readScene(file.string());
  }

  TemporaryFolder folder_;
};

void expectSameMesh(const TreeMesh& a, const TreeMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.leaf_triangles, b.leaf_triangles);
  EXPECT_EQ(a.wood_triangles, b.wood_triangles);
}

// All that a scene file tells, to the bit; paths may be written in another way.
void expectSame(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.kinds.size(), b.kinds.size());
  for (std::size_t i = 0; i < a.kinds.size(); ++i) {
    const TreeKind &x = a.kinds[i], &y = b.kinds[i];
    EXPECT_EQ(x.name, y.name);
    expectSameMesh(*x.mesh, *y.mesh);
    EXPECT_EQ(x.leaf, y.leaf);
    EXPECT_EQ(x.wood_reflectance, y.wood_reflectance);
    EXPECT_EQ(x.recipe.species, y.recipe.species);
    EXPECT_EQ(x.recipe.seed, y.recipe.seed);
    EXPECT_EQ(x.recipe.rules.leaf, y.recipe.rules.leaf);
    EXPECT_EQ(x.recipe.rules.wood, y.recipe.rules.wood);
    EXPECT_EQ(x.recipe.rules.scale, y.recipe.rules.scale);
    EXPECT_EQ(x.recipe.rules.up, y.recipe.rules.up);
    EXPECT_EQ(x.recipe.rules.cards, y.recipe.rules.cards);
    EXPECT_EQ(x.recipe.file.empty(), y.recipe.file.empty());
    if (!x.recipe.file.empty()) {
      EXPECT_TRUE(fs::equivalent(x.recipe.file, y.recipe.file));
    }
  }
  EXPECT_EQ(a.stand, b.stand);
  ASSERT_EQ(a.media.size(), b.media.size());
  for (std::size_t i = 0; i < a.media.size(); ++i) {
    const SceneMedium &x = a.media[i], &y = b.media[i];
    EXPECT_EQ(x.particles, y.particles);
    EXPECT_EQ(x.optics, y.optics);
    EXPECT_EQ(x.asymmetry, y.asymmetry);
    EXPECT_EQ(x.angles, y.angles);
    EXPECT_EQ(x.box.low, y.box.low);
    EXPECT_EQ(x.box.high, y.box.high);
    EXPECT_EQ(x.density, y.density);
    ASSERT_EQ(x.grid == nullptr, y.grid == nullptr);
    if (x.grid) {
      EXPECT_EQ(x.grid->occupiedCells(), y.grid->occupiedCells());
    }
  }
  EXPECT_EQ(a.ground_albedo, b.ground_albedo);
  EXPECT_EQ(a.ground_rpv, b.ground_rpv);
  ASSERT_EQ(a.ground_texture[0] == nullptr, b.ground_texture[0] == nullptr);
  for (std::size_t band = 0; band < kBands && a.ground_texture[0]; ++band) {
    EXPECT_EQ(a.ground_texture[band]->albedo, b.ground_texture[band]->albedo);
    EXPECT_EQ(a.ground_texture[band]->size, b.ground_texture[band]->size);
  }
  EXPECT_EQ(a.suns, b.suns);
  SceneSky sky = b.sky;
  sky.file = a.sky.file;
  ASSERT_EQ(a.sky.image == nullptr, b.sky.image == nullptr);
  if (a.sky.image) {
    EXPECT_EQ(a.sky.image->hash(), b.sky.image->hash());
  }
  sky.image = a.sky.image;
  EXPECT_EQ(a.sky, sky);
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.saved_cameras, b.saved_cameras);
}

// A number in a range with random digits, at times one of its ends.
float drawn(Random& random, float low, float high) {
  const float place = random.uniform();
  return place < 0.05f ? low : place > 0.95f ? high : std::min(high, low + random.uniform() * (high - low));
}
glm::vec3 drawnBands(Random& random, float low, float high) {
  if (random.uniform() < 0.3f) return glm::vec3(drawn(random, low, high));
  return {drawn(random, low, high), drawn(random, low, high), drawn(random, low, high)};
}
int drawnCount(Random& random, int most) {
  return 1 + std::min(most - 1, static_cast<int>(random.uniform() * static_cast<float>(most)));
}

constexpr float kPi = std::numbers::pi_v<float>;

Camera drawnCamera(Random& random) {
  return {.target = {drawn(random, -1e6f, 1e6f), drawn(random, -5.f, 5.f), drawn(random, -1e-3f, 1e-3f)},
          .elevation = drawn(random, -kPi / 2.f, kPi / 2.f),
          .azimuth = drawn(random, -2.f * kPi, 2.f * kPi),
          .half_width = drawn(random, 1e-6f, 1e6f),
          .field_of_view = random.uniform() < 0.5f ? 0.f : drawn(random, 0.002f, 2.6f),
          .width = drawnCount(random, 8192),
          .height = drawnCount(random, 8192)};
}

// Any scene that a file can tell, of the square of leaf and wood.
Scene drawnScene(std::uint64_t seed, const fs::path& folder) {
  Random random(seed, 0);
  Scene scene = readScene((folder / "square.obj").string());
  scene.name = seed % 2 ? "a \"name\" \\ with\n\ttabs \x01 and \xc3\xa4" : "plain";
  scene.kinds.resize(static_cast<std::size_t>(drawnCount(random, 3)), scene.kinds[0]);
  for (std::size_t i = 0; i < scene.kinds.size(); ++i) {
    TreeKind& kind = scene.kinds[i];
    ImportRules rules;
    if (random.uniform() < 0.5f) rules.leaf = {"leaf", "lea*"};
    if (random.uniform() < 0.5f) rules.wood = {"bark"};
    rules.scale = drawn(random, 1e-3f, 100.f);
    rules.up = random.uniform() < 0.5f ? ImportRules::Up::y : ImportRules::Up::x;
    if (random.uniform() < 0.3f) rules.cards = ImportRules::Cards::mask;
    const Scene one = readScene((folder / "square.obj").string(), rules);
    kind.mesh = one.kinds[0].mesh;
    kind.recipe = one.kinds[0].recipe;
    kind.name = "kind " + std::to_string(i);
    const float roughness = drawn(random, 0.05f, 1.f);
    for (LeafOptics& leaf : kind.leaf)
      leaf = {.reflectance = drawn(random, 0.f, 0.5f),
              .transmittance = drawn(random, 0.f, 0.5f),
              .gloss = drawn(random, 0.f, 1.f),
              .gloss_roughness = roughness};
    kind.wood_reflectance = drawnBands(random, 0.f, 1.f);
  }
  scene.stand.trees.clear();
  for (std::uint32_t i = 0; i < scene.kinds.size() + 3; ++i)
    scene.stand.trees.push_back({.position = {drawn(random, -50.f, 50.f), drawn(random, -50.f, 50.f), 0.f},
                                 .rotation = drawn(random, -2.f * kPi, 2.f * kPi),
                                 .kind = i % static_cast<std::uint32_t>(scene.kinds.size())});
  if (random.uniform() < 0.4f) scene.stand.period = glm::vec2(drawn(random, 100.f, 1e6f), drawn(random, 100.f, 300.f));
  intoOnePeriod(scene.stand);
  const float ground = random.uniform();
  if (ground < 0.3f) {
    scene.ground_rpv.emplace();
    for (RpvGround& band : *scene.ground_rpv)
      band = {drawn(random, 0.f, 0.2f), drawn(random, 0.8f, 1.f), drawn(random, -0.2f, 0.2f), drawn(random, 0.5f, 1.f)};
  } else {
    scene.ground_albedo = drawnBands(random, 0.f, 1.f);
  }
  scene.suns.resize(static_cast<std::size_t>(drawnCount(random, kMostSuns)));
  for (Sun& sun : scene.suns)
    sun = {.zenith = drawn(random, 0.f, kPi),
           .azimuth = drawn(random, -2.f * kPi, 2.f * kPi),
           .irradiance = drawnBands(random, 0.f, 10.f),
           .diameter = random.uniform() < 0.5f ? 0.f : drawn(random, 0.005f, 1.f)};
  using Kind = SceneSky::Kind;
  constexpr std::array kKinds{Kind::none, Kind::uniform, Kind::overcast, Kind::preetham};
  scene.sky.kind = kKinds[static_cast<std::size_t>(drawnCount(random, 4) - 1)];
  if (scene.sky.kind != Kind::none && (scene.sky.kind != Kind::preetham || random.uniform() < 0.5f)) {
    scene.sky.own_colours = random.uniform() < 0.5f;
    scene.sky.irradiance =
        scene.sky.own_colours ? glm::dvec3(drawn(random, 0.f, 1000.f)) : glm::dvec3(drawnBands(random, 0.f, 1000.f));
  }
  if (scene.sky.kind == Kind::preetham) {
    scene.suns[0].zenith = drawn(random, 0.f, 1.f);  // next to nothing of a low sun comes through such air
    scene.sky.turbidity = 1.7 + 4. * double{random.uniform()};
    scene.sky.coloured_sun = random.uniform() < 0.5f;
  }
  if (random.uniform() < 0.8f) scene.camera = drawnCamera(random);
  for (int i = drawnCount(random, 4); --i > 0;)
    scene.saved_cameras.push_back({"camera \"" + std::to_string(i) + "\"", drawnCamera(random)});
  if (random.uniform() < 0.1f) scene.stand = {.trees = {}};
  return scene;
}

}  // namespace

// Check that 50 random scenes of all that a file can tell are read back the same, to the bit of each number.
TEST_F(SceneWriter, WhatItWritesIsReadBackTheSame) {
  for (std::uint64_t seed = 1; seed <= 50 && !HasFailure(); ++seed) {
    const Scene scene = drawnScene(seed, folder_.path());
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + sceneText(scene, folder_.path()));
    expectSame(scene, roundTrip(scene));
  }
}

// Check what comes from species and from files: trees, a sky, a ground and cells, from a folder beside.
TEST_F(SceneWriter, PathsCountFromTheFilesFolder) {
  Image panorama{.width = 8, .height = 4, .channels = {"R", "G", "B"}, .values = std::vector<float>(96, 0.25f)};
  for (std::size_t i = 0; i < panorama.values.size(); i += 5) panorama.values[i] = 0.5f;
  writeImage(folder_ / "sky.exr", panorama, 1.f);
  writeImage(folder_ / "ground.exr", panorama, 1.f);
  const Scene scene = read(R"(
[[tree]]
species = "cherry"
seed = 3
[[tree]]
file = "square.obj"
scale = 2.5
[stand]
kind = "positions"
positions = [[0, 0], [5.1, 0.3, 33.3]]
[ground]
kind = "texture"
texture = "ground.exr"
texture_size = 3.7
[sky]
kind = "image"
file = "sky.exr"
rotation_deg = 12.3
)");
  const Scene back = roundTrip(scene);
  expectSame(scene, back);
  EXPECT_EQ(back.kinds[0].source, "species cherry, seed 3");
  const std::string text = sceneText(scene, folder_ / "elsewhere");
  EXPECT_NE(text.find("file = \"../square.obj\""), std::string::npos) << text;
  EXPECT_NE(text.find("[5.1, 0.3, 33.3, \"square\"]"), std::string::npos) << text;  // as short as it was given
  EXPECT_NE(text.find("file = \"../sky.exr\"\nrotation_deg = 12.3"), std::string::npos) << text;
}

// Check media, alone and among trees, in boxes, layers and cells.
TEST_F(SceneWriter, WritesMedia) {
  const Scene alone = read(R"(
[[medium]]
density = 0.7
bottom = -1.1
top = 2.2
reflectance = [0.1, 0.2, 0.3]
angles = "planophile"
[[medium]]
kind = "particles"
extinction = 0.3
bottom = 0
top = 9
albedo = 0.9
asymmetry = 0.77
[leaf]
transmittance = 0.123
[stand]
kind = "periodic"
period = [3.3, 4.4]
)");
  expectSame(alone, roundTrip(alone));
  const Scene among = read(
      "[tree]\nfile = \"square.obj\"\n[medium]\ndensity = 0.1\nbox = [-1, -2, 0, 1.1, 2.2, 3.3]\ntransmittance = "
      "0.3\n");
  expectSame(among, roundTrip(among));
}

// Check built-in scenes, and what a file cannot tell.
TEST_F(SceneWriter, RefusesWhatAFileCannotTell) {
  for (const char* name : {"cherry", "periodic", "cherry16"}) expectSame(readScene(name), roundTrip(readScene(name)));
  const auto refusal = [&](const Scene& scene) {
    try {
      sceneText(scene, folder_.path());
    } catch (const InvalidInput& e) {
      return std::string(e.what());
    }
    return std::string("written");
  };
  EXPECT_EQ(refusal(readScene("slab")),
            "scene \"slab\": its trees \"slab\" came from no species and no file: cannot be written as a scene file");
  Scene scene = readScene((folder_ / "square.obj").string());
  scene.stand.trees[0].position.z = 1.f;
  EXPECT_NE(refusal(scene).find("above or below the ground"), std::string::npos);
  scene.kinds[0].mesh = std::make_shared<const TreeMesh>();
  EXPECT_NE(refusal(scene).find("has neither trees nor media"), std::string::npos);
  scene = readScene((folder_ / "square.obj").string());
  scene.suns[0].azimuth = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(refusal(scene).find("must be finite"), std::string::npos);
  EXPECT_THROW(writeScene(folder_ / "scene.txt", readScene("cherry")), InvalidInput);
  EXPECT_THROW(writeScene(folder_ / "none" / "scene.toml", readScene("cherry")), InvalidInput);
  EXPECT_FALSE(fs::exists(folder_ / "scene.txt"));
}
