// Check frames of stands: several kinds of trees and lights, perspective, culling, levels of detail, tiles, layers.
#include "render/gl/stand_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "render/gl/too_large.hpp"
#include "render/gl/volume_texture.hpp"
#include "render/shading/fragment_shading.hpp"
#include "sky/sky_models.hpp"
#include "tests/drawn_woods.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::woods;

constexpr float kPi = std::numbers::pi_v<float>;

// (R24) Check that the parts of the light add up to the picture, by models that tell less and more, with two suns, a
// sky and two kinds of trees, whose ids all appear; the sum of four parts is off by their roundings.
TEST(R24_StandRenderer, PartsOfTheLightAddUp) {
  Woods woods;
  Drawing drawing(woods.stand());
  for (const Model model : {Model::ss, Model::sppg, Model::sppr}) {
    const Image image = drawing.picture(woods.camera(), {.model = model, .samples = 2, .layers = kAll});
    std::set<float> trees, kinds;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        trees.insert(value(image, x, y, "id.tree"));
        kinds.insert(value(image, x, y, "id.kind"));
        for (const std::string band : {"R", "G", "B"}) {
          float sum = 0.f;
          for (const std::string part : {"direct.", "multiple.", "sky."}) sum += value(image, x, y, part + band);
          if (tellsSingle(model)) sum += value(image, x, y, "single." + band);
          ASSERT_NEAR(value(image, x, y, band), sum, 1e-6f);
        }
      }
    EXPECT_EQ(trees.size(), 6u);  // five trees and none
    EXPECT_EQ(std::ranges::count(image.channels, "single.R"), tellsSingle(model) ? 1 : 0);
    EXPECT_EQ(kinds, (std::set<float>{-1.f, 0.f, 1.f}));
  }
}

// Check every model's picture pixel by pixel against C++, which shades the same fragments as the layers tell them: of
// two kinds of trees, one under a gloss, whose lobe of roughness 0.3 magnifies roundings of directions tenfold.
TEST(R27_StandRenderer, ShadesAsCppDoes) {
  Woods woods;
  woods.scene.suns.resize(1);
  for (LeafOptics& leaf : woods.scene.kinds[1].leaf) leaf.gloss = 0.4f;
  Drawing drawing(woods.stand());
  const Camera camera = woods.camera();
  const glm::vec3 to_eye = -viewAxes(camera).along;
  for (const Model model : kModels) {
    const Image image = drawing.picture(camera, {.model = model, .samples = 1, .layers = kAll});
    shading::ShadingData data;
    const std::array suns{shading::ShadingLight{.travel = glm::vec4(woods.scene.sun().light(), 0.f),
                                                .irradiance = glm::vec4(woods.scene.sun().irradiance, 0.f)}};
    update(data, model, woods.scene.kinds, suns, exactPowerTable);
    const shading::FragmentShading shading(model, data);
    int leaves = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const auto at = [&](const char* name) { return value(image, x, y, name); };
        if (at("id.leaf") < 0.f) continue;
        ++leaves;
        const glm::vec3 normal(at("normal.X"), at("normal.Y"), at("normal.Z"));
        const shading::Surface surface =
            shading.leafSurface(static_cast<std::uint32_t>(at("id.kind")), {}, 0, 0, normal, to_eye);
        const float before = at("foliage.before"), beyond = at("foliage.beyond");
        const shading::Shaded shaded = shading.shadeByLight(surface,
                                                            {.foliage = {before, beyond, at("foliage.visible")},
                                                             .thickness = before + beyond + 1.f,
                                                             .compensation = at("foliage.G")},
                                                            0);
        const std::array bands{"R", "G", "B"};
        for (int band = 0; band < 3; ++band) {
          const std::string name = bands[static_cast<std::size_t>(band)];
          ASSERT_NEAR(at(("direct." + name).c_str()), shaded.direct[band],
                      kShading * (1.f + 10.f * shaded.direct[band]));
          ASSERT_NEAR(at(("multiple." + name).c_str()), shaded.scattered[band] - shaded.single[band],
                      kShading * (1.f + shaded.scattered[band]));
          if (tellsSingle(model)) {
            ASSERT_NEAR(at(("single." + name).c_str()), shaded.single[band], kShading * (1.f + shaded.single[band]));
          }
        }
      }
    EXPECT_GT(leaves, 1000);
  }
}

