// Check pictures of leaves that are not alike at all places and on both sides (R37): what the processor and the
// graphics card make of a place, energy, what far leaves show, and what is sent when maps change.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>
#include <vector>

#include "core/random.hpp"
#include "render/shading/fragment_shading.hpp"
#include "render/shading/image_map.hpp"
#include "scattering/leaf_gloss.hpp"
#include "tests/drawn_woods.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::shading;
using namespace sunfleck::woods;

constexpr float kPi = std::numbers::pi_v<float>;

// Any maps; where `white`, neither side absorbs at some places, and one of them does not at any.
LeafMaps someMaps(int width, int height, bool white, std::uint64_t seed = 1) {
  LeafMaps maps{.width = width, .height = height, .places = {}, .roughnesses = {0.2f, 0.5f}};
  Random random(seed, 0);
  for (int i = 0; i < width * height; ++i) {
    LeafPlace& place = maps.places.emplace_back();
    for (int band = 0; band < kBands; ++band) {
      place.transmittance[band] = 0.8f * random.uniform();
      for (std::size_t side = 0; side < 2; ++side) {
        const float rest = 1.f - place.transmittance[band];
        const bool all = white && (side == 0 || i % 3 == 0);
        place.faces[side].reflectance[band] = all ? rest : rest * random.uniform();
        place.faces[side].gloss[band] = i % 5 == 0 && side == 1 ? 0.f : random.uniform();
      }
    }
    for (LeafFace& face : place.faces) face.roughness = random.uniform() < 0.5f ? 0u : 1u;
  }
  return maps;
}

// Of triangles two by two, each pair a whole image; of every tenth nothing is told.
void addPatches(TreeMesh& mesh) {
  mesh.patches = {{.corners = {glm::vec2(0.f, 0.f), {1.f, 0.f}, {1.f, 1.f}}},
                  {.corners = {glm::vec2(0.f, 0.f), {1.f, 1.f}, {0.f, 1.f}}}};
  mesh.patch_of_triangle.clear();
  for (std::uint32_t i = 0; i < mesh.leaf_triangles.size(); ++i)
    mesh.patch_of_triangle.push_back(i % 10 == 0 ? TreeMesh::kNoPatch : i % 2);
}

void setMaps(TreeKind& kind, LeafMaps maps) {
  validate(maps, "test");
  kind.leaf = meanOptics(maps, leafAreaShares(*kind.mesh, maps.width, maps.height));
  kind.maps = std::make_shared<const LeafMaps>(std::move(maps));
}

// One square leaf, its image upright along +x and +y, seen from above at its upper side.
TreeKind oneLeaf(LeafMaps maps) {
  auto mesh = std::make_shared<TreeMesh>();
  mesh->vertices = {{0.f, 0.f, 0.f}, {1.f, 0.f, 0.f}, {1.f, 1.f, 0.f}, {0.f, 1.f, 0.f}};
  mesh->leaf_triangles = {{0, 1, 2}, {0, 2, 3}};
  finish(*mesh, "test");
  mesh->patches = {{.corners = {glm::vec2(0.f, 0.f), {1.f, 0.f}, {1.f, 1.f}}},
                   {.corners = {glm::vec2(0.f, 0.f), {1.f, 1.f}, {0.f, 1.f}}}};
  mesh->patch_of_triangle = {0, 1};
  TreeKind kind;
  kind.mesh = mesh;
  setMaps(kind, std::move(maps));
  return kind;
}

FragmentShading shadingBy(const TreeKind& kind, const glm::vec3& travel, Model model = Model::ss) {
  ShadingData data;
  const std::array suns{ShadingLight{.travel = vec4(travel, 0.f), .irradiance = vec4(1.f)}};
  update(data, model, std::array{kind}, suns, exactPowerTable);
  return FragmentShading(model, data);
}

