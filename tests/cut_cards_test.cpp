// Check how leaves are cut out of cards: outlines of masks, their triangles, and cards of an OBJ and a glTF.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"
#include "plants/detail/leaf_grouping.hpp"
#include "plants/detail/mask_outline.hpp"
#include "plants/detail/mask_triangles.hpp"
#include "plants/import.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
using namespace sunfleck::detail;
namespace fs = std::filesystem;

namespace {

// A mask of what a function says is leaf, of the middles of pixels, 0 .. 1.
template <typename IsLeaf>
LeafMask maskOf(int side, const IsLeaf& is_leaf) {
  LeafMask mask{.width = side, .height = side, .opaque = {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      mask.opaque.push_back(is_leaf((static_cast<double>(x) + 0.5) / side, (static_cast<double>(y) + 0.5) / side));
  return mask;
}

double shareOf(const LeafMask& mask) {
  double count = 0.;
  for (const std::uint8_t pixel : mask.opaque) count += pixel;
  return count / static_cast<double>(mask.opaque.size());
}

double areaOf(const MaskTriangles& cut) {
  double area = 0.;
  for (const glm::uvec3& t : cut.triangles) {
    const glm::dvec2 a = cut.corners[t.x], b = cut.corners[t.y], c = cut.corners[t.z];
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    EXPECT_GT(twice, -1e-15);  // a flat one of rounding does no harm
    area += 0.5 * twice;
  }
  return area;
}

double squared(double x) {
  return x * x;
}

bool isDisc(double x, double y) {
  return squared(x - 0.5) + squared(y - 0.5) < squared(0.4);
}
bool isRing(double x, double y) {
  return isDisc(x, y) && squared(x - 0.5) + squared(y - 0.5) > squared(0.2);
}
// Lobes about a middle with holes in it, and an island in the largest hole.
bool isTorn(double x, double y) {
  const double angle = std::atan2(y - 0.5, x - 0.5), radius = std::hypot(x - 0.5, y - 0.5);
  if (radius < 0.06) return true;
  if (radius < 0.1 || radius > 0.3 + 0.12 * std::sin(9. * angle)) return false;
  return squared(x - 0.5) + squared(y - 0.68) > squared(0.03) && squared(x - 0.31) + squared(y - 0.5) > squared(0.04);
}

class Cards : public testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& content) const { return folder_.write(name, content); }

  // Two cards of 2 x 1 m with the whole image and its lower left quarter, one of them bent along its diagonal.
  fs::path cards(const std::string& material) const {
    file("t.mtl", material);
    return file("t.obj",
                "mtllib t.mtl\nusemtl leaf\nv 0 0 0\nv 2 0 0\nv 2 0 1\nv 0 0 1\nv 0 3 0\nv 2 3 0\nv 2 3.5 1\nv 0 3 1\n"
                "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt .5 0\nvt .5 .5\nvt 0 .5\n"
                "f 1/1 2/2 3/3 4/4\nf 5/1 6/5 7/6\nf 5/1 7/6 8/7\n");
  }

  TemporaryFolder folder_;
};

ImageReader readerOf(const LeafMask& mask) {
  return [mask](const fs::path&, std::string_view) {
    Image image{.width = mask.width, .height = mask.height, .channels = {"R", "G", "B", "A"}, .values = {}};
    for (const std::uint8_t pixel : mask.opaque)
      image.values.insert(image.values.end(), {0.2f, 0.4f, 0.1f, static_cast<float>(pixel)});
    return image;
  };
}

}  // namespace

// Check outlines: areas of all add up to the pixels' number exactly, pixels that touch at corners are apart, holes
// count below zero; simplified, an outline keeps its area to rounding.
TEST(MaskOutline, AreasAreThoseOfThePixels) {
  const LeafMask checks{.width = 2, .height = 2, .opaque = {1, 0, 0, 1}};
  EXPECT_EQ(outlinesOf(checks).size(), 2u);
  const LeafMask hole{.width = 3, .height = 3, .opaque = {1, 1, 1, 1, 0, 1, 1, 1, 1}};
  ASSERT_EQ(outlinesOf(hole).size(), 2u);
  EXPECT_EQ(signedArea(outlinesOf(hole)[0]), 9.);
  EXPECT_EQ(signedArea(outlinesOf(hole)[1]), -1.);
  EXPECT_EQ(outlinesOf(hole)[0].size(), 4u);
  Random random(1, 0);
  LeafMask noise{.width = 40, .height = 30, .opaque = {}};
  for (int i = 0; i < 1200; ++i) noise.opaque.push_back(random.uniform() < 0.5f);
  double area = 0.;
  for (const Outline& outline : outlinesOf(noise)) area += signedArea(outline);
  EXPECT_EQ(area, 1200. * shareOf(noise));
  std::vector<Outline> torn = outlinesOf(maskOf(200, isTorn));
  const std::vector<Outline> exact = torn;
  simplify(torn, 3.);
  for (std::size_t i = 0; i < torn.size(); ++i) {
    EXPECT_NEAR(signedArea(torn[i]), signedArea(exact[i]), 1e-9 * std::abs(signedArea(exact[i])));
    EXPECT_LT(torn[i].size(), 200u);
  }
}