// (R24) Check what a pixel tells of itself against the mesh: its line of sight meets the triangle's plane at the depth
// told, within the triangle, whose normal is the one told; in parallel and in perspective.
TEST(R24_StandRenderer, KnowsWhereEachPixelLies) {
  Woods woods;
  Drawing drawing(woods.stand());
  for (const Camera& camera : {woods.camera(48), inPerspective(woods.camera(48))}) {
    const Image image = drawing.picture(camera, {.samples = 1, .layers = {gl::Layer::geometry, gl::Layer::ids}});
    int leaves = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const float tree = value(image, x, y, "id.tree");
        if (tree < 0.f) continue;
        ++leaves;
        const Placement& placement = woods.scene.stand.trees[static_cast<std::size_t>(tree)];
        const TreeMesh& mesh = *woods.scene.kindOf(placement).mesh;
        const auto number = static_cast<std::size_t>(value(image, x, y, "id.triangle"));
        EXPECT_EQ(value(image, x, y, "id.leaf"), static_cast<float>(mesh.leaf_of_triangle[number]));
        const glm::uvec3 t = mesh.leaf_triangles[number];
        const glm::vec3 a = mesh.vertices[t.x] + placement.position, b = mesh.vertices[t.y] + placement.position,
                        c = mesh.vertices[t.z] + placement.position;
        const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
        const glm::vec3 told(value(image, x, y, "normal.X"), value(image, x, y, "normal.Y"),
                             value(image, x, y, "normal.Z"));
        EXPECT_NEAR(std::abs(glm::dot(normal, told)), 1.f, 1e-5f);
        const Sight look = sightThrough(camera, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
        EXPECT_LT(glm::dot(told, look.along), 0.f);
        const float slant = glm::dot(normal, look.along);
        if (std::abs(slant) < 0.05f) continue;  // its place is not sharp
        const float away = glm::dot(normal, a - look.from) / slant;
        // Roundings of some 10 m, by the slant.
        EXPECT_NEAR(value(image, x, y, "depth.Z"), away * glm::dot(look.along, viewAxes(camera).along), 2e-4f);
        // Within the triangle, to a 256th of a pixel, in which cards count, and some more in perspective.
        const glm::vec3 at = look.from + away * look.along;
        const float pixel = 2.f * camera.half_width / static_cast<float>(camera.width);
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
          const glm::vec3 inward = glm::normalize(glm::cross(normal, to - from));
          EXPECT_GT(glm::dot(at - from, inward), -0.02f * pixel / std::abs(slant));
        }
      }
    EXPECT_GT(leaves, 100);
  }
}

// (R24) Check that trees and clusters beside the view are left out, and that nothing in it changes by that: a part of a
// picture drawn alone shows the triangles that the whole shows there.
TEST(R24_StandRenderer, LeavesOutWhatIsNotSeen) {
  Woods woods;
  Drawing drawing(woods.stand());
  for (const Camera& camera : {woods.camera(96), inPerspective(woods.camera(96))}) {
    gl::FrameTarget whole({96, 96}, true), part({24, 24}, true);
    gl::View view{.camera = camera};
    const gl::FrameCost all = drawing.renderer.draw(view, whole);
    const std::vector<std::uint32_t> ids = whole.readIds();
    view.low = {40, 32};
    const gl::FrameCost few = drawing.renderer.draw(view, part);
    const std::vector<std::uint32_t> of_part = part.readIds();
    EXPECT_LT(few.triangles, all.triangles / 2);
    EXPECT_GT(few.triangles, 0u);
    int differ = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x)
        for (std::size_t i = 0; i < 4; ++i)
          differ += of_part[4 * static_cast<std::size_t>(y * 24 + x) + i] !=
                    ids[4 * static_cast<std::size_t>((y + 32) * 96 + x + 40) + i];
    EXPECT_LE(differ, 8);  // two pixels on edges of leaves, where the last bit of a part's coordinates can decide
  }
}