glm::vec3 along(float zenith, float azimuth) {
  return {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
}

// (R20, R37) BRDF or BTDF times the light's cosine, of a horizontal leaf [1/sr].
float sent(const LeafPlace& place, const std::vector<LeafGloss>& glosses, const glm::vec3& eye, const glm::vec3& light,
           int band) {
  const std::size_t seen = eye.z > 0.f ? 0 : 1;
  const LeafFace &same = place.faces[seen], &other = place.faces[1 - seen];
  const auto in = [&](const LeafFace& face, float cosine) {
    return 1.f - face.gloss[band] * glosses[face.roughness].albedo(cosine);
  };
  const auto mean = [&](const LeafFace& face) { return 1.f - face.gloss[band] * glosses[face.roughness].meanAlbedo(); };
  const float mu = std::abs(eye.z), mu_light = std::abs(light.z);
  if (eye.z * light.z < 0.f)
    return place.transmittance[band] * in(same, mu) * in(other, mu_light) * mu_light /
           (kPi * std::max(mean(same), mean(other)));
  const glm::vec3 up(1.f, 1.f, eye.z > 0.f ? 1.f : -1.f);
  return mu_light * (same.gloss[band] * glosses[same.roughness].brdf(eye * up, light * up) +
                     same.reflectance[band] * in(same, mu) * in(same, mu_light) / (kPi * mean(same)));
}

// (R37) Check direct light at all places and on both sides against the closed form. Half-way vectors that were rounded
// in other ways, which a lobe of roughness 0.2 magnifies.
TEST(R37_MappedLeaves, SendDirectLightOfTheirPlaceAndSide) {
  const LeafMaps maps = someMaps(4, 3, false);
  const TreeKind kind = oneLeaf(maps);
  const std::vector<LeafGloss> glosses{LeafGloss(0.2f), LeafGloss(0.5f)};
  for (const bool lit_above : {true, false}) {
    const glm::vec3 light = along(lit_above ? 0.7f : 2.3f, 1.f);
    const FragmentShading shading = shadingBy(kind, -light);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x)
        for (const float zenith : {0.1f, 1.4f, 1.8f, 2.5f}) {
          const glm::vec3 eye = along(zenith, 4.f);
          const vec2 at((static_cast<float>(x) + 0.3f) / 4.f - 2.f, 1.f - (static_cast<float>(y) + 0.6f) / 3.f);
          const SeenLeaf seen{shading.leafPlace(0, at, 0.5f), eye.z > 0.f};
          const glm::vec3 normal(0.f, 0.f, seen.front ? 1.f : -1.f);
          const Shaded shaded = shading.shadeByLight(shading.leafSurface(0, seen, 0, 0, normal, eye), {}, 0);
          for (int band = 0; band < kBands; ++band) {
            const float expected = sent(maps.places[maps.placeAt(at)], glosses, eye, light, band);
            EXPECT_NEAR(shaded.direct[band], expected, 2e-5f * (1.f + expected)) << x << " " << y << " " << zenith;
          }
        }
  }
}

// (R37) Check that no place sends on more light than arrives, from any direction on either side: by reciprocity what it
// sends to the eye of an even sky. All of it where neither side absorbs and both are alike; by the light of both halves
// and by the field's the same as by the sky's. Sums of floats.
TEST(R37_MappedLeaves, SendOnNoMoreThanArrives) {
  LeafMaps maps = someMaps(16, 16, true, 7);
  for (LeafPlace& place : maps.places)
    if (&place - maps.places.data() < 40) place.faces[1] = place.faces[0];
  const TreeKind kind = oneLeaf(maps);
  const float turn = 2.f * kPi;
  ShadingData data;
  const std::array suns{ShadingLight{.travel = vec4(-along(0.7f, 1.f), 0.f), .irradiance = vec4(1.f)}};
  update(data, Model::pp, std::array{kind}, suns, [&](const LeafOptics&) {
    spp::PowerTable table;
    table.nodes.assign(std::size_t{spp::kTableDepths} * spp::kTableThicknesses, {turn, turn});
    return table;
  });
  const FragmentShading shading(Model::pp, data), by_field = shadingBy(kind, {0.f, 0.f, -1.f}, Model::field);
  const FragmentLight full{.foliage = {0.f, 0.f, 1.f}, .thickness = 1.f, .compensation = 1.f};
  for (uint i = 0; i < 256; ++i)
    for (int step = 0; step < 40; ++step) {
      const glm::vec3 eye = along((static_cast<float>(step) + 0.5f) / 40.f * kPi, static_cast<float>(i));
      const bool front = eye.z > 0.f;
      const Surface surface = shading.leafSurface(0, {i, front}, 0, 0, glm::vec3(0.f, 0.f, front ? 1.f : -1.f), eye);
      const vec3 of_sky = shading.shadeBySky(surface, vec3(1.f)).scattered;
      const vec3 of_halves = shading.shadeByLight(surface, full, 0).scattered;
      const vec3 of_field = by_field.shadeBySides(surface, vec3(kPi), vec3(kPi)).scattered;
      for (int band = 0; band < kBands; ++band) {
        ASSERT_LE(of_sky[band], 1.f + 1e-5f);
        ASSERT_GE(of_sky[band], 0.f);
        if (i < 40) {
          ASSERT_NEAR(of_sky[band], 1.f, 1e-5f);
        }
        ASSERT_NEAR(of_halves[band], of_sky[band], 1e-5f);
        ASSERT_NEAR(of_field[band], of_sky[band], 1e-5f);
      }
    }
}

