// Check that leaves cut out of cards by masks have the area and the light of leaves of that shape, and how masks are
// read from OBJ files.
#include "core/leaf_mask.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "core/random.hpp"
#include "core/require.hpp"
#include "plants/import.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "tests/leaf_shapes.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;
namespace fs = std::filesystem;

namespace {

// Leaf in the upper left and the lower right quarter.
const LeafMask kQuarters{.width = 2, .height = 2, .opaque = {1, 0, 0, 1}};

// A card whose corners are turned about as the image's: lower left, lower right, upper right, upper left.
void addCard(TreeMesh& mesh, const glm::vec3& centre, const glm::vec3& half_a, const glm::vec3& half_b) {
  addPolygon(mesh, mesh.leaf_triangles, rectangle(centre, half_a, half_b));
  const glm::vec2 low(0.f), right(1.f, 0.f), high(1.f), up(0.f, 1.f);
  for (const ImageCorners& corners : {ImageCorners{low, right, high}, ImageCorners{low, high, up}}) {
    mesh.patch_of_triangle.push_back(static_cast<std::uint32_t>(mesh.patches.size()));
    mesh.patches.push_back({corners, 0});
  }
}

struct Cards {
  TreeMesh masked, cut;
};

// Three cards, and the quarters that the mask leaves of them.
Cards cards() {
  Cards both;
  both.masked.masks.push_back(std::make_shared<const LeafMask>(kQuarters));
  Random random(3, 0);
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 centre(0.3f * static_cast<float>(i), 0.2f, 1.f + 0.25f * static_cast<float>(i));
    const Axes axes = axesAlong(onSphere(random));
    const glm::vec3 a = 0.3f * axes.right, b = 0.2f * axes.up;
    addCard(both.masked, centre, a, b);
    addPolygon(both.cut, both.cut.leaf_triangles, rectangle(centre - 0.5f * a + 0.5f * b, 0.5f * a, 0.5f * b));
    addPolygon(both.cut, both.cut.leaf_triangles, rectangle(centre + 0.5f * a - 0.5f * b, 0.5f * a, 0.5f * b));
  }
  finish(both.masked, "masked");
  finish(both.cut, "cut");
  return both;
}