// (R3) Check that light on the ground does not depend on what else a picture holds: beneath a tree that stands beside
// the picture it is the same with the trees that the picture needs as with all.
TEST(R3_StandRenderer, LightsTheGroundByTreesBesideThePicture) {
  Woods woods;
  woods.scene.suns.resize(1);
  woods.scene.suns[0].zenith = 1.f;
  const glm::vec3 light = woods.scene.sun().light(),
                  middle = bounds(*woods.scene.kinds[0].mesh).centre() + woods.scene.stand.trees[4].position;
  const float ground = bounds(woods.scene).low.z;
  const Camera camera{.target = middle + (middle.z - ground) / -light.z * light,
                      .elevation = 0.5f * kPi,
                      .half_width = 0.4f,
                      .width = 24,
                      .height = 24};
  const std::vector<std::size_t> trees = treesInPicture(woods.scene, camera);
  EXPECT_LT(trees.size(), woods.scene.stand.trees.size());
  woods.geometry.update(woods.scene, {}, trees);
  const gl::PictureEffort effort{.samples = 1, .layers = {gl::Layer::multiple, gl::Layer::foliage}};
  Drawing drawing(gl::drawnStand(woods.scene, woods.geometry));
  const Image few = drawing.picture(camera, effort);
  drawing.renderer.update(woods.stand());
  const Image all = drawing.picture(camera, effort);
  float least = 1.f;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      ASSERT_NEAR(value(few, x, y, "multiple.G"), value(all, x, y, "multiple.G"), kShading);
      least = std::min(least, value(all, x, y, "foliage.G"));
    }
  EXPECT_LT(least, 0.95f);
}

// (R24) Check that no pixel but those of the empty sky is left out of shading: a black sky, under which all are shaded,
// changes nothing where there is no ground; from afar, from within the stand, in parts, and of samples in sum.
TEST(R24_StandRenderer, LeavesOutNothingButTheSky) {
  Woods woods;
  woods.scene.ground_albedo = glm::vec3(0.f);
  woods.scene.sky = {};
  Drawing without(woods.stand());
  woods.scene.sky.kind = SceneSky::Kind::uniform;
  woods.scene.sky.irradiance = glm::dvec3(0.);
  Drawing with(woods.stand());
  Camera aside = woods.camera(64), within = inPerspective(woods.camera(64));
  aside.half_width *= 3.f;
  within.half_width *= 0.1f;
  for (const Camera& camera : {woods.camera(64), inPerspective(woods.camera(64)), aside, within}) {
    const gl::PictureEffort effort{.samples = 2, .layers = kAll};
    const Image some = without.picture(camera, effort), all = with.picture(camera, effort);
    ASSERT_EQ(some.values.size(), all.values.size());
    for (std::size_t i = 0; i < all.values.size(); ++i)
      // (infinite depths are equal)
      ASSERT_TRUE(some.values[i] == all.values[i] ||
                  std::abs(some.values[i] - all.values[i]) <= kShading * (1.f + std::abs(all.values[i])))
          << i;
  }
}

// (R25) Check that with fewer and larger leaves the mean radiance and coverage stay within a few parts in a hundred,
// which is what a random part of some hundred leaves spreads, that the leaves shown are the tree's, and the work is
// less.
TEST(R25_StandRenderer, KeepsTheMeanWithFewerLeaves) {
  Woods woods;
  Drawing drawing(woods.stand());
  const auto mean = [](const Image& image, const std::string& name) {
    double sum = 0.;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += static_cast<double>(value(image, x, y, name));
    return sum / (image.width * image.height);
  };
  woods.scene.ground_albedo = glm::vec3(0.f);
  drawing.renderer.update(woods.stand());
  const Camera camera = woods.camera(64);
  const Image full = drawing.picture(camera, {.samples = 16}),
              few = drawing.picture(camera, {.samples = 16, .piece_pixels = 4.f});
  EXPECT_NEAR(mean(few, "A") / mean(full, "A"), 1., 0.06);
  EXPECT_NEAR(mean(few, "G") / mean(full, "G"), 1., 0.06);
  gl::FrameTarget target({64, 64});
  gl::View view{.camera = camera};
  const std::size_t triangles = drawing.renderer.draw(view, target).triangles;
  view.piece_pixels = 4.f;
  EXPECT_LT(drawing.renderer.draw(view, target).triangles, triangles / 2);
}