// (R37) Check that what passes is the same both ways between a direction above and one below.
TEST(R37_MappedLeaves, PassLightBothWaysAlike) {
  const TreeKind kind = oneLeaf(someMaps(8, 8, false, 3));
  const glm::vec3 above = along(0.4f, 1.f), below = along(2.f, 3.f);
  const FragmentShading down = shadingBy(kind, -above), up = shadingBy(kind, -below);
  for (uint i = 0; i < 64; ++i) {
    const vec3 to_below =
        down.shadeByLight(down.leafSurface(0, {i, false}, 0, 0, {0.f, 0.f, -1.f}, below), {}, 0).direct;
    const vec3 to_above = up.shadeByLight(up.leafSurface(0, {i, true}, 0, 0, {0.f, 0.f, 1.f}, above), {}, 0).direct;
    for (int band = 0; band < kBands; ++band)
      EXPECT_NEAR(to_below[band] / std::abs(above.z), to_above[band] / std::abs(below.z), 1e-6f);
  }
}

// (R37) Check coarser places against means taken one by one: the coarsest is the mean leaf, of each side, by leaf area.
// A float sums a thousand places in steps of four.
TEST(R37_MappedLeaves, ShowTheirMeanFromAfar) {
  LeafMaps maps = someMaps(37, 21, false, 5);
  maps.roughnesses = {0.3f};
  for (LeafPlace& place : maps.places)
    for (LeafFace& face : place.faces) face.roughness = 0;
  TreeKind kind = oneLeaf(maps);
  auto cut = std::make_shared<TreeMesh>(*kind.mesh);
  cut->patch_of_triangle[1] = TreeMesh::kNoPatch;  // the half above the diagonal is not shown
  kind.mesh = cut;
  setMaps(kind, maps);
  const FragmentShading shading = shadingBy(kind, {0.f, 0.f, -1.f});
  const glm::vec3 up(0.f, 0.f, 1.f);
  const auto seen = [&](uint place, bool front) { return shading.leafSurface(0, {place, front}, 0, 0, up, up); };
  const uint far = shading.leafPlace(0, {0.7f, 0.2f}, 1e9f);
  EXPECT_EQ(far, shading.leafPlace(0, {0.1f, 0.9f}, 1e4f));
  const Surface front = seen(far, true), back = seen(far, false), mean = seen(kNoLeafPlace, true);
  for (int band = 0; band < kBands; ++band) {
    EXPECT_NEAR(0.5f * (front.reflectance[band] + back.reflectance[band]), mean.reflectance[band], 2e-6f);
    EXPECT_NEAR(0.5f * (front.gloss[band] + back.gloss[band]), mean.gloss[band], 2e-6f);
    EXPECT_NEAR(front.transmittance[band], mean.transmittance[band], 2e-6f);
    EXPECT_EQ(front.gloss_beyond[band], back.gloss[band]);
  }
  EXPECT_EQ(mean.roughness, 0.3f);
  EXPECT_EQ(shading.leafPlace(0, {0.5f / 37.f, 1.f - 0.5f / 21.f}, 1.9f), 0u);
  // From the second level on: 19 x 11 places.
  EXPECT_EQ(shading.leafPlace(0, {0.5f / 37.f, 1.f - 0.5f / 21.f}, 2.f), 37u * 21u);
  EXPECT_EQ(shading.leafPlace(0, {36.5f / 37.f, 0.5f / 21.f}, 4.f), 37u * 21u + 19u * 11u - 1u);
}

