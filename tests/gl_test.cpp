#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/vec4.hpp>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/gl/buffer.hpp"
#include "render/gl/context.hpp"
#include "render/gl/program.hpp"
#include "render/gl/shader_text.hpp"
#include "render/gl/stand_picture.hpp"
#include "render/gl/stand_renderer.hpp"
#include "spp/slab.hpp"

namespace {

using namespace sunfleck;

constexpr float kPi = std::numbers::pi_v<float>;
// A radiance is a handful of float operations away from its closed form; where exponentials take part, llvmpipe's own
// add up to 2e-6.
constexpr float kRounding = 1e-6f, kShading = 4e-6f;

// A horizontal rectangle: a leaf or a piece of wood.
struct Rectangle {
  glm::vec2 low, high;
  float z;
  bool wood = false;
};

// A tree of rectangles under a sun overhead, with the opacity map that a careful reader would draw by hand.
struct Rectangles {
  TreeMesh mesh;
  std::vector<std::uint32_t> first{0};
  std::vector<Crossing> crossings;
  std::vector<float> wood_depth;
  gl::LightMap map;

  // `things` from top to bottom; the map covers -2 .. 2 along x and y.
  explicit Rectangles(const std::vector<Rectangle>& things, int resolution = 16) {
    for (const Rectangle& r : things) {
      const auto corner = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const glm::vec2 at : {r.low, {r.high.x, r.low.y}, r.high, {r.low.x, r.high.y}})
        mesh.vertices.push_back({at, r.z});
      for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)})
        (r.wood ? mesh.wood_triangles : mesh.leaf_triangles).push_back(t + corner);
    }
    finish(mesh, "test");
    map.axes = axesAlong({0.f, 0.f, -1.f});
    map.corner = glm::vec2(-2.f);
    map.size = glm::ivec2(resolution);
    map.pixel_size = 4.f / static_cast<float>(resolution);
    for (int y = 0; y < resolution; ++y)
      for (int x = 0; x < resolution; ++x) {
        const glm::vec2 in_map = map.corner + map.pixel_size * (glm::vec2(x, y) + 0.5f);
        const glm::vec2 at = in_map.x * glm::vec2(map.axes.right) + in_map.y * glm::vec2(map.axes.up);
        float wood = std::numeric_limits<float>::infinity();
        std::uint32_t leaf = 0;
        for (const Rectangle& r : things) {
          const bool hit = at.x > r.low.x && at.x < r.high.x && at.y > r.low.y && at.y < r.high.y;
          if (hit && r.wood) wood = std::min(wood, -r.z);
          if (hit && !r.wood) crossings.push_back({.depth = -r.z, .leaf = leaf});
          if (!r.wood) ++leaf;
        }
        first.push_back(static_cast<std::uint32_t>(crossings.size()));
        wood_depth.push_back(wood);
      }
    map.first = first;
    map.crossings = crossings;
    map.wood_depth = wood_depth;
  }
  Rectangles(const Rectangles&) = delete;
  Rectangles& operator=(const Rectangles&) = delete;

  Scene scene() const {
    Scene scene;
    scene.kinds[0].mesh = std::make_shared<TreeMesh>(mesh);
    scene.kinds[0].leaf = {LeafOptics{0.1f, 0.3f}, LeafOptics{0.5f, 0.4f}, LeafOptics{0.475f, 0.475f}};
    return scene;
  }
};

Camera cameraFrom(float elevation_degrees, float half_width = 0.5f, int size = 4) {
  return {.elevation = elevation_degrees * kPi / 180.f, .half_width = half_width, .width = size, .height = size};
}

// G of the cells of each tree.
struct Compensation {
  gl::DrawnCells cells;
  std::vector<std::span<const float>> values;
};

gl::DrawnStand standOf(const Scene& scene, const gl::LightMap& map, const Compensation& compensation = {}) {
  static std::uint64_t revision = 0;  // all is new each time
  gl::DrawnStand stand{.lights = {{.along = map.axes.along}},
                       .kinds = {{.tree = scene.kinds[0], .cells = compensation.cells, .maps = {map}}},
                       .trees = {},
                       .ground_albedo = scene.ground_albedo};
  stand.kinds[0].maps[0].revision = ++revision;
  for (std::size_t tree = 0; tree < scene.stand.trees.size(); ++tree) {
    gl::DrawnTree& drawn = stand.trees.emplace_back();
    drawn.position = scene.stand.trees[tree].position;
    if (!compensation.values.empty()) drawn.compensation[0] = {compensation.values[tree], ++revision};
  }
  return stand;
}

