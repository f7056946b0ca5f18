// Check that the viewer's edits are undone and done again whole, that its cameras move as they say, and that scripts
// are read or refused with a line that tells why.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "apps/view/edit_history.hpp"
#include "apps/view/leaf_thumbnails.hpp"
#include "apps/view/made_leaves.hpp"
#include "apps/view/navigation.hpp"
#include "apps/view/view_script.hpp"
#include "core/random.hpp"
#include "core/require.hpp"
#include "tests/random_leaves.hpp"

namespace sunfleck::view {
namespace {

Document smallDocument() {
  Document document;
  document.scene.name = document.scene.origin = "small";
  document.scene.kinds[0].name = "random";
  static const auto kMesh = std::make_shared<const TreeMesh>(randomLeaves(50, 1.f, 0.05f));
  document.scene.kinds[0].mesh = kMesh;
  return document;
}

bool same(const BandOptics& a, const BandOptics& b) {
  return a == b;
}

bool same(const Document& a, const Document& b) {
  bool kinds = a.scene.kinds.size() == b.scene.kinds.size();
  for (std::size_t i = 0; kinds && i < a.scene.kinds.size(); ++i)
    kinds = a.scene.kinds[i].name == b.scene.kinds[i].name && a.scene.kinds[i].mesh == b.scene.kinds[i].mesh &&
            same(a.scene.kinds[i].told(), b.scene.kinds[i].told()) &&
            a.scene.kinds[i].textures == b.scene.kinds[i].textures;
  return kinds && a.scene.saved_cameras == b.scene.saved_cameras && a.scene.stand == b.scene.stand &&
         a.scene.sky == b.scene.sky && a.scene.ground_albedo == b.scene.ground_albedo &&
         a.scene.sun().zenith == b.scene.sun().zenith && a.model == b.model && a.effort.cells == b.effort.cells &&
         a.selected == b.selected;
}

SceneEdit optics(std::size_t kind, const glm::vec3& wood, const BandOptics& leaf = {}) {
  SceneEdit edit;
  edit.emplace<SetOptics>(kind, leaf, wood);
  return edit;
}

// Colours and alphas that rise from place to place, up to 1.
std::shared_ptr<const LeafTexture> risingTexture(int width, int height) {
  LeafTexture texture{.file = "rising.png", .width = width, .height = height, .colour = {}, .alpha = {}};
  const int places = width * height;
  for (int i = 1; i <= places; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(places);
    texture.colour.emplace_back(share, 0.5f * share, 1.f);
    texture.alpha.push_back(share);
  }
  return std::make_shared<const LeafTexture>(std::move(texture));
}

SceneEdit randomEdit(const Document& document, Random& random) {
  const auto place = [&] { return glm::vec3(20.f * random.uniform(), 20.f * random.uniform(), 0.f); };
  const std::size_t trees = document.scene.stand.trees.size();
  const auto tree = static_cast<std::size_t>(random.uniform() * static_cast<float>(trees));
  switch (static_cast<int>(12.f * random.uniform())) {
    case 0:
      return SetSuns{{Sun{.zenith = random.uniform()}}};
    case 1:
      return SetSky{{.kind = SceneSky::Kind::uniform, .irradiance = glm::dvec3(random.uniform())}};
    case 2:
      return SetGround{glm::vec3(random.uniform())};
    case 3:
      return optics(0, glm::vec3(random.uniform()));
    case 4:
      return SetModel{kModels[static_cast<std::size_t>(3.f * random.uniform())]};
    case 5:
      if (trees > 0) return MoveTree{tree, place()};
      [[fallthrough]];
    case 6:
      return SaveCamera{{std::string(1, static_cast<char>('a' + 3.f * random.uniform())), {}}};
    case 7:
      if (trees > 0) return RemoveTrees{{tree}};
      [[fallthrough]];
    case 8:
      if (trees > 0) return TurnTree{tree, random.uniform()};
      [[fallthrough]];
    case 9:
      return SetLeafImage{0, random.uniform() < 0.5f ? LeafImage::upper : LeafImage::lower_gloss,
                          random.uniform() < 0.7f ? risingTexture(3, 2) : nullptr};
    case 10:
      return SetOptics{.kind = 0,
                       .leaf = {},
                       .wood_reflectance = glm::vec3(0.3f),
                       .textures = LeafTextures{.underside = {.gloss = glm::vec3(random.uniform())}}};
    default:
      return AddTrees{{Placement{.position = place()}, Placement{.position = place()}}};
  }
}

TEST(EditHistory, GoesBackAndForthThroughAnyEdits) {
  Random random(7, 0);
  for (int history_number = 0; history_number < 20; ++history_number) {
    EditHistory history(smallDocument());
    std::vector<Document> documents{history.now()};
    for (int i = 0; i < 60; ++i) {
      const float choice = random.uniform();
      if (choice < 0.2f && documents.size() > 1) {
        ASSERT_TRUE(history.undo());
        documents.pop_back();
      } else {
        history.apply(randomEdit(history.now(), random));
        documents.push_back(history.now());
      }
      ASSERT_TRUE(same(history.now(), documents.back()));
    }
    history.apply(randomEdit(history.now(), random));  // after which there is nothing to do again
    documents.push_back(history.now());
    for (std::size_t i = documents.size(); i-- > 1;) {
      ASSERT_TRUE(same(history.now(), documents[i]));
      ASSERT_TRUE(history.undo());
    }
    EXPECT_TRUE(same(history.now(), smallDocument()));
    EXPECT_FALSE(history.undo());
    for (std::size_t i = 1; i < documents.size(); ++i) {
      ASSERT_TRUE(history.redo());
      ASSERT_TRUE(same(history.now(), documents[i]));
    }
    EXPECT_FALSE(history.redo());
  }
}

TEST(EditHistory, TakesADragAsOneStep) {
  EditHistory history(smallDocument());
  for (int i = 1; i <= 10; ++i) history.apply(MoveTree{0, {static_cast<float>(i), 0.f, 0.f}}, 5);
  history.apply(MoveTree{0, {20.f, 0.f, 0.f}}, 6);
  ASSERT_TRUE(history.undo());
  EXPECT_EQ(history.now().scene.stand.trees[0].position.x, 10.f);
  EXPECT_EQ(history.undoes(), "move tree");
  ASSERT_TRUE(history.undo());
  EXPECT_EQ(history.now().scene.stand.trees[0].position.x, 0.f);
  EXPECT_EQ(history.undoes(), std::nullopt);
  EXPECT_EQ(history.redoes(), "move tree");
}

TEST(EditHistory, ForgetsWhatIsOldAlone) {
  EditHistory history(smallDocument());
  const int steps = static_cast<int>(EditHistory::kMostSteps) + 50;
  for (int i = 1; i <= steps; ++i) history.apply(MoveTree{0, {static_cast<float>(i), 0.f, 0.f}});
  std::size_t undone = 0;
  while (history.undo()) ++undone;
  EXPECT_EQ(undone, EditHistory::kMostSteps);
  EXPECT_EQ(history.now().scene.stand.trees[0].position.x, 50.f);
}

TEST(EditHistory, ChangesNothingByAWrongEdit) {
  EditHistory history(smallDocument());
  history.select(0);
  const float nan = std::nanf("");
  const std::vector<SceneEdit> wrong{
      SetSuns{{}},
      SetSuns{std::vector<Sun>(5)},
      SetSuns{{Sun{.zenith = -0.1f}}},
      SetSuns{{Sun{.zenith = nan}}},
      SetSuns{{Sun{.azimuth = nan}}},
      SetSuns{{Sun{.irradiance = glm::vec3(0.f, nan, 0.f)}}},
      SetSky{{.kind = SceneSky::Kind::uniform, .irradiance = glm::dvec3(-1.)}},
      SetSky{{.kind = SceneSky::Kind::preetham, .turbidity = 99.}},
      SetSky{{.kind = SceneSky::Kind::image}},
      SetGround{glm::vec3(1.5f)},
      SetGround{glm::vec3(nan)},
      optics(1, glm::vec3(0.f)),
      optics(0, glm::vec3(0.f), {LeafOptics{.reflectance = 0.9f, .transmittance = 0.9f}}),
      optics(0, glm::vec3(-1.f)),
      SetEffort{{.sample_directions = 3}},
      SetEffort{{.light_resolution = 0}},
      SetEffort{{.cells = 65}},
      SetLeafImage{1, LeafImage::upper, nullptr},
      SetOptics{.kind = 0, .leaf = {}, .wood_reflectance = {}, .textures = LeafTextures{.relief = -1.}},
      SetOptics{.kind = 0, .leaf = {}, .wood_reflectance = {}, .textures = LeafTextures{.albedo = glm::vec3(nan)}},
      SetOptics{.kind = 0,
                .leaf = {},
                .wood_reflectance = {},
                .textures = LeafTextures{.underside = {.reflectance = glm::vec3(1.5f)}}},
      SetOptics{.kind = 0,
                .leaf = {},
                .wood_reflectance = {},
                .textures = LeafTextures{.upper = {.detail = risingTexture(2, 2), .gloss = risingTexture(2, 3)}}},
      MoveTree{1, glm::vec3(0.f)},
      MoveTree{0, glm::vec3(nan)},
      MoveTree{0, glm::vec3(2e6f)},
      AddTrees{{}},
      AddTrees{{Placement{.kind = 1}}},
      AddTrees{std::vector<Placement>(100)},  // a heap in one place
      RemoveTrees{{3}},
      TurnTree{1, 0.f},
      TurnTree{0, nan},
      SaveCamera{{"", {}}},
      ForgetCamera{"none"},
  };
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_THROW(history.apply(wrong[i]), InvalidInput) << i;
    EXPECT_TRUE(same(history.now(),
                     [] {
                       Document document = smallDocument();
                       document.selected = 0;
                       return document;
                     }()))
        << i;
  }
  EXPECT_THROW(history.select(1), InvalidInput);
  EXPECT_FALSE(history.undo());
}

TEST(EditHistory, GivesNewKindsNamesOfTheirOwn) {
  EditHistory history(smallDocument());
  const TreeKind kind = history.now().scene.kinds[0];
  history.apply(AddKind{kind, {30.f, 0.f, 0.f}});
  history.apply(AddKind{kind, {60.f, 0.f, 0.f}});
  EXPECT_EQ(history.now().scene.kinds[1].name, "random 2");
  EXPECT_EQ(history.now().scene.kinds[2].name, "random 3");
  EXPECT_EQ(history.now().selected, 2u);
}

// Numbers of the lower side give way to its images, as they cannot stand beside them.
TEST(SceneEdit, PutsLowerImagesInThePlaceOfNumbers) {
  Document document = smallDocument();
  document.scene.kinds[0].textures.underside.gloss = glm::vec3(0.5f);
  document = edited(document, SetLeafImage{0, LeafImage::upper, risingTexture(3, 2)});
  EXPECT_TRUE(document.scene.kinds[0].textures.underside.any());
  document = edited(document, SetLeafImage{0, LeafImage::lower, risingTexture(3, 2)});
  EXPECT_FALSE(document.scene.kinds[0].textures.underside.any());
  try {
    edited(document, SetLeafImage{0, LeafImage::upper_gloss, risingTexture(4, 4)});
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_STREQ(e.what(), "leaf: rising.png has 3 x 2 pixels and rising.png has 4 x 4: must be of one size");
  }
  for (const LeafImage image : {LeafImage::upper, LeafImage::lower})
    document = edited(document, SetLeafImage{0, image, nullptr});
  EXPECT_FALSE(document.scene.kinds[0].textures.any());
}

TEST(MadeLeaves, MakesWhatIsToldOtherwiseAlone) {
  const Document document = edited(smallDocument(), SetLeafImage{0, LeafImage::upper, risingTexture(30, 20)});
  std::vector<TreeKind> kinds{document.scene.kinds[0], smallDocument().scene.kinds[0]};
  EXPECT_EQ(kinds[0].maps, nullptr);
  MadeLeaves leaves;
  leaves.make(kinds, {});
  EXPECT_EQ(leaves.lastCost().made, 1u);  // the other has no textures
  EXPECT_EQ(kinds[1].maps, nullptr);
  TreeKind expected = document.scene.kinds[0];
  setLeaves(expected, {}, expected.told());
  ASSERT_NE(kinds[0].maps, nullptr);
  EXPECT_EQ(*kinds[0].maps, *expected.maps);
  EXPECT_EQ(kinds[0].leaf, expected.leaf);
  EXPECT_NE(kinds[0].leaf, kinds[0].even);
  // The same again, of which the document holds no maps.
  std::vector<TreeKind> again{document.scene.kinds[0]};
  leaves.make(again, {});
  EXPECT_EQ(leaves.lastCost().made, 0u);
  EXPECT_EQ(leaves.lastCost().reused, 1u);
  EXPECT_EQ(again[0].maps, kinds[0].maps);
  EXPECT_EQ(again[0].leaf, kinds[0].leaf);
  // Another factor: other maps on the same shares of leaf area.
  std::vector<TreeKind> dark{document.scene.kinds[0]};
  dark[0].textures.albedo = glm::vec3(0.5f);
  leaves.make(dark, {});
  EXPECT_EQ(leaves.lastCost().made, 1u);
  EXPECT_EQ(dark[0].shares, kinds[0].shares);
  EXPECT_LT(dark[0].leaf[0].reflectance, kinds[0].leaf[0].reflectance);
}

TEST(LeafThumbnails, ShowMeansOfPlaces) {
  const auto texture = risingTexture(4, 2);
  const Thumbnail whole = thumbnailOf(*texture, LeafImagePart::alpha, 8);
  EXPECT_EQ(whole.width, 4);
  EXPECT_EQ(whole.height, 2);
  EXPECT_EQ(whole.colours[0], glm::u8vec4(32, 32, 32, 255));  // 255 / 8, rounded
  EXPECT_EQ(whole.colours[7], glm::u8vec4(255));
  const Thumbnail small = thumbnailOf(*texture, LeafImagePart::alpha, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.colours[0], glm::u8vec4(112, 112, 112, 255));  // 255 (1 + 2 + 5 + 6) / 32, rounded
  const Thumbnail colour = thumbnailOf(*texture, LeafImagePart::colour, 8);
  EXPECT_EQ(colour.colours[7], glm::u8vec4(255, 188, 255, 255));  // a light of 0.5 in sRGB
  const Thumbnail narrow = thumbnailOf(*risingTexture(1, 50), LeafImagePart::colour, 10);
  EXPECT_EQ(narrow.width, 1);
  EXPECT_EQ(narrow.height, 10);
  LeafMaps maps{.places = {{.transmittance = glm::vec3(1.f)}}};
  maps.places[0].faces[1].reflectance = {1.f, 0.f, 2.f};
  EXPECT_EQ(thumbnailOf(maps, LeafMapPart::transmittance, 8).colours[0], glm::u8vec4(255));
  EXPECT_EQ(thumbnailOf(maps, LeafMapPart::upper_reflectance, 8).colours[0], glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(thumbnailOf(maps, LeafMapPart::lower_reflectance, 8).colours[0], glm::u8vec4(255, 0, 255, 255));
}

// Frames ask for them again and again.
TEST(LeafThumbnails, AreMadeOnceAnImage) {
  int there = 0;
  LeafThumbnails thumbnails([&](const Thumbnail& thumbnail) {
    ++there;
    return std::shared_ptr<const LeafThumbnails::Uploaded>(
        new LeafThumbnails::Uploaded{.name = 1, .width = thumbnail.width, .height = thumbnail.height},
        [&there](const LeafThumbnails::Uploaded* gone) {
          --there;
          delete gone;
        });
  });
  auto texture = risingTexture(4, 2);
  const auto maps = std::make_shared<const LeafMaps>(LeafMaps{.places = {LeafPlace{}}});
  for (int frame = 0; frame < 5; ++frame) {
    thumbnails.of(texture, LeafImagePart::colour);
    EXPECT_EQ(thumbnails.of(texture, LeafImagePart::alpha).width, 4);
    EXPECT_EQ(thumbnails.of(maps, LeafMapPart::transmittance).width, 1);
  }
  EXPECT_EQ(thumbnails.made(), 3u);
  EXPECT_EQ(there, 3);
  texture = risingTexture(4, 2);  // another image
  thumbnails.of(texture, LeafImagePart::colour);
  EXPECT_EQ(thumbnails.made(), 4u);
  EXPECT_EQ(there, 2);  // those of the former image are gone
}

constexpr Camera kCamera{.target = {1.f, 2.f, 3.f},
                         .elevation = 0.3f,
                         .azimuth = 0.8f,
                         .half_width = 5.f,
                         .field_of_view = 0.9f,
                         .width = 640,
                         .height = 480};
// Places of some metres in single precision, through a rotation: tens of roundings of 1e-6 m, some 1e-4 of a pixel.
constexpr float kRounding = 1e-4f, kPixelRounding = 0.05f;

TEST(Navigation, KeepsTheTargetOfAnOrbit) {
  const Camera turned = orbited(kCamera, 0.5f, 0.2f);
  EXPECT_EQ(turned.target, kCamera.target);
  EXPECT_NEAR(glm::distance(eyeOf(turned), turned.target), glm::distance(eyeOf(kCamera), kCamera.target), kRounding);
  EXPECT_LE(orbited(kCamera, 0.f, 9.f).elevation, kSteepest);
  EXPECT_GE(orbited(kCamera, 0.f, -9.f).elevation, -kSteepest);
  EXPECT_LE(std::abs(orbited(kCamera, 1000.f, 0.f).azimuth), 3.1416f);
}

TEST(Navigation, KeepsTheEyeWhenLookingAround) {
  for (const float elevation : {-3.f, -0.4f, 0.f, 0.7f, 3.f}) {
    const Camera turned = lookedAround(kCamera, 0.5f, elevation);
    EXPECT_NEAR(glm::distance(eyeOf(turned), eyeOf(kCamera)), 0.f, kRounding);
  }
}

TEST(Navigation, MovesTheEyeWhenFlyingAndWalking) {
  const Axes axes = viewAxes(kCamera);
  const Camera flying = flown(kCamera, 1.f, 2.f, 3.f);
  const glm::vec3 moved = eyeOf(flying) - eyeOf(kCamera);
  EXPECT_NEAR(glm::distance(moved, axes.right + 2.f * axes.up + 3.f * axes.along), 0.f, kRounding);
  for (const float elevation : {-1.5707963f, -0.5f, 0.4f, 1.5707963f}) {
    Camera camera = kCamera;
    camera.elevation = elevation;
    const Camera walking = walked(camera, 0.f, 2.f, -4.f);
    EXPECT_NEAR(eyeOf(walking).z, -4.f + kWalkersEye, kRounding);
    EXPECT_NEAR(glm::distance(glm::vec2(eyeOf(walking)), glm::vec2(eyeOf(camera))), 2.f, kRounding);
  }
  Camera flat = kCamera;
  flat.field_of_view = 0.f;
  EXPECT_TRUE(flown(flat, 0.f, 0.f, 1.f).perspective());
  EXPECT_FALSE(orthographic(kCamera).perspective());
}

TEST(Navigation, KeepsWhatIsUnderTheMouse) {
  for (const float field_of_view : {0.f, 0.9f}) {
    Camera camera = kCamera;
    camera.field_of_view = field_of_view;
    const glm::vec3 beside = camera.target + 2.f * viewAxes(camera).right - 1.5f * viewAxes(camera).up;
    const glm::vec2 place = *pixelOf(camera, beside);
    const Sight sight = sightThrough(camera, place);
    EXPECT_NEAR(glm::length(glm::cross(beside - sight.from, sight.along)), 0.f, kRounding);
    for (const float factor : {0.5f, 2.f})
      EXPECT_NEAR(glm::distance(*pixelOf(zoomed(camera, factor, place), beside), place), 0.f, kPixelRounding);
    const glm::vec2 shift(30.f, -12.f);
    EXPECT_NEAR(glm::distance(*pixelOf(panned(camera, shift), beside), place + shift), 0.f, kPixelRounding);
  }
  EXPECT_GT(zoomed(kCamera, 1e-30f, {0.f, 0.f}).half_width, 0.f);
  EXPECT_TRUE(std::isfinite(zoomed(kCamera, 1e30f, {0.f, 0.f}).half_width));
}

TEST(Navigation, FindsTheGroundBeforeTheEyeAlone) {
  for (const float field_of_view : {0.f, 0.9f}) {
    Camera camera = kCamera;
    camera.field_of_view = field_of_view;
    const glm::vec3 point(2.f, 1.f, 0.5f);
    const auto met = groundAt(camera, *pixelOf(camera, point), 0.5f);
    ASSERT_TRUE(met);
    EXPECT_NEAR(glm::distance(*met, point), 0.f, 10.f * kRounding);  // the sight meets the ground at 17 degrees
    camera.elevation = 0.f;
    EXPECT_FALSE(groundAt(camera, {320.f, 240.f}, 0.f));  // level
    camera.elevation = -0.5f;                             // upwards from below
    EXPECT_EQ(groundAt(camera, {320.f, 240.f}, -4.f).has_value(), field_of_view == 0.f);
  }
  EXPECT_FALSE(pixelOf(kCamera, eyeOf(kCamera)));
  EXPECT_FALSE(pixelOf(kCamera, eyeOf(kCamera) - viewAxes(kCamera).along));
}

std::string refusal(std::string_view text) {
  try {
    parseScript(text, "x.txt");
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "none";
}

TEST(ViewScript, IsReadLineByLine) {
  const auto steps = parseScript(
      "# a comment\n\n  sun 45 -120  # low\r\nsun at 2026-06-21 12:00 50 8\ncompare wipe 0.5\nscreenshot \"a b#.png\"\n"
      "add 1 2.5e0 maple\nadd 1 2\nwait ready",
      "x.txt");
  ASSERT_EQ(steps.size(), 7u);
  EXPECT_EQ(steps[0].line, 3);
  EXPECT_EQ(steps[0].verb, Verb::sun);
  EXPECT_EQ(steps[0].numbers, (std::vector{45., -120.}));
  EXPECT_EQ(steps[1].verb, Verb::sun_at);
  EXPECT_EQ(steps[1].texts, (std::vector<std::string>{"2026-06-21", "12:00"}));
  EXPECT_EQ(steps[3].texts, std::vector<std::string>{"a b#.png"});
  EXPECT_EQ(steps[4].texts, std::vector<std::string>{"maple"});
  EXPECT_TRUE(steps[5].texts.empty());
  EXPECT_EQ(steps[6].verb, Verb::wait_ready);
  EXPECT_TRUE(parseScript("", "x.txt").empty());
}

TEST(ViewScript, TellsWhatIsWrongWhere) {
  EXPECT_EQ(refusal("sun 45 0\nsun 200 0\n"), "x.txt:2: sun ZENITH = \"200\": must be in [0, 180]");
  EXPECT_EQ(refusal("sun nan 0"), "x.txt:1: sun ZENITH = \"nan\": must be in [0, 180]");
  EXPECT_EQ(refusal("sun 1e999 0"), "x.txt:1: sun ZENITH = \"1e999\": must be in [0, 180]");
  EXPECT_EQ(refusal("sun 4x 0"), "x.txt:1: sun ZENITH = \"4x\": must be in [0, 180]");
  EXPECT_EQ(refusal("sun"), "x.txt:1: sun: has no ZENITH: must be in [0, 180]");
  EXPECT_EQ(refusal("undo 1 2"), "x.txt:1: undo \"2\": must be no word too many");
  EXPECT_EQ(refusal("resize 1.5 1"), "x.txt:1: resize WIDTH = \"1.5\": must be a whole number, 1 to 16384");
  EXPECT_EQ(refusal("panels maybe"), "x.txt:1: panels SHOWN = \"maybe\": must be one of on, off");
  EXPECT_EQ(refusal("frobnicate"), "x.txt:1: \"frobnicate\": must be a command; see: sunfleck view --help");
  EXPECT_EQ(refusal("wait long"), "x.txt:1: wait \"long\": must be one of ready, preview, reference");
  EXPECT_EQ(refusal("wait"), "x.txt:1: wait without a word: must be one of ready, preview, reference");
  EXPECT_EQ(refusal("leaf maps side x.png"),
            "x.txt:1: leaf maps IMAGE = \"side\": must be one of upper, upper_gloss, lower, lower_gloss");
  EXPECT_EQ(refusal("leaf lower roughness 0"), "x.txt:1: leaf lower roughness ROUGHNESS = \"0\": must be in [0.05, 1]");
  EXPECT_EQ(refusal("save \"half"), "x.txt:1: \"\"half\": must end with a quote");
  EXPECT_EQ(refusal("save \"\""), "x.txt:1: save FILE = \"\": must be 1 to 4096 characters");
}

TEST(ViewScript, OutlivesAnyBytes) {
  EXPECT_NE(refusal(std::string(1'000'001, ' ')), "none");
  EXPECT_NE(refusal(std::string(100'001, '\n') + "undo"), "none");
  EXPECT_LT(refusal(std::string(900'000, 'a')).size(), 200u);
  EXPECT_NE(refusal(std::string_view("sun\0 1 2", 8)), "none");
  Random random(3, 0);
  const std::string known = "sun at 4 5 camera orbit \"#\n wait ready undo screenshot ";
  for (int i = 0; i < 2000; ++i) {
    std::string text;
    for (int k = 0; k < 40; ++k)
      text += random.uniform() < 0.8f
                  ? known[static_cast<std::size_t>(random.uniform() * static_cast<float>(known.size()))]
                  : static_cast<char>(random.bits() & 255);
    const std::string message = refusal(text);  // InvalidInput or nothing
    EXPECT_TRUE(message == "none" || message.starts_with("x.txt:")) << message;
  }
}

TEST(ViewScript, IsToldInHelp) {
  for (const char* line : {"sun ZENITH AZIMUTH [IRRADIANCE]", "wait ready", "compare wipe SHARE", "undo [STEPS]"})
    EXPECT_NE(scriptHelp().find(line), std::string::npos) << line;
}

}  // namespace
}  // namespace sunfleck::view