// (R37) Check that an image map tells of a triangle's corners where they lie in the images, also of one that is drawn
// larger elsewhere.
TEST(R37_MappedLeaves, LieInTheirImages) {
  TreeMesh mesh = *oneLeaf(someMaps(1, 1, false)).mesh;
  mesh.vertices = {{5.f, 3.f, 9.f}, {5.1f, 3.02f, 9.03f}, {5.05f, 3.1f, 8.9f}, {4.9f, 3.1f, 9.f}};
  for (std::size_t t = 0; t < 2; ++t) {
    const ImageMap map = imageMap(mesh, t);
    const glm::vec3 from(5.f, 3.1f, 9.f), to(4.f, 3.f, 8.f);
    const ImageMap larger = enlarged(map, 3.f, from, to);
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 place = mesh.vertices[mesh.leaf_triangles[t][corner]];
      const glm::vec2 expected = mesh.patches[t].corners[static_cast<std::size_t>(corner)];
      // Images 0.1 m wide, 10 m off: 100 floats' roundings.
      EXPECT_LT(glm::distance(map.at(place), expected), 5e-5f);
      EXPECT_LT(glm::distance(larger.at(to + 3.f * (place - from)), expected), 5e-5f);
    }
  }
}

struct MappedWoods : Woods {
  MappedWoods() {
    scene.suns.resize(1);
    auto mesh = std::make_shared<TreeMesh>(*scene.kinds[0].mesh);
    addPatches(*mesh);
    scene.kinds[0].mesh = mesh;
    setMaps(scene.kinds[0], someMaps(24, 16, false));
  }
  Camera near() const {
    Camera from = camera();
    from.target = bounds(*scene.kinds[0].mesh).centre() + scene.stand.trees[4].position;
    from.half_width = 0.4f;
    return from;
  }
};

// (R37) Check pictures against C++, which shades the same places: by all models, in parallel and in perspective, near
// and far. Where a place lies on the edge of another, to the depths' roundings, either may be shown: one pixel in
// fifty.
TEST(R37_MappedLeaves, AreDrawnAsCppShadesThem) {
  MappedWoods woods;
  Drawing drawing(woods.stand());
  std::set<uint> shown;
  std::set<bool> fronts;
  for (const Camera& camera : {woods.near(), woods.camera(), inPerspective(woods.near())})
    for (const Model model : {Model::ss, Model::sppg, Model::pp}) {
      const Image image = drawing.picture(camera, {.model = model, .samples = 1, .layers = kAll});
      ShadingData data;
      const std::array suns{ShadingLight{.travel = vec4(woods.scene.sun().light(), 0.f),
                                         .irradiance = vec4(woods.scene.sun().irradiance, 0.f)}};
      update(data, model, woods.scene.kinds, suns, exactPowerTable);
      const FragmentShading shading(model, data);
      int leaves = 0, differ = 0;
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          const auto at = [&](const char* name) { return value(image, x, y, name); };
          if (at("id.leaf") < 0.f) continue;
          ++leaves;
          const auto kind = static_cast<uint>(at("id.kind"));
          const auto triangle = static_cast<std::size_t>(at("id.triangle"));
          const TreeMesh& mesh = *woods.scene.kinds[kind].mesh;
          const glm::uvec3 t = mesh.leaf_triangles[triangle];
          const glm::vec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
          const Sight look = sightThrough(camera, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
          const glm::vec3 normal(at("normal.X"), at("normal.Y"), at("normal.Z"));
          const float axial = glm::dot(look.along, viewAxes(camera).along), away = at("depth.Z") / axial;
          SeenLeaf seen{.front = glm::dot(glm::cross(b - a, c - a), look.along) <= 0.f};
          if (const ImageMap map = imageMap(mesh, triangle); kind == 0 && map.known()) {
            const auto tree = static_cast<std::size_t>(at("id.tree"));
            const glm::vec3 there = look.from + away * look.along - woods.scene.stand.trees[tree].position;
            const float side = 1.f / gl::pixelsPerMetre(camera, at("depth.Z"));
            const float images = side * side / std::max(-glm::dot(normal, look.along), 1e-3f) *
                                 glm::length(glm::cross(glm::vec3(map.u), glm::vec3(map.v)));
            seen.place = shading.leafPlace(kind, map.at(there), images * 24.f * 16.f);
            shown.insert(seen.place);
            fronts.insert(seen.front);
          }
          const Surface surface = shading.leafSurface(kind, seen, 0, 0, normal, -look.along);
          const float before = at("foliage.before"), beyond = at("foliage.beyond");
          const Shaded shaded = shading.shadeByLight(surface,
                                                     {.foliage = {before, beyond, at("foliage.visible")},
                                                      .thickness = before + beyond + 1.f,
                                                      .compensation = at("foliage.G")},
                                                     0);
          const std::array bands{"R", "G", "B"};
          bool same = true;
          for (int band = 0; band < 3; ++band) {
            const std::string name = bands[static_cast<std::size_t>(band)];
            same &= std::abs(at(("direct." + name).c_str()) - shaded.direct[band]) <=
                    kShading * (1.f + 20.f * shaded.direct[band]);  // a lobe of roughness 0.2 magnifies roundings
            same &= std::abs(at(("multiple." + name).c_str()) - (shaded.scattered[band] - shaded.single[band])) <=
                    kShading * (1.f + shaded.scattered[band]);
          }
          differ += same ? 0 : 1;
        }
      EXPECT_GT(leaves, 1000);
      EXPECT_LT(50 * differ, leaves) << nameOf(model);
    }
  EXPECT_GT(shown.size(), 300u);
  EXPECT_EQ(fronts.size(), 2u);
}