// All pictures of a test are drawn by one renderer, whose programs take long to make.
class R3_TreePicture : public testing::Test {
 protected:
  Image picture(const Scene& scene, const gl::LightMap& map, const Camera& camera, Model model,
                const Compensation& compensation = {}) {
    renderer_.update(standOf(scene, map, compensation));
    return gl::standPicture(context_, renderer_, camera, {.model = model});
  }

 private:
  gl::Context context_;
  gl::StandRenderer renderer_{context_};
};

constexpr Rectangle kWide{{-1.f, -1.f}, {1.f, 1.f}, 1.f};

void expectRadiance(const Image& image, int x, int y, glm::vec3 expected, float tolerance) {
  for (int band = 0; band < kBands; ++band)
    EXPECT_NEAR(image.values[image.at(x, y, static_cast<std::size_t>(band))], expected[band], tolerance)
        << "band " << band << " at " << x << ", " << y;
}

glm::vec3 perBand(const Scene& scene, const auto& of) {
  return {of(scene.kinds[0].leaf[0]), of(scene.kinds[0].leaf[1]), of(scene.kinds[0].leaf[2])};
}

// Powers of the slab less direct light.
spp::SlabPowers diffuse(float depth, float thickness, const LeafOptics& o) {
  spp::SlabPowers powers =
      spp::sppPowers(depth, thickness, 1.f, o.albedo(), spp::sphericalLeafForwardShare(o.reflectance, o.transmittance));
  powers.down -= spp::directPower(depth, 1.f);
  return powers;
}

// Check that a context comes up on a machine without a display, more than once and several at a time.
TEST(Context, NeedsNoDisplay) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  for (int i = 0; i < 2; ++i) {
    const gl::Context outer;
    { const gl::Context inner; }
    EXPECT_FALSE(gl::Context().renderer().empty());
  }
}

// Check that the driver's errors come out as exceptions, once.
TEST(Context, ReportsTheDriversErrors) {
  const gl::Context context;
  EXPECT_NO_THROW(context.requireNoError("doing nothing"));
  glEnable(0xdead);
  EXPECT_THROW(context.requireNoError("enabling nonsense"), std::runtime_error);
  EXPECT_NO_THROW(context.requireNoError("doing nothing"));
}

TEST(Program, NamesTheShaderThatDoesNotCompile) {
  const gl::Context context;
  try {
    const gl::Program broken{
        {.stage = gl::Stage::vertex, .name = "broken.vert", .text = "#version 450 core\nvoid main("}};
    FAIL() << "nonsense was compiled";
  } catch (const std::runtime_error& e) {
    EXPECT_EQ(std::string(e.what()).find("broken.vert: does not compile: "), 0u) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
  }
  EXPECT_THROW(gl::shaderText("render/gl/none.frag"), std::logic_error);
}

// (R3) Check that a leaf that faces the sun sends rho / pi back and tau / pi on, and covers the picture.
TEST_F(R3_TreePicture, OfALeafInFullLight) {
  const Rectangles leaf({kWide});
  const Scene scene = leaf.scene();
  for (const bool above : {true, false}) {
    const Image image = picture(scene, leaf.map, cameraFrom(above ? 90.f : -90.f), Model::ss);
    ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    const glm::vec3 expected =
        perBand(scene, [&](const LeafOptics& o) { return (above ? o.reflectance : o.transmittance) / kPi; });
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        expectRadiance(image, x, y, expected, kRounding);
        EXPECT_EQ(image.values[image.at(x, y, 3)], 1.f);
      }
  }
}

// (R3) Check that a leaf alone is a slab of thickness 1 to SPP: in direct light, and in the light it sends itself.
TEST_F(R3_TreePicture, OfALeafAloneBySpp) {
  const Rectangles leaf({kWide});
  const Scene scene = leaf.scene();
  const Image image = picture(scene, leaf.map, cameraFrom(90.f), Model::spp);
  const glm::vec3 expected = perBand(scene, [](const LeafOptics& o) {
    return spp::leafRadiance(1.f, 1.f, 1.f, diffuse(0.f, 1.f, o), o.reflectance, o.transmittance);
  });
  expectRadiance(image, 2, 2, expected, kShading);
}

