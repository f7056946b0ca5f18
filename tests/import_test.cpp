#include "plants/import.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/require.hpp"
#include "plants/species.hpp"
#include "plants/write_obj.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

// A folder that goes away with the test.
class Import : public testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& content) const { return folder_.write(name, content); }

  // The message importing ends with, without the folder; empty when it succeeds.
  std::string refusal(const fs::path& path, const ImportRules& rules = {}) const {
    try {
      importTree(path, rules);
    } catch (const InvalidInput& e) {
      std::string text = e.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      return folder_.without(text);
    }
    return "";
  }

  TemporaryFolder folder_;
};

ImportRules rulesOf(const std::vector<std::string>& leaf, const std::vector<std::string>& wood) {
  ImportRules rules;
  rules.leaf = leaf;
  rules.wood = wood;
  return rules;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

// Check that a tree written and read again is the same mesh, bit for bit, also from a folder with blanks and colons.
TEST_F(Import, WrittenTreeComesBackTheSame) {
  const fs::path odd = folder_ / "a b:c";
  fs::create_directory(odd);
  const TreeMesh tree = grow(species("cherry"), 2);
  writeObj(odd / "my cherry.obj", tree);
  EXPECT_TRUE(fs::exists(odd / "my cherry.mtl"));
  const ImportedTree read = importTree(odd / "my cherry.obj");
  ASSERT_EQ(read.mesh.vertices.size(), tree.vertices.size());
  EXPECT_EQ(std::memcmp(read.mesh.vertices.data(), tree.vertices.data(), tree.vertices.size() * sizeof(glm::vec3)), 0);
  EXPECT_EQ(read.mesh.leaf_triangles, tree.leaf_triangles);
  EXPECT_EQ(read.mesh.wood_triangles, tree.wood_triangles);
  EXPECT_EQ(read.mesh.leaf_of_triangle, tree.leaf_of_triangle);
  EXPECT_EQ(read.mesh.leaf_count, tree.leaf_count);
  EXPECT_EQ(read.dropped.leaf_triangles + read.dropped.wood_triangles, 0u);
  EXPECT_EQ(std::distance(fs::directory_iterator(odd), fs::directory_iterator{}), 2);
}

TEST_F(Import, WriterRefusesBadPlaces) {
  const TreeMesh tree = importTree(file("t.obj", kSquare + "g leaf\nf 1 2 3 4\n")).mesh;
  EXPECT_THROW(writeObj(folder_ / "tree.txt", tree), InvalidInput);
  EXPECT_THROW(writeObj(folder_ / "none" / "tree.obj", tree), InvalidInput);
  fs::create_directory(folder_ / "taken.obj");
  EXPECT_THROW(writeObj(folder_ / "taken.obj", tree), InvalidInput);
  EXPECT_FALSE(fs::exists(folder_ / "taken.mtl"));
}

// Check areas of polygons: a square, an L of six corners and area 3, 1 mm in size too, whose cross products lie below
// single precision's epsilon. Exact in double precision but for the float coordinates: 1e-6 relative.
TEST_F(Import, PolygonsKeepTheirArea) {
  const std::string l = "v 0 0 5\nv 2 0 5\nv 2 1 5\nv 1 1 5\nv 1 2 5\nv 0 2 5\n";
  for (const std::string order : {"1 2 3 4 5 6", "6 5 4 3 2 1", "4 5 6 1 2 3", "-6 -5 -4 -3 -2 -1"}) {
    const fs::path path = file("l.obj", l + "g leaf\nf " + order + "\n");
    const TreeMesh one = importTree(path).mesh;
    EXPECT_EQ(one.leaf_triangles.size(), 4u);
    EXPECT_EQ(one.leaf_count, 1u);
    EXPECT_NEAR(leafArea(one), 3., 3e-6) << order;
    EXPECT_NEAR(leafArea(importTree(path, {.leaf = {}, .wood = {}, .scale = 1e-3f, .mesh = {}}).mesh), 3e-6, 3e-9)
        << order;
  }
  const std::string small = "v 0 0 0\nv .0002 0 0\nv .0002 .0001 0\nv .0001 .0001 0\nv .0001 .0002 0\nv 0 .0002 0\n";
  EXPECT_NEAR(leafArea(importTree(file("s.obj", small + "g leaf\nf 1 2 3 4 5 6\n")).mesh), 3e-8, 3e-14);
}

// Check scale and the upward axis: y up, z towards the viewer becomes z up with handedness kept.
TEST_F(Import, ScaleAndUpwardAxis) {
  const fs::path path = file("t.obj", "v 0 0 0\nv 1 2 3\nv 1 0 0\ng leaf\nf 1 2 3\n");
  const TreeMesh mesh =
      importTree(path, {.leaf = {}, .wood = {}, .scale = 2.f, .up = ImportRules::Up::y, .mesh = {}}).mesh;
  EXPECT_EQ(mesh.vertices[1], glm::vec3(2.f, -6.f, 4.f));
  for (const float bad : {0.f, -1.f, std::nanf(""), std::numeric_limits<float>::infinity()})
    EXPECT_NE(refusal(path, {.leaf = {}, .wood = {}, .scale = bad, .mesh = {}}).find("scale = "), std::string::npos);
  // Finite in the file, beyond 1e6 m after scaling.
  EXPECT_NE(refusal(path, {.leaf = {}, .wood = {}, .scale = 1e7f, .mesh = {}}).find("vertex 2 x"), std::string::npos);
}

// Check who is leaf: by material first, then by group, then by object; whole words before parts of words.
TEST_F(Import, NamesTellLeafFromWood) {
  const auto leaves = [&](const std::string& names_of_second) {
    const fs::path path = file("t.obj", kSquare + "usemtl bark\nf 1 2 3\n" + names_of_second + "\nf 1 3 4\n");
    return importTree(path).mesh.leaf_triangles.size();
  };
  EXPECT_EQ(leaves("usemtl Leaf"), 1u);
  EXPECT_EQ(leaves("usemtl cottonwood_leaves.001"), 1u);
  EXPECT_EQ(leaves("usemtl OakLeafMat"), 1u);
  EXPECT_EQ(leaves("usemtl oakleaves"), 1u);
  EXPECT_EQ(leaves("usemtl m2\ng Blossom crown"), 1u);
  EXPECT_EQ(leaves("usemtl m2\no pine needles"), 1u);
  EXPECT_EQ(leaves("g trunk\nusemtl foliage"), 1u);
  const ImportedTree all = importTree(file("all.obj", kSquare + "g leaf\nf 1 2 3 4\n"));
  EXPECT_EQ(all.mesh.leaf_triangles.size(), 2u);
  EXPECT_NE(all.how.find("every name says leaf"), std::string::npos);
}

// Check that a material file that is not there neither merges leaf and wood nor stops names from telling them apart.
TEST_F(Import, MissingMaterialFileKeepsNames) {
  const std::string faces = "usemtl a_leaf\nf 1 2 3\nusemtl a_bark\nf 1 3 4\n";
  const TreeMesh mesh = importTree(file("t.obj", "mtllib gone.mtl\n" + kSquare + faces)).mesh;
  EXPECT_EQ(mesh.leaf_triangles.size(), 1u);
  EXPECT_EQ(mesh.wood_triangles.size(), 1u);
  EXPECT_NE(importTree(folder_ / "t.obj").how.find("; its material file gone.mtl is missing"), std::string::npos);
  EXPECT_EQ(refusal(file("u.obj", "mtllib gone.mtl\n" + kSquare + "usemtl m1\nf 1 2 3\nusemtl m2\nf 1 3 4\n")),
            "u.obj: leaf and wood cannot be told apart: no telling what material \"m1\"; material \"m2\" is (its "
            "material file gone.mtl is missing): say which with --leaf NAME or --wood NAME, or --leaf '*' when "
            "everything is leaf");
}

// Check that brown tells wood when names say nothing, and only when another colour is there too.
TEST_F(Import, BrownIsWoodWhenNamesAreSilent) {
  const std::string body = kSquare + "mtllib my colours.mtl\nusemtl m1\nf 1 2 3\nusemtl m2\nf 1 3 4\n";
  file("my colours.mtl", "newmtl m1\nKd 1 1 1\nnewmtl m2\nKd 0.39 0.19 0.05\n");
  const ImportedTree tree = importTree(file("t.obj", body));
  EXPECT_EQ(tree.mesh.leaf_triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
  EXPECT_EQ(tree.mesh.wood_triangles, (std::vector<glm::uvec3>{{0, 2, 3}}));
  EXPECT_NE(tree.how.find("brown"), std::string::npos);
  file("my colours.mtl", "newmtl m1\nKd 0 1 0\nnewmtl m2\nKd 0.2 0.5 0.1\n");
  EXPECT_NE(refusal(folder_ / "t.obj").find("cannot be told apart"), std::string::npos);
}

// Check the user's rules: they come before all else, match without regard to case, and what they leave out is the rest.
TEST_F(Import, RulesDecide) {
  const fs::path path = file("t.obj", kSquare + "usemtl Green\nf 1 2 3\nusemtl bark\nf 1 3 4\ng x\nf 2 3 4\n");
  const auto counts = [&](const std::vector<std::string>& leaf, const std::vector<std::string>& wood) {
    const TreeMesh mesh = importTree(path, rulesOf(leaf, wood)).mesh;
    return std::pair(mesh.leaf_triangles.size(), mesh.wood_triangles.size());
  };
  using Counts = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(counts({"green"}, {}), Counts(1, 2));
  EXPECT_EQ(counts({"GR*N"}, {}), Counts(1, 2));
  EXPECT_EQ(counts({"*"}, {}), Counts(3, 0));
  EXPECT_EQ(counts({"*"}, {"bark"}), Counts(1, 2));
  EXPECT_EQ(counts({"green"}, {"*"}), Counts(1, 2));
  EXPECT_EQ(counts({}, {"x"}), Counts(2, 1));
  EXPECT_EQ(counts({"bark"}, {"green"}), Counts(2, 1));
  EXPECT_EQ(
      refusal(path, rulesOf({"palm"}, {})),
      "t.obj: leaf \"palm\": must match a material, group or object; it has material \"Green\"; material \"bark\"; "
      "material \"bark\", group \"x\"");
  EXPECT_NE(refusal(path, rulesOf({"green", "palm"}, {"bark"})).find("leaf \"palm\""), std::string::npos);
  EXPECT_NE(refusal(path, rulesOf({"green"}, {"oak"})).find("wood \"oak\""), std::string::npos);
  // The material of the third face comes before its group, and the whole name before a part of it.
  EXPECT_EQ(counts({"x", "green"}, {"bark"}), Counts(1, 2));
  EXPECT_EQ(counts({"a", "green"}, {"bark"}), Counts(1, 2));
  EXPECT_NE(refusal(path, rulesOf({"gre*", "bark"}, {"*een"})).find("as both"), std::string::npos);
  EXPECT_NE(refusal(path, rulesOf({"x"}, {"green"})).find("leave open"), std::string::npos);
  EXPECT_NE(refusal(path, rulesOf({"*"}, {"*"})).find("both"), std::string::npos);
  EXPECT_NE(refusal(path, rulesOf({""}, {})).find("leaf or wood name"), std::string::npos);
  const fs::path nameless = file("n.obj", kSquare + "f 1 2 3 4\n");
  EXPECT_NE(refusal(nameless).find("no name"), std::string::npos);
  EXPECT_EQ(importTree(nameless, rulesOf({"*"}, {})).mesh.leaf_triangles.size(), 2u);
}

// Check that each broken OBJ is refused in one line that names the file and, where there is one, the line.
TEST_F(Import, BrokenObjIsRefused) {
  const std::string leaf = "g leaf\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "t.obj: cannot be read: it is empty"},
      {kSquare, "t.obj: has no faces, so no leaves"},
      {"v nan 0 0\nf 1 1 1\n", "t.obj line 1: vertex x = nan: must be a finite number"},
      {"v 0 -inf 0\n", "t.obj line 1: vertex y = -inf: must be a finite number"},
      {"v 0 0 1e999\n", "t.obj line 1: vertex z = 1e999: must be a finite number"},
      {"v 0 0 1e39\n", "t.obj line 1: vertex z = 1e39: must be a finite number"},
      {"v 0 0\n", "t.obj line 1: vertex z = (missing): must be a finite number"},
      {"v 0 0 0,5\n", "t.obj line 1: vertex z = 0,5: must be a finite number"},
      {leaf + kSquare + "f 1 2 5\nf 1 2 3",
       "t.obj line 6: vertex index = 5: must be at most the number of vertices, 4"},
      {leaf + kSquare + "\r\nf 1 2 0", "t.obj line 7: vertex index = 0: must be 1 or more, or negative to count back"},
      {leaf + kSquare + "f 1 2 -5",
       "t.obj line 6: vertex index = -5: must be no further back than the 4 vertices before it"},
      {leaf + kSquare + "f 1 2 99999999999999999999",
       "t.obj line 6: vertex index = 99999999999999999999: must be at most the number of vertices"},
      {leaf + kSquare + "f 1 2 x", "t.obj line 6: vertex index = x: must be a whole number"},
      {leaf + kSquare + "f 1 2 /", "t.obj line 6: vertex index = /: must be a whole number"},
      {leaf + kSquare + "f 1 2 3///1", "t.obj line 6: corner = 3///1: must be of the form v, v/vt, v//vn or v/vt/vn"},
      {leaf + kSquare + "f 1 2 +-1", "t.obj line 6: vertex index = +-1: must be a whole number"},
      {"v +-1 0 0\n", "t.obj line 1: vertex x = +-1: must be a finite number"},
      {leaf + kSquare + "f 1 2 3.5", "t.obj line 6: vertex index = 3.5: must be a whole number"},
      {leaf + kSquare + "f 1 2", "t.obj line 6: number of corners of the face = 2: must be from 3 to 1000"},
      {leaf + kSquare + "f", "t.obj line 6: number of corners of the face = 0: must be from 3 to 1000"},
      {std::string("v 0 0 0\n\0\x7f\x01garbage", 18), "t.obj line 2: holds a zero byte: must be text"},
  };
  for (const auto& [content, expected] : cases) EXPECT_EQ(refusal(file("t.obj", content)), expected);
  EXPECT_NE(refusal(file("t.obj", "\x7f\x45\x4c\x46\x02\x01\xff\xfe garbage")).find("has no faces"), std::string::npos);
  EXPECT_EQ(refusal(folder_ / "none.obj"), "none.obj: cannot be read: there is no such file");
  EXPECT_NE(refusal(folder_.path()).find("it is a folder"), std::string::npos);
  EXPECT_NE(refusal(file("t.xyz", "v")).find("an .obj, .ply, .gltf, .glb, .txt or .leaves file"), std::string::npos);
  EXPECT_NE(refusal(file("w.obj", kSquare + "g bark\nf 1 2 3 4\n")).find("has only wood and no leaf (group \"bark\")"),
            std::string::npos);
}

// Check that a file cut off anywhere is either refused or read, and never crashes (sanitizers watch).
TEST_F(Import, EveryTruncationIsHandled) {
  const std::string obj = "mtllib t.mtl\n" + kSquare + "usemtl a leaf\nf 1/1/1 2/2 3//3\nf -4 -2 -1\n";
  for (std::size_t length = 0; length <= obj.size(); ++length) refusal(file("t.obj", obj.substr(0, length)));
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (std::size_t length = 0; length + 2 < ply.size(); ++length)
    EXPECT_NE(refusal(file("t.ply", ply.substr(0, length))), "") << length;
  EXPECT_EQ(refusal(file("t.ply", ply)), "");
}

// Check that leaves without area are dropped and counted, and that a tree of nothing else is refused.
TEST_F(Import, FlatLeavesAreDroppedAndCounted) {
  const ImportedTree tree = importTree(file("t.obj", kSquare + "g leaf\nf 1 2 3 4\nf 1 1 2\nf 1 2 1\n"));
  EXPECT_EQ(tree.dropped.leaf_triangles, 2u);
  EXPECT_EQ(tree.mesh.leaf_triangles.size(), 2u);
  EXPECT_NE(refusal(file("u.obj", kSquare + "g leaf\nf 1 1 2\n")).find("has no leaves"), std::string::npos);
}

namespace {

// The bytes of a value, least significant first, or reversed.
template <typename T>
std::string bytes(T value, bool big) {
  std::string text(sizeof(T), '\0');
  std::memcpy(text.data(), &value, sizeof(T));
  if (big != (std::endian::native == std::endian::big)) std::reverse(text.begin(), text.end());
  return text;
}

// A square as PLY, with properties to skip before, between and after those that count.
std::string squarePly(const std::string& format) {
  std::string ply = "ply\r\nformat " + format +
                    " 1.0\ncomment made for a test\nelement camera 1\nproperty list uchar short knobs\n"
                    "element vertex 4\nproperty double x\nproperty uchar red\nproperty float y\nproperty int16 z\n"
                    "element face 1\nproperty float32 quality\nproperty list uint8 uint vertex_index\nend_header\n";
  if (format == "ascii") return ply + "2 7 -8\n0 255 0 0\n1 255 0 0\n1 255 1 0\n0 255 1 0\n0.5 4 0 1 2 3";
  const bool big = format == "binary_big_endian";
  ply += bytes(std::uint8_t{2}, big) + bytes(std::int16_t{7}, big) + bytes(std::int16_t{-8}, big);
  for (const auto& [x, y] : {std::pair(0., 0.f), {1., 0.f}, {1., 1.f}, {0., 1.f}})
    ply += bytes(x, big) + bytes(std::uint8_t{255}, big) + bytes(y, big) + bytes(std::int16_t{0}, big);
  ply += bytes(0.5f, big) + bytes(std::uint8_t{4}, big);
  for (const std::uint32_t corner : {0u, 1u, 2u, 3u}) ply += bytes(corner, big);
  return ply;
}

std::string plyWith(const std::string& vertices, const std::string& faces, const std::string& body) {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

}  // namespace

// Check that the three formats of PLY give the same square, all of it leaf, and every truncation is refused.
TEST_F(Import, PlyOfEveryFormat) {
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string ply = squarePly(format);
    const ImportedTree tree = importTree(file("t.ply", ply), rulesOf({"*"}, {}));
    EXPECT_EQ(tree.mesh.leaf_count, 1u) << format;
    EXPECT_EQ(tree.mesh.vertices[2], glm::vec3(1.f, 1.f, 0.f)) << format;
    EXPECT_DOUBLE_EQ(leafArea(tree.mesh), 1.) << format;
    for (std::size_t length = 0; length < ply.size(); length += 3)
      EXPECT_NE(refusal(file("t.ply", ply.substr(0, length))), "") << format << " " << length;
  }
  EXPECT_NE(refusal(folder_ / "t.ply", rulesOf({"green"}, {})).find("no names"), std::string::npos);
}

// Check broken PLY files, among them counts that would fill the memory.
TEST_F(Import, BrokenPlyIsRefused) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"garbage", "t.ply line 1: the PLY header ends without end_header"},
      {"obj\n", "t.ply line 1: first line = obj: must be \"ply\""},
      {"ply\nformat ascii 2.0\n",
       "t.ply line 2: format = format ascii 2.0: must be ascii, binary_little_endian or binary_big_endian, with "
       "version "
       "1.0"},
      {"ply\nelement vertex many\n", "t.ply line 2: element = element vertex many: must be a name and a count"},
      {"ply\nelement vertex 1\nproperty half x\n",
       "t.ply line 3: property = property half x: must be of a PLY type, such as float or int"},
      {plyWith("999999999999", "1", "0 0 0\n"),
       "t.ply: number of vertex elements = 999999999999: must be no more than the rest of the file can hold, 6 bytes"},
      {plyWith("1", "0", "0 0 0\n"), "t.ply: has no faces, so no leaves"},
      {plyWith("3", "1", "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"),
       "t.ply line 12: vertex 3 y = nan: must be a finite number"},
      {plyWith("3", "1", "0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n"), "t.ply line 12: vertex 3 = one: must be a number"},
      {plyWith("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
       "t.ply line 13: face 1 vertex index = 3: must be a whole number below the number of vertices before it, 3"},
      {plyWith("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
       "t.ply line 13: face 1 vertex index = -1: must be a whole number below the number of vertices before it, 3"},
      {plyWith("3", "1", "0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
       "t.ply line 13: face 1 number of corners = 2: must be from 3 to 1000"},
      {plyWith("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1"), "t.ply line 13: face 1: the file ends before it is complete"},
  };
  for (const auto& [content, expected] : cases) EXPECT_EQ(refusal(file("t.ply", content)), expected);
}

// Check that a backslash at the end of a line of an OBJ continues it, of numbers and of names, but not of a comment.
TEST_F(Import, BackslashesContinueLines) {
  const TreeMesh mesh = importTree(file("t.obj",
                                        "# C:\\trees\\\nv 0 0 0\nv 1 \\\r\n 0 \\\r\n 0\nv 1 1 0\nv 0 1 0\nusemtl \\\n"
                                        "leaf\nf 1 2 \\\n3 4\nusemtl bark\nf 1 2 3\\"))
                            .mesh;
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.leaf_triangles.size(), 2u);
  EXPECT_EQ(mesh.wood_triangles.size(), 1u);
}

// Check that messages quote bytes that are no text as such, and names of any script as they are.
TEST_F(Import, MessagesHoldText) {
  EXPECT_EQ(refusal(file("t.obj", kSquare + "g leaf\nf \xff\xfe\x01 2 3\n")),
            "t.obj line 6: vertex index = ???: must be a whole number");
  EXPECT_EQ(refusal(file("u.obj", kSquare + "g leaf\nf \xc3\xa9 2 3\n")),
            "u.obj line 6: vertex index = \xc3\xa9: must be a whole number");
  EXPECT_EQ(refusal(file("t.ply",
                         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float z\nelement face "
                         "0\nproperty list uchar int vertex_indices\nend_header\n1 2\n")),
            "t.ply: property y of the vertices = (missing): must be a number of each vertex");
}