// (R37) Check that maps which say of all places and sides the same give the picture of leaves without maps, to
// rounding.
TEST(R37_MappedLeaves, AlikeEverywhereAreLeavesWithoutMaps) {
  MappedWoods woods;
  LeafMaps maps{.width = 3, .height = 2, .places = std::vector<LeafPlace>(6), .roughnesses = {0.4f}};
  for (LeafPlace& place : maps.places) {
    place.transmittance = {0.1f, 0.3f, 0.2f};
    place.faces.fill({.reflectance = {0.2f, 0.4f, 0.1f}, .gloss = {0.3f, 0.5f, 0.7f}, .roughness = 0});
  }
  setMaps(woods.scene.kinds[0], maps);
  const Image mapped = Drawing(woods.stand()).picture(woods.near(), {.samples = 2});
  woods.scene.kinds[0].maps = nullptr;
  const Image plain = Drawing(woods.stand()).picture(woods.near(), {.samples = 2});
  for (std::size_t i = 0; i < plain.values.size(); ++i)
    ASSERT_NEAR(mapped.values[i], plain.values[i], 1e-5f * (1.f + plain.values[i]));
}

// (R37) Check that leaves drawn fewer and larger show their own parts of the images: of those which are black but for
// the half that leaves show, the light over the whole picture is that of the same leaves alike everywhere. To what the
// places of some hundred leaves spread about their mean.
TEST(R37_MappedLeaves, ShowTheirOwnPartsWhenEnlarged) {
  MappedWoods woods;
  woods.scene.ground_albedo = glm::vec3(0.f);
  woods.scene.sky = {};
  TreeKind& kind = woods.scene.kinds[0];
  auto mesh = std::make_shared<TreeMesh>(*kind.mesh);
  for (LeafPatch& patch : mesh->patches)
    for (glm::vec2& corner : patch.corners) corner.x *= 0.5f;
  kind.mesh = mesh;
  for (Placement& tree : woods.scene.stand.trees) tree.kind = 0;
  LeafMaps maps = someMaps(24, 16, false);
  for (std::size_t i = 0; i < maps.places.size(); ++i)
    if (i % 24 >= 12) maps.places[i] = {};
  for (LeafPlace& place : maps.places)
    for (LeafFace& face : place.faces) face.gloss = glm::vec3(0.f);
  setMaps(kind, maps);
  LeafMaps alike{.places = {LeafPlace{}}};
  const std::vector<float> shares = leafAreaShares(*mesh, 24, 16);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    alike.places[0].transmittance += shares[i] * maps.places[i].transmittance;
    for (std::size_t side = 0; side < 2; ++side)
      alike.places[0].faces[side].reflectance += shares[i] * maps.places[i].faces[side].reflectance;
  }
  const auto brightness = [&] {
    Drawing drawing(woods.stand());
    const Image image = drawing.picture(woods.camera(64), {.samples = 8, .piece_pixels = 8.f});
    double sum = 0.;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += double{value(image, x, y, "G")};
    return sum;
  };
  const double mapped = brightness();
  setMaps(kind, alike);
  EXPECT_NEAR(mapped / brightness(), 1., 0.02);
}