// (R3) Check a leaf in the shadow of another, seen from below: black in direct light alone; lit by the slab's light;
// by G times that with a G of 1/4 in all cells; and all the same when a second tree of the stand casts the shadow.
TEST_F(R3_TreePicture, OfALeafInShadow) {
  const Rectangles two({{kWide.low, kWide.high, 1.f}, {kWide.low, kWide.high, 0.f}});
  const Rectangles one({{kWide.low, kWide.high, 0.f}});
  Scene trees = one.scene();
  trees.stand.trees.push_back({.position = {0.f, 0.f, 1.f}});
  trees.stand.trees.push_back({.position = {3.f, 0.f, 1.f}});  // its map reaches here, its leaf does not
  const std::vector<float> quarter(8, 0.25f);
  const Camera camera = cameraFrom(-90.f);
  for (const bool as_stand : {false, true}) {
    const Scene scene = as_stand ? trees : two.scene();
    const gl::LightMap& map = as_stand ? one.map : two.map;
    const Compensation cells{.cells = {.low = glm::vec3(-1.f), .cell_size = 1.f, .size = glm::ivec3(2)},
                             .values = {scene.stand.trees.size(), quarter}};
    expectRadiance(picture(scene, map, camera, Model::ss), 2, 2, glm::vec3(0.f), 0.f);
    for (const float compensation : {1.f, 0.25f}) {
      const Image image = picture(scene, map, camera, compensation == 1.f ? Model::spp : Model::sppg, cells);
      const glm::vec3 expected =
          compensation * perBand(scene, [](const LeafOptics& o) {
            return spp::leafRadiance(-1.f, 0.f, -1.f, diffuse(1.f, 2.f, o), o.reflectance, o.transmittance);
          });
      expectRadiance(image, 2, 2, expected, kShading);
      EXPECT_GT(image.values[image.at(2, 2, 1)], 0.005f);
    }
  }
}

// (R3) Check that it does not matter where a map puts its origin.
TEST_F(R3_TreePicture, FollowsTheMapsOrigin) {
  Rectangles half({{{-2.f, -2.f}, {0.f, 2.f}, 1.f}, {{-2.f, -2.f}, {2.f, 2.f}, 0.f}});
  const Camera camera = cameraFrom(-90.f, 0.5f * half.map.pixel_size, 8);
  const Image before = picture(half.scene(), half.map, camera, Model::spp);
  half.map.origin = {0.5f, -0.25f, 4.f};
  half.map.corner += glm::vec2(half.map.origin);
  for (Crossing& crossing : half.crossings) crossing.depth += half.map.origin.z;
  for (float& depth : half.wood_depth) depth += half.map.origin.z;
  const Image after = picture(half.scene(), half.map, camera, Model::spp);
  for (std::size_t i = 0; i < before.values.size(); ++i) EXPECT_NEAR(after.values[i], before.values[i], kShading);
}

// (R3) Check that each tree of a stand reads its own G: 0 in one, 1 in the other, which are far apart.
TEST_F(R3_TreePicture, ReadsTheCellsOfEachTree) {
  const Rectangles two({{kWide.low, kWide.high, 1.f}, {kWide.low, kWide.high, 0.f}});
  Scene scene = two.scene();
  scene.stand.trees.push_back({.position = {10.f, 0.f, 0.f}});
  const std::vector<float> none(8, 0.f), all(8, 1.f);
  const Compensation cells{.cells = {.low = glm::vec3(-1.f), .cell_size = 1.f, .size = glm::ivec3(2)},
                           .values = {none, all}};
  Camera camera = cameraFrom(-90.f);
  expectRadiance(picture(scene, two.map, camera, Model::sppg, cells), 2, 2, glm::vec3(0.f), 0.f);
  camera.target.x = 10.f;
  const Image lit = picture(scene, two.map, camera, Model::sppg, cells);
  const Image spp = picture(scene, two.map, camera, Model::spp, cells);
  EXPECT_NEAR(lit.values[lit.at(2, 2, 1)], spp.values[spp.at(2, 2, 1)], kShading);
}

