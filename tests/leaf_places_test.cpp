// Check that leaves know where they lie in their images: as they are grown, as files bring them and as they are
// written.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>

#include "plants/import.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/write_gltf.hpp"
#include "plants/write_obj.hpp"
#include "plants/write_ply.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

class LeafPlaces : public testing::Test {
 protected:
  TreeMesh read(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return importTree(folder_ / name).mesh;
  }

  TemporaryFolder folder_;
};

double twiceArea(const ImageCorners& c) {
  const glm::dvec2 a = glm::dvec2(c[1]) - glm::dvec2(c[0]), b = glm::dvec2(c[2]) - glm::dvec2(c[0]);
  return a.x * b.y - a.y * b.x;
}

glm::dvec3 normalOf(const TreeMesh& mesh, std::size_t triangle) {
  const glm::uvec3& t = mesh.leaf_triangles[triangle];
  const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
  return glm::cross(b - a, c - a);
}

// The farthest that any corner lies from its place in another mesh's images.
float farthest(const TreeMesh& a, const TreeMesh& b) {
  float most = a.leaf_triangles.size() == b.leaf_triangles.size() ? 0.f : 1e9f;
  for (std::size_t i = 0; i < std::min(a.leaf_triangles.size(), b.leaf_triangles.size()); ++i) {
    const LeafPatch *const p = patchOf(a, i), *const q = patchOf(b, i);
    if (!p != !q) return 1e9f;
    for (std::size_t c = 0; p && c < 3; ++c) most = std::max(most, glm::distance(p->corners[c], q->corners[c]));
  }
  return most;
}

WeberPenn upright(LeafShape shape) {
  WeberPenn p;
  p.scale = 10.f;
  p.levels = 1;
  p.ratio = 0.002f;
  p.leaves = 40;
  p.leaf_scale = 0.1f;
  p.leaf_shape = shape;
  p.leaf_bend = 1.f;
  p.level[0].length = 1.f;
  p.level[0].curve_res = 5;
  return p;
}

}  // namespace

// Check grown leaves of each shape, turned to the light: their upper sides are up; corners turn counter-clockwise in
// the images too, within which they lie; the area that they take there is their outline's, of which images show the
// box.
TEST_F(LeafPlaces, GrownLeavesLieInTheirImages) {
  for (const LeafShape shape : leafShapes())
    for (const float curl : {0.f, 80.f}) {
      WeberPenn parameters = upright(shape);
      parameters.leaf_curl = curl;
      const TreeMesh tree = grow(parameters, 1);
      ASSERT_EQ(tree.patch_of_triangle.size(), tree.leaf_triangles.size());
      EXPECT_LT(tree.patches.size(), 200u);
      double up = 0., area = 0.;
      for (std::size_t i = 0; i < tree.leaf_triangles.size(); ++i) {
        up += normalOf(tree, i).z;
        const LeafPatch* const patch = patchOf(tree, i);
        ASSERT_TRUE(patch != nullptr) << nameOf(shape);
        EXPECT_GT(twiceArea(patch->corners), 0.) << nameOf(shape);
        EXPECT_TRUE(curl != 0.f || normalOf(tree, i).z > 0.) << nameOf(shape);
        area += 0.5 * twiceArea(patch->corners);
        for (const glm::vec2& corner : patch->corners)
          for (int axis = 0; axis < 2; ++axis) {
            EXPECT_GE(corner[axis], 0.f);
            EXPECT_LE(corner[axis], 1.f);
          }
      }
      EXPECT_GT(up, 0.);
      double low = 0.;
      for (const glm::dvec2& p : halfOutline(shape)) low = std::min(low, p.y);
      EXPECT_NEAR(area / tree.leaf_count, areaShare(shape) / (1. - low), 1e-6) << nameOf(shape);  // floats
    }
}

// Check which way images lie on a leaf: u to the right seen from above with the tip ahead, v towards the tip.
TEST_F(LeafPlaces, ImagesLieOnTheUpperSide) {
  const TreeMesh tree = grow(upright(LeafShape::rectangle), 1);
  for (std::size_t i = 0; i < tree.leaf_triangles.size(); ++i) {
    const glm::uvec3& t = tree.leaf_triangles[i];
    const ImageCorners& c = patchOf(tree, i)->corners;
    const glm::dvec3 a = tree.vertices[t.x], b = glm::dvec3(tree.vertices[t.y]) - a,
                     d = glm::dvec3(tree.vertices[t.z]) - a;
    const glm::dvec2 of_b = glm::dvec2(c[1]) - glm::dvec2(c[0]), of_d = glm::dvec2(c[2]) - glm::dvec2(c[0]);
    const double determinant = of_b.x * of_d.y - of_b.y * of_d.x;
    const glm::dvec3 along_u = (of_d.y * b - of_b.y * d) / determinant,
                     along_v = (of_b.x * d - of_d.x * b) / determinant;
    EXPECT_NEAR(glm::length(along_v), 0.1, 1e-5);
    EXPECT_GT(glm::cross(along_u, along_v).z, 0.);
    // Leaves point away from the trunk's axis, from the base on.
    const glm::dvec3 tip = a - double{c[0].y} * along_v + along_v, base = tip - along_v;
    EXPECT_GT(glm::length(glm::dvec2(tip)), glm::length(glm::dvec2(base)));
  }
}