// (R37) Check that other maps are sent and nothing else of the stand: places alone, and the picture is that of a new
// renderer; and that nothing is sent where nothing has changed.
TEST(R37_MappedLeaves, AreSentAlone) {
  MappedWoods woods;
  Drawing drawing(woods.stand());
  const Image before = drawing.picture(woods.near(), {.samples = 1});
  gl::Sent sent = drawing.renderer.update(woods.stand());
  EXPECT_EQ(sent.leaves, 0u);
  const BandOptics mean = woods.scene.kinds[0].leaf;  // what else depends on
  setMaps(woods.scene.kinds[0], someMaps(24, 16, false, 9));
  woods.scene.kinds[0].leaf = mean;
  sent = drawing.renderer.update(woods.stand());
  EXPECT_EQ(sent.meshes + sent.maps + sent.cells + sent.sky + sent.field, 0u);
  EXPECT_EQ(sent.leaves, (24u * 16 + 12 * 8 + 6 * 4 + 3 * 2 + 2 * 1 + 1) * kLeafPlaceGroups * sizeof(vec4));
  const Image after = drawing.picture(woods.near(), {.samples = 1});
  EXPECT_NE(after.values, before.values);
  woods.scene.kinds[0].maps = nullptr;
  drawing.renderer.update(woods.stand());
  const Image without = drawing.picture(woods.near(), {.samples = 1});
  EXPECT_EQ(without.values, Drawing(woods.stand()).picture(woods.near(), {.samples = 1}).values);
  setMaps(woods.scene.kinds[0], someMaps(24, 16, false, 9));
  woods.scene.kinds[0].leaf = mean;
  EXPECT_EQ(after.values, Drawing(woods.stand()).picture(woods.near(), {.samples = 1}).values);
}

// (R37) Check that turned trees share the pyramid of their maps, that it stays while they do, and that gloss tables of
// the same roughnesses are made once.
TEST(R37_MappedLeaves, ShareWhatTheyShow) {
  const TreeKind leaf = oneLeaf(someMaps(8, 4, false));
  TreeKind turned = leaf, plain = leaf;
  turned.mesh = std::make_shared<TreeMesh>(*leaf.mesh);
  plain.maps = nullptr;
  const std::array kinds{leaf, turned, plain};
  const auto tables = leafTables(kinds, nullptr);
  EXPECT_EQ(tables->kinds[0].pyramid, tables->kinds[1].pyramid);
  EXPECT_EQ(tables->places, 8u * 4 + 4 * 2 + 2 + 1);
  EXPECT_EQ(tables->kinds[0].first_table, tables->kinds[1].first_table);
  EXPECT_EQ(tables->roughnesses.size(), 3u);  // two of the maps, and the mean of the kind that has none
  EXPECT_EQ(leafTables(kinds, tables), tables);
  TreeKind other = leaf;
  setMaps(other, someMaps(8, 4, false, 2));
  const auto next = leafTables(std::array{other, turned, plain}, tables);
  EXPECT_EQ(next->kinds[1].pyramid, tables->kinds[1].pyramid);
  EXPECT_NE(next->kinds[0].pyramid, tables->kinds[0].pyramid);
  EXPECT_EQ(next->kinds[0].shares, tables->kinds[0].shares);
}

}  // namespace