// (R3) Check that the rim of a shadow is as the nearest four pixels of the map say: with a leaf over all x < 0, light
// grows linearly from 0 at half a map pixel before the rim to 1 half a pixel beyond it. Rows of 8 pixels span it, each
// the mean of two samples, which a linear function's mean over the pixel equals.
TEST_F(R3_TreePicture, SmoothsTheRimOfAShadow) {
  const Rectangles half({{{-2.f, -2.f}, {0.f, 2.f}, 1.f}, {{-2.f, -2.f}, {2.f, 2.f}, 0.f}});
  const Scene scene = half.scene();
  const float map_pixel = half.map.pixel_size;
  const Image image = picture(scene, half.map, cameraFrom(-90.f, 0.5f * map_pixel, 8), Model::ss);
  // Seen from below with the camera at azimuth 0, the picture's up is +x: rows run from x > 0 down.
  for (int row = 0; row < 8; ++row) {
    const float lit = 1.f - (static_cast<float>(row) + 0.5f) / 8.f;
    expectRadiance(image, 3, row, lit * perBand(scene, [](const LeafOptics& o) { return o.transmittance / kPi; }),
                   4e-6f);
  }
}

// (R3) Check that wood in full light sends back its reflectance / pi and nothing on, and that it shades what is below
// it.
TEST_F(R3_TreePicture, OfWood) {
  const Rectangles tree({{kWide.low, kWide.high, 1.f, true}, {kWide.low, kWide.high, 0.f}});
  Scene scene = tree.scene();
  scene.kinds[0].wood_reflectance = {0.2f, 0.3f, 0.4f};
  expectRadiance(picture(scene, tree.map, cameraFrom(90.f), Model::ss), 2, 2, scene.kinds[0].wood_reflectance / kPi,
                 kRounding);
  expectRadiance(picture(scene, tree.map, cameraFrom(-90.f), Model::ss), 2, 2, glm::vec3(0.f), 0.f);
}

// Pixel that a point falls in.
glm::ivec2 pixelOf(const Camera& camera, glm::vec3 point) {
  const Axes axes = viewAxes(camera);
  const float scale = 0.5f * static_cast<float>(camera.width) / camera.half_width;
  return {static_cast<int>(std::floor(0.5f * static_cast<float>(camera.width) +
                                      scale * glm::dot(point - camera.target, axes.right))),
          static_cast<int>(
              std::floor(0.5f * static_cast<float>(camera.height) - scale * glm::dot(point - camera.target, axes.up)))};
}

// (R3) Check the ground below a leaf on a thin post: lit by albedo / pi beside the shadow, black in it by direct light
// alone, lit by what the slab lets through by SPP, and black sky beyond its rim.
TEST_F(R3_TreePicture, OfTheGroundAndAShadowOnIt) {
  const Rectangles tree({{kWide.low, kWide.high, 1.f}, {{1.5f, 1.5f}, {1.51f, 1.51f}, 0.f, true}});
  Scene scene = tree.scene();
  scene.ground_albedo = {0.1f, 0.2f, 0.3f};
  const Camera camera = cameraFrom(30.f, 6.f, 120);
  const glm::ivec2 shadow = pixelOf(camera, {0.5f, 0.f, 0.f}), sun = pixelOf(camera, {1.7f, -1.3f, 0.f}),
                   beyond = pixelOf(camera, {0.f, 5.5f, 0.f});
  const Image ss = picture(scene, tree.map, camera, Model::ss);
  expectRadiance(ss, shadow.x, shadow.y, glm::vec3(0.f), 0.f);
  expectRadiance(ss, sun.x, sun.y, scene.ground_albedo / kPi, kRounding);
  EXPECT_EQ(ss.values[ss.at(shadow.x, shadow.y, 3)], 1.f);
  EXPECT_EQ(ss.values[ss.at(beyond.x, beyond.y, 3)], 0.f);

  // A plane gathers half the power of a half-sphere of uniform radiance.
  const glm::vec3 passed = perBand(scene, [](const LeafOptics& o) { return 0.5f * diffuse(1.f, 1.f, o).down; });
  const Image spp = picture(scene, tree.map, camera, Model::spp);
  expectRadiance(spp, shadow.x, shadow.y, scene.ground_albedo * passed / kPi, kShading);
  EXPECT_GT(passed.g, 0.05f);

  // G is 1/2 at the height of the leaf, which sends the light down, and 0 at the ground's.
  const std::vector<float> half_above{0.f, 0.f, 0.f, 0.f, 0.5f, 0.5f, 0.5f, 0.5f};
  const Compensation cells{.cells = {.low = glm::vec3(-1.f), .cell_size = 1.f, .size = glm::ivec3(2)},
                           .values = {half_above}};
  const Image sppg = picture(scene, tree.map, camera, Model::sppg, cells);
  expectRadiance(sppg, shadow.x, shadow.y, 0.5f * scene.ground_albedo * passed / kPi, kShading);

  scene.ground_albedo = glm::vec3(0.f);
  const Image none = picture(scene, tree.map, camera, Model::ss);
  EXPECT_EQ(none.values[none.at(sun.x, sun.y, 3)], 0.f);
}