class MaskedObj : public testing::Test {
 protected:
  fs::path write(const std::string& faces, const std::string& material) const {
    std::ofstream(folder_ / "t.mtl") << material;
    std::ofstream(folder_ / "t.obj") << "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                     << faces;
    return folder_ / "t.obj";
  }
  std::string refusal(const fs::path& path, const ImageReader& reader = {}) const {
    try {
      importTree(path, {}, reader);
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

const std::string kFace = "usemtl leaf\nf 1/1 2/2 3/3 4/4\n";

const ImportRules kMasked{.leaf = {}, .wood = {}, .cards = ImportRules::Cards::mask, .mesh = {}};

// The upper left and lower right quarters again, grey under an alpha that says otherwise or is 1 all over.
Image grey(float alpha) {
  return {.width = 2, .height = 2, .channels = {"Y", "A"}, .values = {.9f, alpha, .1f, 1.f, .2f, 1.f, .8f, 1.f}};
}

}  // namespace

// Check the share of a triangle that is leaf: quarters of a card, to rounding; any triangle of any mask against a count
// of points, to what these can tell; triangles that reach over many repeats.
TEST(LeafMask, SharesAreExact) {
  EXPECT_NEAR(opaqueShare(kQuarters, {glm::vec2(0, 0), {1, 0}, {1, 1}}), 0.5, 1e-12);
  EXPECT_NEAR(opaqueShare(kQuarters, {glm::vec2(0.5f, 0), {1, 0}, {1, 0.5f}}), 1., 1e-12);
  EXPECT_NEAR(opaqueShare(kQuarters, {glm::vec2(0, 0), {0.5f, 0}, {0.5f, 0.5f}}), 0., 1e-12);
  EXPECT_NEAR(opaqueShare(kQuarters, {glm::vec2(-3, -3), {5, -3}, {-3, 5}}), 0.5, 1e-12);
  Random random(5, 0);
  LeafMask mask{.width = 7, .height = 5, .opaque = {}};
  for (int i = 0; i < 35; ++i) mask.opaque.push_back(random.uniform() < 0.6f);
  for (int i = 0; i < 20; ++i) {
    ImageCorners corners;
    for (glm::vec2& c : corners) c = glm::vec2(3.f * random.uniform() - 1.f, 3.f * random.uniform() - 1.f);
    constexpr int kSteps = 300;
    int found = 0, all = 0;
    for (int a = 0; a < kSteps; ++a)
      for (int b = 0; a + b < kSteps - 1; ++b, ++all)
        found += mask.at(corners, (static_cast<float>(a) + 0.5f) / kSteps, (static_cast<float>(b) + 0.5f) / kSteps);
    // Some twenty edges of pixels cross the triangle; at each a row of points is off by one at most.
    EXPECT_NEAR(opaqueShare(mask, corners), static_cast<double>(found) / all, 0.01) << i;
  }
}

// Check a mesh with masks: the areas of its leaves are those of what is left, triangles that are cut away go, with
// their cuts, and wrong masks are refused.
TEST(LeafMask, MeshesHaveTheAreaThatIsLeft) {
  const Cards both = cards();
  EXPECT_NEAR(leafArea(both.masked), leafArea(both.cut), 1e-7);
  EXPECT_EQ(leafAreas(both.masked).size(), 3u);
  EXPECT_NEAR(leafAreas(both.masked)[0], 0.12, 1e-7);

  TreeMesh mesh;
  mesh.masks.push_back(std::make_shared<const LeafMask>(kQuarters));
  addCard(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.patches[1].corners = {glm::vec2(0.f), {0.4f, 0.4f}, {0.1f, 0.4f}};  // nothing of it is leaf
  TreeMesh half = mesh;
  EXPECT_EQ(finish(half, "half").leaf_triangles, 1u);
  EXPECT_EQ(half.patch_of_triangle.size(), 1u);
  EXPECT_NEAR(leafArea(half), 1., 1e-12);  // half of a triangle of 2 m^2
  TreeMesh wrong = mesh;
  wrong.patches[0].mask = 1;
  EXPECT_THROW(finish(wrong, "wrong"), InvalidInput);
  wrong = mesh;
  wrong.patches[0].corners[1].x = std::nanf("");
  EXPECT_THROW(finish(wrong, "wrong"), InvalidInput);
  wrong = mesh;
  wrong.patches[0].corners = {glm::vec2(0.f), {1, 1}, {0.5f, 0.5f}};
  EXPECT_THROW(finish(wrong, "wrong"), InvalidInput);
  wrong = mesh;
  wrong.patch_of_triangle.pop_back();
  EXPECT_THROW(finish(wrong, "wrong"), InvalidInput);
}

// Check rays: masked cards and cards of that shape are the same to the light from the sun and to the leaves, repeated
// and turned, within five of the errors of both; to a camera, by the same rays; and lines cross them as often.
TEST(LeafMask, CardsAreLitAsIfTheyWereCut) {
  const Cards both = cards();
  // The cards' corners that the mask cuts away count in the box, through which the sun comes in: a period makes them
  // one.
  for (const bool turned : {false, true}) {
    Stand stand{.period = glm::vec2(2.f, 1.5f)};
    if (turned) stand.trees = {{.position = {0.f, 0.f, 0.f}, .rotation = 1.f}, {.position = {1.f, 0.5f, 0.2f}}};
    const RayScene masked(both.masked, stand, true), cut(both.cut, stand, true);
    const TraceLight light{.sun = sunlight(0.6f, 1.f), .leaf = {0.4f, 0.5f}, .ground_albedo = 0.3f};
    const ForwardResult a = traceForward(masked, light, {.paths = 40'000}),
                        b = traceForward(cut, light, {.paths = 40'000, .seed = 2});
    const auto near = [](const Estimate& x, const Estimate& y, const char* what) {
      EXPECT_NEAR(x.value, y.value, 5. * std::hypot(x.standard_error, y.standard_error)) << what;
    };
    near(a.reflected, b.reflected, "reflected");
    near(a.absorbed_leaves, b.absorbed_leaves, "absorbed");
    near(a.arriving_ground_direct, b.arriving_ground_direct, "direct");
    for (std::size_t card = 0; card < 3; ++card) {
      const Estimate whole{a.leaf_irradiance[card], a.leaf_standard_error[card]};
      const Estimate halves{0.5 * (b.leaf_irradiance[2 * card] + b.leaf_irradiance[2 * card + 1]),
                            0.5 * std::hypot(b.leaf_standard_error[2 * card], b.leaf_standard_error[2 * card + 1])};
      near(whole, halves, "irradiance");
    }
  }

  // From the camera the same samples: a picture in packets of rays, with shadows.
  const RayScene masked(both.masked, Stand{}, true), cut(both.cut, Stand{}, true);
  const TraceLight light{.sun = sunlight(0.6f, 1.f), .leaf = {0.4f, 0.5f}};
  const PixelRays rays{.corner = {-0.5f, 0.7f, 3.f},
                       .right_step = {0.03f, 0.f, 0.f},
                       .down_step = {0.f, -0.03f, 0.f},
                       .sight = {0.f, 0.f, -1.f},
                       .width = 40,
                       .height = 40};
  const CameraResult a = traceCamera(masked, light, rays, 0.f, {.paths = 25'600});
  const CameraResult b = traceCamera(cut, light, rays, 0.f, {.paths = 25'600});
  EXPECT_GT(b.mean.value, 0.005);
  int differing = 0;
  for (std::size_t i = 0; i < a.radiance.values.size(); i += 2)
    differing += std::abs(a.radiance.values[i + 1] - b.radiance.values[i + 1]) > 1e-5f;
  EXPECT_LE(differing, 16);  // pixels of 1600: of light scattered once, whose rays are the same but for rounding

  Random random(9, 0);
  int crossed = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 from(random.uniform() * 1.4f - 0.4f, random.uniform() - 0.3f, 3.f);
    const glm::vec3 direction = glm::normalize(glm::vec3(0.2f * random.uniform(), 0.1f, -1.f));
    const int of_cards = masked.crossings(from, direction), of_shapes = cut.crossings(from, direction);
    // The two quarters of a card are two leaves, and no line but through the middle meets both.
    EXPECT_EQ(of_cards, of_shapes) << i;
    crossed += of_cards;
  }
  EXPECT_GT(crossed, 100);
}

// Check what an OBJ's material says of its opacity: alpha where it is not 1 all over, else brightness, times d; in
// which corner of the face which corner of the image lies.
TEST_F(MaskedObj, ReadsTheMask) {
  const fs::path path = write(kFace, "newmtl leaf\nmap_d mask.png\n");
  fs::path asked;
  const auto reader = [&](float alpha) {
    return [&asked, alpha](const fs::path& image, std::string_view) {
      asked = image;
      return grey(alpha);
    };
  };
  const ImportedTree tree = importTree(path, kMasked, reader(1.f));
  EXPECT_EQ(asked, folder_ / "mask.png");
  ASSERT_EQ(tree.mesh.masks.size(), 1u);
  EXPECT_EQ(tree.mesh.masks[0]->opaque, kQuarters.opaque);
  EXPECT_NE(tree.how.find("cut out by masks"), std::string::npos) << tree.how;
  EXPECT_NEAR(leafArea(tree.mesh), 0.5, 1e-12);
  ASSERT_EQ(tree.mesh.patches.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)  // this square's coordinates are its corners
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_EQ(tree.mesh.patches[i].corners[corner],
                glm::vec2(tree.mesh.vertices[tree.mesh.leaf_triangles[i][static_cast<int>(corner)]]));
  EXPECT_NEAR(leafArea(importTree(path, kMasked, reader(0.f)).mesh), 0.75, 1e-12);

  write(kFace, "newmtl leaf\nd 0.6\nmap_d mask.png\n");  // .6 of .8 is not half
  EXPECT_NEAR(leafArea(importTree(path, kMasked, reader(1.f)).mesh), 0.25, 1e-12);
}

// Check what is refused, each in one line: masks where nobody reads them, images moved by options, faces without
// texture coordinates, a mask that leaves nothing; and that faces of transparent materials are left out and told.
TEST_F(MaskedObj, RefusesWhatItCannotCut) {
  const ImageReader reader = [](const fs::path&, std::string_view) { return grey(1.f); };
  const std::string masked = "newmtl leaf\nmap_d mask.png\n";
  EXPECT_NE(refusal(write(kFace, masked)).find("no images are read here"), std::string::npos);
  EXPECT_NE(refusal(write(kFace, "newmtl leaf\nmap_d -o 0.5 0 0 mask.png\n"), reader).find("must be without -s and -o"),
            std::string::npos);
  const std::string bare = refusal(write("usemtl leaf\nf 1 2 3 4\n", masked), reader);
  EXPECT_NE(bare.find("texture coordinate"), std::string::npos) << bare;
  EXPECT_NE(refusal(write("usemtl leaf\nf 1/9 2/2 3/3 4/4\n", masked), reader).find("texture coordinate"),
            std::string::npos);
  EXPECT_NE(refusal(write(kFace, "newmtl leaf\nd 0.1\nmap_d mask.png\n"), reader).find("must have leaf somewhere"),
            std::string::npos);

  const fs::path two = write(kFace + "usemtl leaf_ghost\nf 1 2 3\n", "newmtl leaf\nnewmtl leaf_ghost\nd 0.2\n");
  const ImportedTree tree = importTree(two);
  EXPECT_EQ(tree.mesh.leaf_triangles.size(), 2u);
  EXPECT_TRUE(tree.mesh.masks.empty());
  EXPECT_NE(tree.how.find("left out 1 leaf triangles"), std::string::npos) << tree.how;
}