// (R24) Check that a picture of several tiles is that of one, but for edges of leaves, where the last bit of a tile's
// coordinates can decide: at most one pixel in a thousand.
TEST(R24_StandRenderer, TilesArePartsOfThePicture) {
  Woods woods(2);
  woods.scene.sky = {};
  Drawing drawing(woods.stand());
  Camera camera = woods.camera(1200);
  camera.height = 40;
  const Image tiled = drawing.picture(camera, {.samples = 1});
  gl::FrameTarget whole({1200, 40});
  drawing.renderer.draw({.camera = camera}, whole);
  const std::vector<float> values = whole.read(gl::Layer::total);
  int differ = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 1200; ++x)
      differ += std::abs(values[4 * static_cast<std::size_t>((39 - y) * 1200 + x) + 1] -
                         tiled.values[tiled.at(x, y, 1)]) > kShading;
  EXPECT_LE(differ, 48);
}

// (R24) Check that pictures are the same bits twice, and after an update with nothing new, which sends no maps, meshes
// or cells; and that a tree that moves sends its cells and no map.
TEST(R24_StandRenderer, SendsWhatHasChanged) {
  Woods woods;
  Drawing drawing(woods.stand());
  const Image before = drawing.picture(woods.camera(), {.samples = 2});
  gl::Sent sent = drawing.renderer.update(woods.stand());
  EXPECT_EQ(sent.maps + sent.meshes + sent.cells + sent.sky, 0u);
  EXPECT_EQ(drawing.picture(woods.camera(), {.samples = 2}).values, before.values);

  const Camera camera = woods.camera();
  woods.scene.stand.trees[4].position.x += 0.7f;
  sent = drawing.renderer.update(woods.stand());
  EXPECT_EQ(sent.maps + sent.meshes, 0u);
  EXPECT_GT(sent.cells, 0u);
  const Image moved = drawing.picture(camera, {.samples = 2});
  EXPECT_NE(moved.values, before.values);
  Drawing anew(woods.stand());
  EXPECT_EQ(anew.picture(camera, {.samples = 2}).values, moved.values);

  woods.scene.suns[0].azimuth += 0.5f;
  sent = drawing.renderer.update(woods.stand());
  EXPECT_EQ(sent.meshes, 0u);
  EXPECT_GT(sent.maps, 0u);
}

// (R24) Check that a renderer tells products of one StandGeometry from those of another that has done the same work, by
// day and by night: what it draws is what a new one draws, to the bit.
TEST(R24_StandRenderer, TellsOneGeometryFromAnother) {
  Woods woods;
  for (const float zenith : {0.5f, 2.f}) {
    for (Sun& sun : woods.scene.suns) sun.zenith = zenith;
    woods.geometry = StandGeometry({.light_resolution = 64, .sample_resolution = 64, .cells = 8});
    Drawing drawing(woods.stand());
    const Image before = drawing.picture(woods.camera(48), {.samples = 1});
    woods.geometry = StandGeometry({.light_resolution = 64, .sample_resolution = 8, .cells = 8});
    drawing.renderer.update(woods.stand());
    const Image after = drawing.picture(woods.camera(48), {.samples = 1});
    EXPECT_TRUE(after.values != before.values);
    EXPECT_TRUE(after.values == Drawing(woods.stand()).picture(woods.camera(48), {.samples = 1}).values);
  }
}