// (R3) Check the whole way from a mesh and its opacity map: the shadow of a leaf 2 m up falls 2 m aside when the sun
// stands at 45 degrees, at whatever azimuth; there SPPG with G = 1/4 sends a quarter of the slab's light.
TEST_F(R3_TreePicture, ReadsADeepOpacityMapAlongALowSun) {
  for (const float azimuth : {0.f, 2.5f}) {
    const glm::vec2 aside(-2.f * std::cos(azimuth), -2.f * std::sin(azimuth));
    const glm::vec2 half(0.6f);
    const Rectangles tree({{-half, half, 2.f}, {aside - half, aside + half, 0.f}});
    Scene scene = tree.scene();
    scene.suns[0].zenith = 0.25f * kPi;
    scene.suns[0].azimuth = azimuth;
    Camera camera = cameraFrom(90.f, 0.1f, 2);
    const DeepOpacityMap of_tree(*scene.kinds[0].mesh, scene.sun().light(), 64);
    const gl::LightMap map = gl::lightMap(of_tree);
    const std::vector<float> quarter(27, 0.25f);
    const Compensation cells{.cells = {.low = glm::vec3(-3.f), .cell_size = 2.f, .size = glm::ivec3(3)},
                             .values = {quarter}};

    const float cosine = std::cos(scene.suns[0].zenith);
    expectRadiance(picture(scene, map, camera, Model::ss), 1, 1,
                   cosine * perBand(scene, [](const LeafOptics& o) { return o.reflectance / kPi; }), kRounding);
    camera.target = {aside, 0.f};
    expectRadiance(picture(scene, map, camera, Model::ss), 1, 1, glm::vec3(0.f), 0.f);
    const glm::vec3 expected = perBand(scene, [&](const LeafOptics& o) {
      return 0.25f * spp::leafRadiance(cosine, 0.f, cosine, diffuse(1.f, 2.f, o), o.reflectance, o.transmittance);
    });
    expectRadiance(picture(scene, map, camera, Model::sppg, cells), 1, 1, expected, kShading);
  }
}

// (R3) Check that the same picture twice is the same bits.
TEST_F(R3_TreePicture, IsDeterministic) {
  const Rectangles tree({kWide, {{-0.5f, -0.5f}, {1.5f, 1.f}, 0.5f}, {{-1.5f, -1.f}, {0.3f, 1.5f}, 0.f}});
  Scene scene = tree.scene();
  scene.ground_albedo = glm::vec3(0.2f);
  const Camera camera = cameraFrom(40.f, 2.f, 40);
  const Image one = picture(scene, tree.map, camera, Model::spp);
  const Image two = picture(scene, tree.map, camera, Model::spp);
  EXPECT_EQ(one.values, two.values);
}

// (R3) Check that a picture of several tiles has no seam: a leaf over its left half covers just that.
TEST_F(R3_TreePicture, HasNoSeams) {
  const Rectangles leaf({kWide});
  Camera camera = cameraFrom(90.f, 0.5f, 1100);
  camera.height = 2;
  camera.target = {0.f, 1.f, 0.f};  // the picture's right is +y
  const Image image = picture(leaf.scene(), leaf.map, camera, Model::ss);
  for (int x = 0; x < 1100; ++x) ASSERT_EQ(image.values[image.at(x, 1, 3)], x < 550 ? 1.f : 0.f) << x;
}

// (R3) Check that a camera that sees nothing is refused.
TEST_F(R3_TreePicture, RefusesACameraThatSeesNothing) {
  const Rectangles leaf({kWide});
  Camera camera = cameraFrom(90.f);
  camera.half_width = 0.f;
  EXPECT_THROW(picture(leaf.scene(), leaf.map, camera, Model::ss), InvalidInput);
  EXPECT_THROW(picture(leaf.scene(), leaf.map, cameraFrom(90.f, 1.f, 0), Model::ss), InvalidInput);
}

}  // namespace