// Check triangles of masks with holes and islands: their area is the mask's within 1 %, for small and large images, by
// a few hundred triangles.
TEST(MaskTriangles, KeepTheArea) {
  for (const int side : {24, 100, 512})
    for (const auto& is_leaf : {isDisc, isRing, isTorn}) {
      const LeafMask mask = maskOf(side, is_leaf);
      const MaskTriangles cut = trianglesOf(mask, "mask");
      EXPECT_NEAR(areaOf(cut) / shareOf(mask), 1., 0.01) << side;
      EXPECT_LT(cut.triangles.size(), 400u) << side;
    }
  EXPECT_THROW(trianglesOf(maskOf(8, [](double, double) { return false; }), "mask"), InvalidInput);
  const MaskTriangles whole = trianglesOf(maskOf(8, [](double, double) { return true; }), "mask");
  EXPECT_EQ(whole.triangles.size(), 2u);
  EXPECT_NEAR(areaOf(whole), 1., 1e-12);
  // Noise is torn into more specks than triangles are made of: it is refused in words, or cut with its area.
  Random random(2, 0);
  LeafMask noise{.width = 300, .height = 300, .opaque = {}};
  for (int i = 0; i < 90'000; ++i) noise.opaque.push_back(random.uniform() < 0.5f);
  try {
    trianglesOf(noise, "mask");
  } catch (const InvalidInput& e) {
    EXPECT_NE(std::string(e.what()).find("too torn"), std::string::npos);
  }
}

// Check cards of an OBJ: area before and after; a card is a leaf, cut or masked; no triangle is cut along the edge
// within a flat card; the alpha of map_Kd cuts as map_d does; "whole" cuts nothing.
TEST_F(Cards, ObjIsCut) {
  const LeafMask disc = maskOf(128, isDisc);
  const ImageReader reader = readerOf(disc);
  const fs::path path = cards("newmtl leaf\nmap_Kd my card.png\nmap_d my card.png\n");
  const ImportedTree cut = importTree(path, {}, reader);
  // Half the cross products of the second card's edges, which is bent along its diagonal.
  EXPECT_NEAR(cut.card_area, 2. + 0.5 * std::sqrt(5.) + 0.5 * std::sqrt(4.25), 1e-6);
  const ImportRules masked{.leaf = {}, .wood = {}, .cards = ImportRules::Cards::mask, .mesh = {}};
  const ImportedTree exact = importTree(path, masked, reader);
  EXPECT_EQ(exact.card_area, cut.card_area);
  EXPECT_NEAR(cut.cut_area / exact.cut_area, 1., 0.01);
  EXPECT_NEAR(leafArea(exact.mesh), exact.cut_area, 1e-12);
  EXPECT_EQ(cut.mesh.leaf_count, 2u);
  EXPECT_TRUE(cut.mesh.masks.empty());
  EXPECT_LT(cut.mesh.leaf_triangles.size(), 250u);
  EXPECT_NE(cut.how.find("cut out of cards"), std::string::npos);
  const ImportedTree whole =
      importTree(path, {.leaf = {}, .wood = {}, .cards = ImportRules::Cards::whole, .mesh = {}}, {});
  EXPECT_EQ(whole.mesh.leaf_triangles.size(), 4u);
  EXPECT_EQ(whole.card_area, 0.);

  file("card.png", "not read by this test");
  const fs::path by_colour = cards("newmtl leaf\nmap_Kd C:\\textures\\card.png\n");
  EXPECT_NEAR(importTree(by_colour, {}, reader).cut_area, cut.cut_area, 1e-12);
  const LeafMask full = maskOf(8, [](double, double) { return true; });
  EXPECT_EQ(importTree(by_colour, {}, readerOf(full)).card_area, 0.);  // no alpha, no cards
}

// Check a glTF card: alphaMode MASK with its cutoff, an image in the file, v down, an image that is moved and turned.
TEST_F(Cards, GltfIsCut) {
  // Corners (0 0 0), (1 0 0), (0 1 0) with texture coordinates (0 0), (1 0), (0 1).
  const std::string buffer =
      R"("buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],)";
  const auto model = [&](const std::string& mode, const std::string& texture, const std::string& image) {
    return R"({"asset":{"version":"2.0"},"scene":0,)" + buffer +
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],)"
           R"("materials":[{"name":"leaf",)" +
           mode + R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0)" + texture + R"(}}}],)" +
           R"("textures":[{"source":0}],"images":[)" + image + R"(],"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}]})";
  };
  // Leaf is the left half of the image with an alpha of .6, and its upper right quarter with .3.
  std::string asked;
  std::size_t asked_bytes = 0;
  const ImageReader reader = [&](const fs::path& name, std::string_view bytes) {
    asked = name.filename().string();
    asked_bytes = bytes.size();
    return Image{.width = 2, .height = 2, .channels = {"Y", "A"}, .values = {1, .6f, 1, .3f, 1, .6f, 1, 0}};
  };
  const auto areaOf = [&](const std::string& mode, const std::string& texture = "",
                          const std::string& image = R"({"uri":"my%20leaf.png"})") {
    return importTree(file("t.gltf", model(mode, texture, image)), {}, reader).cut_area;
  };
  const std::string mask = R"("alphaMode":"MASK",)";
  // Of the triangle (0 0), (1 0), (0 1), v down, the left half has three eighths, the upper right quarter one.
  EXPECT_NEAR(areaOf(mask), 0.375, 1e-6);
  EXPECT_EQ(asked, "my leaf.png");
  EXPECT_NEAR(areaOf(mask + R"("alphaCutoff":0.25,)"), 0.5, 1e-6);
  EXPECT_NEAR(areaOf(R"("alphaMode":"BLEND",)"), 0.375, 1e-6);
  EXPECT_EQ(areaOf(""), 0.);  // opaque
  // Moved by half the image to the right: the right half of the image, without leaf, comes first.
  EXPECT_NEAR(areaOf(mask, R"(,"extensions":{"KHR_texture_transform":{"offset":[0.5,0]}})"), 0.125, 1e-6);
  EXPECT_NEAR(areaOf(mask, R"(,"extensions":{"KHR_texture_transform":{"scale":[0.5,0.5]}})"), 0.5, 1e-6);
  // By the extension's matrix u is then that of -v: the image repeated to the left, of which its right half is next.
  EXPECT_NEAR(areaOf(mask, R"(,"extensions":{"KHR_texture_transform":{"rotation":1.5707963267948966}})"), 0.125, 1e-6);
  EXPECT_NEAR(areaOf(mask, "", R"({"uri":"data:image/png;base64,iVBORw0KGgo="})"), 0.375, 1e-6);
  EXPECT_EQ(asked, "image.png");
  EXPECT_EQ(asked_bytes, 8u);
  EXPECT_THROW(areaOf(mask, "", R"({"uri":"data:image/png;base64,AAAA"})"), InvalidInput);
  EXPECT_THROW(importTree(file("t.gltf", model(mask, "", R"({"uri":"leaf.png"})"))), InvalidInput);  // no reader
  const auto refusedWith = [&](const std::string& part, const std::string& other) {
    std::string text = model(mask, "", R"({"uri":"leaf.png"})");
    text.replace(text.find(part), part.size(), other);
    try {
      importTree(file("t.gltf", text), {}, reader);
    } catch (const InvalidInput& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto names = [](const std::string& message, const char* what) {
    return message.find(what) != std::string::npos;
  };
  EXPECT_TRUE(names(refusedWith("VEC2", "SCALAR"), "TEXCOORD: type"));
  EXPECT_TRUE(names(refusedWith(R"({"mesh":0})", R"({"mesh":0,"rotation":[3,4,5,6]})"), "length of a rotation"));
  EXPECT_TRUE(names(refusedWith(R"({"mesh":0})", R"({"mesh":0,"matrix":[1,0,0]})"), "numbers of a node's matrix"));
}

// Check leaves: triangles with corners of their own that share an edge's places are one leaf, a touch at one place does
// not join; two sides of a leaf count once.
TEST(LeafGrouping, LeavesAreOneObject) {
  TreeMesh mesh;
  // A square of two triangles with six corners, its other side, and a triangle that touches one of its corners.
  mesh.vertices = {{0, 0, 0},    {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0},
                   {-0.f, 1, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}};
  mesh.leaf_triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {2, 1, 0}, {9, 10, 11}};
  EXPECT_EQ(groupLeaves(mesh), 2u);
  EXPECT_EQ(mesh.leaf_triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}, {9, 10, 11}}));
  EXPECT_EQ(mesh.leaf_of_triangle, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(mesh.leaf_count, 2u);
  finish(mesh, "mesh");
  EXPECT_EQ(mesh.leaf_of_triangle, (std::vector<std::uint32_t>{0, 0, 1}));  // finish() keeps what was told
  EXPECT_EQ(mesh.leaf_count, 2u);
}