// Check that blossoms show no images, and that the leaves beside them do.
TEST_F(LeafPlaces, BlossomsHaveNone) {
  WeberPenn parameters = upright(LeafShape::ovate);
  parameters.blossom_rate = 0.5f;
  const TreeMesh tree = grow(parameters, 1);
  const auto none = std::ranges::count(tree.patch_of_triangle, TreeMesh::kNoPatch);
  EXPECT_GT(none, 0);
  EXPECT_LT(none, static_cast<std::ptrdiff_t>(tree.patch_of_triangle.size()));
}

// Check that places come back from each format: the same of OBJ and PLY; of glTF, whose v points down, within the
// rounding of 1 - v, 2^-24. Blossoms come back without.
TEST_F(LeafPlaces, ComeBackFromFiles) {
  WeberPenn parameters = upright(LeafShape::maple);
  parameters.blossom_rate = 0.3f;
  for (const TreeMesh& tree : {grow(parameters, 2), randomCrown({.leaves = 50}, 1)}) {
    writeObj(folder_ / "tree.obj", tree);
    EXPECT_EQ(farthest(importTree(folder_ / "tree.obj").mesh, tree), 0.f);
    writePly(folder_ / "tree.ply", tree);
    EXPECT_EQ(farthest(importTree(folder_ / "tree.ply").mesh, tree), 0.f);
    for (const char* name : {"tree.glb", "tree.gltf"}) {
      writeGltf(folder_ / name, tree);
      const TreeMesh read = importTree(folder_ / name).mesh;
      EXPECT_LE(farthest(read, tree), 6e-8f) << name;
      EXPECT_EQ(read.vertices.size(), tree.vertices.size()) << name;
      EXPECT_LE(read.patches.size(), tree.patches.size()) << name;  // shared, and without those of blossoms alone
    }
  }
}

// Check a vertex whose triangles lie apart in the image: written once for each place where the format needs it, and
// still one leaf of the same area.
TEST_F(LeafPlaces, SeamsComeBack) {
  const TreeMesh tree = read("seam.obj",
                             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.2 0.3\nvt 0.5 0.5\nvt 0 "
                             "0.9\ng leaf\nf 1/1 2/2 3/3\nf 1/4 3/5 4/6\n");
  ASSERT_EQ(tree.vertices.size(), 4u);
  writePly(folder_ / "t.ply", tree);
  writeGltf(folder_ / "t.glb", tree);
  for (const char* name : {"t.ply", "t.glb"}) {
    const TreeMesh back = importTree(folder_ / name).mesh;
    EXPECT_EQ(back.vertices.size(), 6u) << name;
    EXPECT_EQ(back.leaf_count, 1u) << name;
    EXPECT_LE(farthest(back, tree), 6e-8f) << name;
    EXPECT_DOUBLE_EQ(leafArea(back), leafArea(tree)) << name;
  }
}

// Check the names that programs give texture coordinates in PLY, and that what is of no use is left out; files without
// places are written as they always were.
TEST_F(LeafPlaces, PlyNamesAndFilesWithout) {
  const auto ply = [](const std::string& names, const std::string& last) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + names +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 " + last +
           "\n3 0 1 2\n";
  };
  for (const std::string first : {"s", "u", "texture_u"}) {
    const std::string second = first == "s" ? "t" : first == "u" ? "v" : "texture_v";
    const TreeMesh tree = read("t.ply", ply("property float " + first + "\nproperty float " + second + "\n", "0 1"));
    ASSERT_EQ(tree.patches.size(), 1u) << first;
    EXPECT_EQ(patchOf(tree, 0)->corners, (ImageCorners{glm::vec2(0.f), {1.f, 0.f}, {0.f, 1.f}})) << first;
  }
  for (const std::string last : {"nan 1", "1e30 1", "2 0"})
    EXPECT_EQ(patchOf(read("t.ply", ply("property double s\nproperty double t\n", last)), 0), nullptr) << last;
  const TreeMesh plain = read("t.ply", ply("property float s\nproperty float quality\n", "0 1"));
  EXPECT_TRUE(plain.patch_of_triangle.empty());
  writeObj(folder_ / "plain.obj", plain);
  writePly(folder_ / "plain.ply", plain);
  writeGltf(folder_ / "plain.gltf", plain);
  const auto holds = [&](const char* name, const char* part) {
    std::ifstream in(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {}).find(part) != std::string::npos;
  };
  EXPECT_FALSE(holds("plain.obj", "vt ") || holds("plain.obj", "/"));
  EXPECT_FALSE(holds("plain.ply", "float s"));
  EXPECT_FALSE(holds("plain.gltf", "TEXCOORD"));
}

// Check that a node that mirrors keeps the upper side of leaves up: glTF's corners then turn about the other way.
TEST_F(LeafPlaces, MirroredNodesKeepTheUpperSide) {
  const std::string head =
      R"({"asset":{"version":"2.0"},"scene":0,"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/"}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0}}]}],"scenes":[{"nodes":[0]}],"nodes":[)";
  const TreeMesh plain = read("p.gltf", head + R"({"mesh":0}]})");
  const TreeMesh mirrored = read("m.gltf", head + R"({"mesh":0,"scale":[-1,1,1]}]})");
  EXPECT_EQ(normalOf(plain, 0), normalOf(mirrored, 0));
}
