#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/require.hpp"
#include "plants/import.hpp"
#include "plants/species.hpp"
#include "plants/write_gltf.hpp"
#include "plants/write_obj.hpp"
#include "plants/write_ply.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

class TreeFiles : public testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& content) const { return folder_.write(name, content); }

  std::string contentOf(const fs::path& path) const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  // The message that reading this text as a .gltf ends with, without the folder; empty when it succeeds.
  std::string refusal(const std::string& text, const std::string& name = "t.gltf") const {
    try {
      importTree(file(name, text));
    } catch (const InvalidInput& e) {
      std::string message = e.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      const std::string prefix = folder_.string() + "/" + name + ": ";
      EXPECT_TRUE(message.starts_with(prefix)) << message;
      return message.substr(std::min(message.size(), prefix.size()));
    }
    return "";
  }

  TemporaryFolder folder_;
};

bool same(const TreeMesh& a, const TreeMesh& b) {
  return a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(glm::vec3)) == 0 &&
         a.leaf_triangles == b.leaf_triangles && a.wood_triangles == b.wood_triangles &&
         a.leaf_of_triangle == b.leaf_of_triangle && a.leaf_count == b.leaf_count;
}

// A triangle in the file's plane y = 0, of which two sides are 1 long; 36 bytes of positions.
const std::string kTriangle =
    R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/"}],)"
    R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)";
std::string gltf(const std::string& rest) {
  return R"({"asset":{"version":"2.0"},"scene":0,)" + kTriangle + rest + "}";
}
const std::string kMesh = R"("meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0}}]}],)";
const std::string kOneNode = R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";

}  // namespace

// Check that trees of plain and of shaped leaves, with petioles and blossoms, come back from each format as the same
// mesh, bit for bit, and so with the same area and the same number of leaves.
TEST_F(TreeFiles, ComeBackTheSame) {
  WeberPenn young = species("apple");
  young.level[1].branches = 8;
  young.level[2].branches = 6;
  for (const TreeMesh& tree : {grow(species("cherry"), 2), grow(young, 3)}) {
    writePly(folder_ / "tree.ply", tree);
    EXPECT_TRUE(same(importTree(folder_ / "tree.ply").mesh, tree));
    writeObj(folder_ / "tree.obj", tree);
    EXPECT_TRUE(same(importTree(folder_ / "tree.obj").mesh, tree));
    for (const char* name : {"tree.glb", "tree.gltf"}) {
      writeGltf(folder_ / name, tree);
      const ImportedTree read = importTree(folder_ / name);
      EXPECT_TRUE(same(read.mesh, tree)) << name;
      EXPECT_EQ(leafArea(read.mesh), leafArea(tree)) << name;
      EXPECT_EQ(read.how, "by the names in the file") << name;
    }
  }
}

// Check what a written glTF tells other programs: the extensions, two-sided leaves whose reflectance (1 - t) base and
// transmittance t colour are those of a green leaf, and instances of a stand.
TEST_F(TreeFiles, GltfNamesItsExtensions) {
  const TreeMesh tree = grow(species("cherry"), 1);
  writeGltf(folder_ / "one.gltf", tree);
  const std::string one = contentOf(folder_ / "one.gltf");
  for (const char* part : {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", "\"doubleSided\":true",
                           "\"name\":\"leaf\"", "\"name\":\"wood\"", "\"min\"", "\"max\""})
    EXPECT_NE(one.find(part), std::string::npos) << part;
  EXPECT_EQ(one.find("EXT_mesh_gpu_instancing"), std::string::npos);
  const TreeMesh* const kind = &tree;
  writeGltf(folder_ / "many.gltf", {&kind, 1}, {.trees = {Placement{}, {.position = {9.f, 0.f, 0.f}}}});
  EXPECT_NE(contentOf(folder_ / "many.gltf").find("EXT_mesh_gpu_instancing"), std::string::npos);
}