// (R24) Check that a stand that is too large is refused as often as it is sent, and that nothing of it stays: maps of
// more crossings than any memory holds, which are not there to be read, and cells wider than half of a texture.
TEST(R24_StandRenderer, RefusesWhatIsTooLargeEachTime) {
  Woods woods;
  const gl::DrawnStand fits = woods.stand();
  Drawing drawing(fits);
  const Image before = drawing.picture(woods.camera(48), {.samples = 1});
  gl::DrawnStand large_map = fits, large_cells = fits;
  gl::LightMap& map = large_map.kinds[1].maps[0];
  map.crossings = std::span(map.crossings.data(), std::size_t{1} << 40);
  for (gl::DrawnKind& kind : large_cells.kinds) kind.cells.size = glm::ivec3(gl::VolumeTexture::longestSide() / 2 + 1);
  for (const gl::DrawnStand* large : {&large_map, &large_cells}) {
    for (int time = 0; time < 2; ++time) EXPECT_THROW(drawing.renderer.update(*large), gl::TooLarge);
    drawing.renderer.update(fits);
    EXPECT_TRUE(drawing.picture(woods.camera(48), {.samples = 1}).values == before.values);
  }
}

// (R24) Check what is seen by no light at all, without trees, and of a single pixel: black leaves, the bare sky, ground
// in full light.
TEST(R24_StandRenderer, DrawsWhatIsHardlyThere) {
  Woods woods;
  woods.scene.sky = {};
  for (Sun& sun : woods.scene.suns) sun.zenith = 2.f;  // below the horizon
  Drawing night(woods.stand());
  const Image dark = night.picture(woods.camera(32));
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) EXPECT_EQ(value(dark, x, y, "G"), 0.f);
  EXPECT_EQ(value(night.picture(woods.camera(1)), 0, 0, "R"), 0.f);

  gl::DrawnStand bare{.lights = {{.irradiance = {1.f, 0.5f, 0.25f}}},
                      .ground_albedo = glm::vec3(0.5f),
                      .sky = std::make_shared<const SkyMap>(uniformSky(glm::dvec3(kPi)))};
  Drawing empty(bare);
  const Camera down{.elevation = 0.5f * kPi, .half_width = 0.5f, .width = 2, .height = 2};
  EXPECT_NEAR(value(empty.picture(down), 0, 0, "G"), 0.5f * 0.5f / kPi, kShading);
  const Camera up{.elevation = -0.5f * kPi, .half_width = 0.5f, .width = 2, .height = 2};
  EXPECT_NEAR(value(empty.picture(up), 1, 1, "G"), 1.f, kShading);
  EXPECT_EQ(value(empty.picture(up), 1, 1, "A"), 0.f);
}

// (R24) Check what is under the cursor: the tree that was put there, at its place; the ground; nothing.
TEST(R24_StandRenderer, TellsWhatIsUnderTheCursor) {
  Woods woods(4);
  Drawing drawing(woods.stand());
  Camera camera{.target = woods.scene.stand.trees[3].position,
                .elevation = 0.5f * kPi,
                .half_width = 12.f,
                .width = 65,
                .height = 65};
  gl::FrameTarget target({65, 65});
  const gl::View view{.camera = camera};
  drawing.renderer.draw(view, target);
  int hits = 0;
  for (int x = 28; x < 37; ++x) {
    const auto pick = drawing.renderer.at({x, 32}, view, target);
    ASSERT_TRUE(pick);
    if (!pick->tree) continue;
    ++hits;
    EXPECT_EQ(*pick->tree, 3u);
    EXPECT_TRUE(pick->leaf);
    EXPECT_LT(glm::distance(glm::vec2(pick->place), glm::vec2(camera.target)), 2.f);
  }
  EXPECT_GT(hits, 2);
  const auto corner = drawing.renderer.at({40, 32}, view, target);
  ASSERT_TRUE(corner);
  EXPECT_FALSE(corner->tree);
  camera.elevation = -0.4f;
  drawing.renderer.draw({.camera = camera}, target);
  EXPECT_FALSE(drawing.renderer.at({0, 64}, {.camera = camera}, target));
}

}  // namespace
