// Check stands of instances in glTF: kept as kinds and placements, by importStand() and by scenes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/require.hpp"
#include "plants/import.hpp"
#include "plants/species.hpp"
#include "plants/write_gltf.hpp"
#include "render/scene_file.hpp"
#include "render/scene_writer.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

class GltfStand : public testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& content) const { return folder_.write(name, content); }

  TemporaryFolder folder_;
};

// Two meshes of a triangle in the file's plane y = 0, of which two sides are 1 long.
std::string gltf(const std::string& nodes, const std::string& roots) {
  return R"({"asset":{"version":"2.0"},"scene":0,)"
         R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/"}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
         R"("materials":[{"name":"leaf"},{"name":"bark"}],)"
         R"("meshes":[{"name":"crown","primitives":[{"attributes":{"POSITION":0},"material":0}]},)"
         R"({"name":"trunk","primitives":[{"attributes":{"POSITION":0},"material":1}]}],)"
         R"("scenes":[{"nodes":)" +
         roots + R"(}],"nodes":)" + nodes + "}";
}

}  // namespace

// Check that a stand written with two kinds comes back as two kinds with the same meshes and placements, not as one
// mesh; turns by quaternions of floats to 1e-6 rad.
TEST_F(GltfStand, WrittenStandComesBackAsOne) {
  const TreeMesh cherry = grow(species("cherry"), 1), maple = grow(species("maple"), 1);
  const std::array<const TreeMesh*, 2> kinds{&cherry, &maple};
  const float quarter = std::numbers::pi_v<float> / 2.f;
  const Stand stand{.trees = {{.position = {1.f, 2.f, 0.f}, .kind = 0},
                              {.position = {-10.f, 5.f, 0.5f}, .rotation = quarter, .kind = 1},
                              {.position = {8.f, -3.f, 0.f}, .rotation = -1.f, .kind = 0},
                              {.position = {20.f, 5.f, 0.f}, .rotation = 3.f, .kind = 1}}};
  writeGltf(folder_ / "stand.glb", kinds, stand);
  const ImportedStand read = importStand(folder_ / "stand.glb");
  ASSERT_EQ(read.kinds.size(), 2u);
  EXPECT_NE(read.kinds[0].name, read.kinds[1].name);
  ASSERT_EQ(read.stand.trees.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Placement &tree = read.stand.trees[i], &written = stand.trees[std::array{0u, 2u, 1u, 3u}[i]];
    EXPECT_EQ(tree.position, written.position);
    EXPECT_NEAR(tree.rotation, written.rotation, 1e-6f);
    EXPECT_EQ(tree.kind, written.kind);
  }
  for (std::size_t kind = 0; kind < 2; ++kind) {
    const TreeMesh& mesh = read.kinds[kind].tree.mesh;
    EXPECT_EQ(mesh.leaf_count, kinds[kind]->leaf_count);
    EXPECT_EQ(mesh.vertices, kinds[kind]->vertices);
    ImportRules one;
    one.mesh = read.kinds[kind].name;
    EXPECT_EQ(importTree(folder_ / "stand.glb", one).mesh.vertices, kinds[kind]->vertices);
  }
  ImportRules none;
  none.mesh = "baobab";
  EXPECT_THROW(importTree(folder_ / "stand.glb", none), InvalidInput);

  // A scene of it keeps them, and so does the scene file that is written of that.
  const Scene scene = readScene((folder_ / "stand.glb").string());
  EXPECT_EQ(scene.kinds.size(), 2u);
  EXPECT_EQ(scene.stand, read.stand);
  Scene flat = scene;
  for (Placement& tree : flat.stand.trees) tree.position.z = 0.f;  // as scene files have them
  writeScene(folder_ / "stand.toml", flat);
  const Scene again = readScene((folder_ / "stand.toml").string());
  ASSERT_EQ(again.kinds.size(), 2u);
  EXPECT_EQ(again.stand, flat.stand);
  EXPECT_EQ(again.kinds[1].mesh->vertices, scene.kinds[1].mesh->vertices);
  EXPECT_EQ(again.kinds[1].leaf, scene.kinds[1].leaf);
}

// Check nodes that share meshes: leaves and wood under one node are one kind; scaled alike everywhere they are one kind
// of that size; what stands once is the rest; differing scales make one tree of all, and so do parts without a leaf.
TEST_F(GltfStand, NodesThatShareMeshesAreInstances) {
  const std::string tree0 = R"({"children":[2,3],"translation":[1,0,0],"scale":[2,2,2]})";
  const std::string tree1 =
      R"({"children":[4,5],"translation":[0,0,-7],"rotation":[0,0.7071067811865476,0,0.7071067811865476],"scale":[2,2,2]})";
  const std::string parts = R"({"mesh":0},{"mesh":1},{"mesh":0},{"mesh":1})";
  const fs::path same = file("t.gltf", gltf("[" + tree0 + "," + tree1 + "," + parts + "]", "[0,1]"));
  const ImportedStand stand = importStand(same);
  ASSERT_EQ(stand.kinds.size(), 1u);
  EXPECT_EQ(stand.kinds[0].name, "crown");
  EXPECT_EQ(stand.kinds[0].tree.mesh.leaf_triangles.size(), 1u);
  EXPECT_EQ(stand.kinds[0].tree.mesh.wood_triangles.size(), 1u);
  EXPECT_NEAR(leafArea(stand.kinds[0].tree.mesh), 2., 1e-6);  // half a square metre, twice as long
  ASSERT_EQ(stand.stand.trees.size(), 2u);
  EXPECT_EQ(stand.stand.trees[1].position, glm::vec3(0.f, 7.f, 0.f));
  EXPECT_NEAR(stand.stand.trees[1].rotation, std::numbers::pi_v<float> / 2.f, 1e-6f);
  ImportRules rules;
  rules.scale = 0.01f;
  const ImportedStand small = importStand(same, rules);
  EXPECT_NEAR(small.stand.trees[1].position.y, 0.07f, 1e-8f);
  EXPECT_NEAR(leafArea(small.kinds[0].tree.mesh), 2e-4, 1e-9);
  EXPECT_EQ(importTree(same).mesh.leaf_triangles.size(), 2u);

  const std::string other = R"({"children":[4,5],"translation":[0,0,-7],"scale":[2,3,2]})";
  const ImportedStand differs =
      importStand(file("t.gltf", gltf("[" + tree0 + "," + other + "," + parts + "]", "[0,1]")));
  ASSERT_EQ(differs.kinds.size(), 1u);
  EXPECT_EQ(differs.stand, Stand{});
  EXPECT_EQ(differs.kinds[0].tree.mesh.leaf_triangles.size(), 2u);

  const ImportedStand apart = importStand(file(
      "t.gltf", gltf(R"([{"mesh":0},{"mesh":0,"translation":[3,0,0]},{"mesh":1},{"mesh":1,"translation":[4,0,0]}])",
                     "[0,1,2,3]")));
  EXPECT_EQ(apart.stand, Stand{});  // trunks that do not go with crowns are no trees
  EXPECT_EQ(apart.kinds[0].tree.mesh.wood_triangles.size(), 2u);
}