// Check that a stand comes back where its trees stand: each vertex of a tree that is turned by a quarter and moved is
// where that puts it, within the rounding of floats of up to 20 m; and that kinds of one tree and of several both do.
TEST_F(TreeFiles, StandsComeBackInTheirPlaces) {
  const TreeMesh cherry = grow(species("cherry"), 1), maple = grow(species("maple"), 1);
  const std::array<const TreeMesh*, 2> kinds{&cherry, &maple};
  const float quarter = std::numbers::pi_v<float> / 2.f;
  const Stand stand{.trees = {{.position = {1.f, 2.f, 0.f}, .kind = 0},
                              {.position = {-10.f, 5.f, 0.5f}, .rotation = quarter, .kind = 1},
                              {.position = {8.f, -3.f, 0.f}, .rotation = quarter, .kind = 0}}};
  writeGltf(folder_ / "stand.glb", kinds, stand);
  const TreeMesh read = importTree(folder_ / "stand.glb").mesh;
  EXPECT_EQ(read.leaf_count, 2 * cherry.leaf_count + maple.leaf_count);
  EXPECT_NEAR(leafArea(read) / (2. * leafArea(cherry) + leafArea(maple)), 1., 1e-5);
  ASSERT_EQ(read.vertices.size(), 2 * cherry.vertices.size() + maple.vertices.size());
  // Kinds follow each other, with their trees in order.
  const auto expectTree = [&](const TreeMesh& mesh, std::size_t first, const Placement& tree) {
    double worst = 0.;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const glm::vec3 v = mesh.vertices[i];
      const glm::vec3 turned = tree.rotation == 0.f ? v : glm::vec3(-v.y, v.x, v.z);
      worst = std::max(worst, double{glm::distance(turned + tree.position, read.vertices[first + i])});
    }
    EXPECT_LT(worst, 1e-5);
  };
  expectTree(cherry, 0, stand.trees[0]);
  expectTree(cherry, cherry.vertices.size(), stand.trees[2]);
  expectTree(maple, 2 * cherry.vertices.size(), stand.trees[1]);
}

// Check nodes: moves, scales, matrices and children; up is y, unless the rules say otherwise.
TEST_F(TreeFiles, GltfNodesPlaceTheirMeshes) {
  const auto corner = [&](const std::string& nodes, const ImportRules& rules = {}) {
    return importTree(file("t.gltf", gltf(kMesh + R"("scenes":[{"nodes":[0]}],"nodes":)" + nodes)), rules)
        .mesh.vertices[1];
  };
  EXPECT_EQ(corner(R"([{"mesh":0}])"), glm::vec3(1.f, 0.f, 0.f));
  EXPECT_EQ(corner(R"([{"mesh":0,"translation":[1,2,3]}])"), glm::vec3(2.f, -3.f, 2.f));
  EXPECT_EQ(
      corner(R"([{"mesh":0,"translation":[1,2,3]}])", {.leaf = {}, .wood = {}, .up = ImportRules::Up::z, .mesh = {}}),
      glm::vec3(2.f, 2.f, 3.f));
  EXPECT_EQ(corner(R"([{"scale":[2,2,2],"children":[1]},{"mesh":0,"translation":[1,0,0]}])"), glm::vec3(4.f, 0.f, 0.f));
  EXPECT_EQ(corner(R"([{"mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,5,0,0,1]}])"), glm::vec3(5.f, 0.f, 1.f));
}

// Check that what is broken, hostile or not read is refused in one line.
TEST_F(TreeFiles, BrokenGltfIsRefused) {
  EXPECT_EQ(refusal(gltf(kMesh + kOneNode)), "");
  EXPECT_NE(refusal("{"), "");
  EXPECT_NE(refusal(R"({"asset":{"version":"2.0"}})"), "");
  EXPECT_EQ(refusal(std::string(100'000, '[')), "depth of its JSON = 65: must be at most 64");
  EXPECT_EQ(refusal("{]"), "first byte of its JSON that is out of place = 2: must be none: it is not glTF");
  const std::string with_material = gltf(R"("meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0},)"
                                         R"("material":0}]}],"materials":[{"name":"m",MORE}],)" +
                                         kOneNode);
  const auto material = [&](const std::string& more, const std::string& number = "0") {
    std::string text = with_material;
    text.replace(text.find("MORE"), 4, more);
    return refusal(text.replace(text.find("\"material\":0") + 11, 1, number));
  };
  EXPECT_EQ(material(R"("alphaMode":"MASK")"), "");
  EXPECT_EQ(material(R"("extras":{"scale":"a","matrix":[{}]})"), "");
  EXPECT_EQ(material(R"("alphaMode":"MASK")", "4"), "material = 4: must be one of the file's");
  EXPECT_EQ(material(R"("alphaCutoff":"half")"), "alphaCutoff = \"half\": must be of numbers");
  EXPECT_EQ(material(R"("extensions":{"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":1.5}})"),
            "material \"m\": diffuseTransmissionFactor = 1.5: must be in [0, 1]");
  for (const char* scale : {R"(["a",1,1])", R"([1,[],"a"])"})
    EXPECT_EQ(refusal(gltf(kMesh + R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":)" + scale + "}]")),
              "scale = \"a\": must be of numbers");
  std::string old = gltf(kMesh + kOneNode);
  EXPECT_EQ(refusal(old.replace(old.find("2.0"), 3, "1.0")), "asset's version = 1.0: must be 2.0");
  EXPECT_EQ(refusal("glTF\2"), "is broken: its header is not that of a whole .glb of version 2");
  EXPECT_EQ(refusal(gltf(kMesh + R"("scenes":[{"nodes":[7]}],"nodes":[{"mesh":0}])")),
            "node = 7: must be one of the file's");
  EXPECT_EQ(refusal(gltf(kMesh + R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"children":[0]}])")),
            "node = 0: must be below one other node alone");
  EXPECT_EQ(refusal(gltf(kMesh + R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":3}])")),
            "mesh = 3: must be one of the file's");
  EXPECT_EQ(refusal(gltf(R"("meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":4}}]}],)" + kOneNode)),
            "POSITION: accessor = 4: must be one of the file's");
  EXPECT_EQ(refusal(gltf(R"("meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0},"indices":0}]}],)" +
                         kOneNode)),
            "indices: type = 5126: must be of whole numbers, not negative");
  std::string many = gltf(kMesh + kOneNode);
  many.replace(many.find("\"count\":3"), 9, "\"count\":4");
  EXPECT_EQ(refusal(many), "POSITION: number of elements = 4: must be no more than its buffer holds");
  many.replace(many.find("\"count\":4"), 9, "\"count\":2");
  EXPECT_EQ(refusal(many), "number of triangles' corners = 2: must be a multiple of 3");
  EXPECT_EQ(refusal(gltf(kMesh + kOneNode + R"(,"extensionsRequired":["KHR_draco_mesh_compression"])")).substr(0, 50),
            "required extension = KHR_draco_mesh_compression: m");
  EXPECT_EQ(refusal(gltf(R"("meshes":[{"name":"thing","primitives":[{"attributes":{"POSITION":0}}]}],)" + kOneNode))
                .substr(0, 40),
            "leaf and wood cannot be told apart: no t");
  EXPECT_THROW(writeGltf(folder_ / "tree.txt", importTree(file("t.gltf", gltf(kMesh + kOneNode))).mesh), InvalidInput);
  EXPECT_THROW(writePly(folder_ / "tree.txt", importTree(file("t.gltf", gltf(kMesh + kOneNode))).mesh), InvalidInput);
}

// Check that a .glb cut short anywhere, or with any one of its first bytes changed, is refused or read, and never
// breaks.
TEST_F(TreeFiles, DamagedGlbDoesNoHarm) {
  writeGltf(folder_ / "good.glb", importTree(file("t.gltf", gltf(kMesh + kOneNode))).mesh);
  const std::string good = contentOf(folder_ / "good.glb");
  int refused = 0;
  const auto tryToRead = [&](const std::string& bytes) {
    try {
      importTree(file("bad.glb", bytes));
    } catch (const InvalidInput&) {
      ++refused;
    }
  };
  for (std::size_t length = 1; length < good.size(); length += 7) tryToRead(good.substr(0, length));
  EXPECT_GT(refused, static_cast<int>(good.size() / 7) - 8);
  for (std::size_t at = 0; at < good.size(); at += 3) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x11);
    tryToRead(bytes);
  }
}
