// Check files that are made to do harm: each is refused in one line, or read, and takes memory of the order of its own
// size.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cstdint>
#include <filesystem>

#include "core/require.hpp"
#include "plants/import.hpp"
#include "render/image_file.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

class HostileFiles : public testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& content) const { return folder_.write(name, content); }

  // What importing ends with, without the folder; "read" when it succeeds. It may take `times` the file's size in
  // memory, and what loading an image's libraries and small things take.
  std::string outcome(const fs::path& path, [[maybe_unused]] double times = 30.) const {
    [[maybe_unused]] const long before = peak();
    std::string text = "read";
    try {
      importStand(path, {}, readOpacity);
    } catch (const InvalidInput& e) {
      text = e.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      text = folder_.without(text);
    }
#ifndef __SANITIZE_ADDRESS__
    constexpr double kSmall = 150e6;  // [byte]
    EXPECT_LT(1024. * static_cast<double>(peak() - before), times * static_cast<double>(fs::file_size(path)) + kSmall);
#endif
    return text;
  }

  static long peak() {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    return use.ru_maxrss;  // [kB]
  }

  TemporaryFolder folder_;
};

// A whole PNG but for its pixels, of which it says to have 4096 x 4096, or 60000 x 60000.
template <std::size_t Size>
std::string text(const std::array<std::uint8_t, Size>& bytes) {
  return {bytes.begin(), bytes.end()};
}
constexpr std::array<std::uint8_t, 69> kBomb{
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x10, 0x00, 0x00, 0x00, 0x10, 0x00, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf2, 0xa3, 0x24, 0x17, 0x00, 0x00, 0x00,
    0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0xa0, 0x0c, 0x00, 0x00, 0x00, 0x40, 0x00, 0x01, 0xb7,
    0x34, 0x7c, 0xef, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
constexpr std::array<std::uint8_t, 69> kLargerBomb{
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0xea, 0x60, 0x00, 0x00, 0xea, 0x60, 0x08, 0x06, 0x00, 0x00, 0x00, 0x80, 0xd2, 0x75, 0x42, 0x00, 0x00, 0x00,
    0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0xa0, 0x0c, 0x00, 0x00, 0x00, 0x40, 0x00, 0x01, 0xb7,
    0x34, 0x7c, 0xef, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

const std::string kCard =
    "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl leaf\nf 1/1 2/2 3/3\n";

}  // namespace

TEST_F(HostileFiles, ManyNamesInObj) {
  constexpr int kMany = 1'000'000;
  std::string groups = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", materials = groups, twice = groups;
  for (int i = 0; i < kMany; ++i) groups += "g l" + std::to_string(i) + "\nf 1 2 3\n";
  EXPECT_NE(outcome(file("t.obj", groups)).find("and 999992 more is: say which with"), std::string::npos);
  groups.insert(0, "usemtl leaf\n");
  EXPECT_EQ(outcome(file("t.obj", groups)), "read");
  for (int i = 0; i < kMany / 4; ++i) materials += "mtllib none" + std::to_string(i) + ".mtl\n";
  EXPECT_EQ(outcome(file("t.obj", materials + "usemtl leaf\nf 1 2 3\n")), "read");
  std::string library;
  for (int i = 0; i < 20'000; ++i) library += "newmtl a\n";
  file("t.mtl", library);
  EXPECT_EQ(outcome(file("t.obj", kCard)), "t.mtl: number of materials = 20000: must be at most 10000");
  file("t.mtl", std::string(100'000, '\xff') + "\nnewmtl leaf\nKd nan\nd -\nmap_d -s\n");
  EXPECT_NE(outcome(file("t.obj", kCard)), "");
}

TEST_F(HostileFiles, ImagesThatAreMissingOrBurst) {
  file("t.mtl", "newmtl leaf\nmap_d leaf.png\n");
  const fs::path card = file("t.obj", kCard);
  EXPECT_EQ(outcome(card), "leaf.png: cannot be read: there is no such file");
  file("leaf.png", "text");
  EXPECT_NE(outcome(card).find("leaf.png: cannot be read: "), std::string::npos);
  file("leaf.png", text(kBomb));
  EXPECT_EQ(outcome(card), "leaf.png: cannot be read: says to be of 4096 x 4096 pixels in " +
                               std::to_string(kBomb.size()) +
                               " bytes: must be at most 4096 x 4096, and 400 values a byte");
  file("leaf.png", text(kLargerBomb));
  EXPECT_NE(outcome(card).find("leaf.png: cannot be read: "), std::string::npos);
  fs::remove(folder_ / "leaf.png");
  fs::create_directory(folder_ / "leaf.png");
  EXPECT_EQ(outcome(card), "leaf.png: cannot be read: it is no regular file");
}

TEST_F(HostileFiles, GltfThatWouldFillTheMemory) {
  const std::string start = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)";
  std::string nodes = start + R"("nodes":[{})";
  for (int i = 0; i < 1'000'000; ++i) nodes += ",{}";
  EXPECT_EQ(outcome(file("t.gltf", nodes + "]}")),
            "t.gltf: number of objects in its JSON = 1000004: must be at most 200000");
  std::string values = start + R"("extras":[0)";
  for (int i = 0; i < 4'000'000; ++i) values += ",0";
  EXPECT_EQ(outcome(file("t.gltf", values + "]}")).substr(0, 37), "t.gltf: number of values in its JSON ");

  // Triangle, indices and instances of the same bytes.
  const auto counted = [&](const std::string& count, const std::string& rest) {
    return start +
           R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":0,"componentType":5126,"count":)" +
           count + R"(,"type":"VEC3"}],"meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0}}]}],)" +
           rest + "}";
  };
  const std::string instanced =
      R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}}}])";
  EXPECT_EQ(outcome(file("t.gltf", counted("3", instanced))), "read");
  for (const char* count : {"4000000000", "18446744073709551615", "-1", "1e300"})
    EXPECT_NE(outcome(file("t.gltf", counted(count, instanced))), "read") << count;
  // A chain of nodes that ends in itself.
  EXPECT_EQ(
      outcome(file("t.gltf", counted("3", R"("nodes":[{"children":[1]},{"children":[2]},{"mesh":0,"children":[1]}])"))),
      "t.gltf: node = 1: must be below one other node alone");
  // The same mesh under many nodes is a stand, not as many meshes.
  std::string many = R"("nodes":[{"children":[)", children;
  for (int i = 1; i <= 100'000; ++i) {
    if (i > 1) many += ',';
    many += std::to_string(i);
    children += R"(,{"mesh":0,"translation":[)" + std::to_string(i) + ",0,0]}";
  }
  EXPECT_EQ(outcome(file("t.gltf", counted("3", many + "]}" + children + "]"))), "read");
}

TEST_F(HostileFiles, TextThatIsBinaryAndCountsThatAreHuge) {
  std::string binary =
      "\x7f"
      "ELF";
  for (int i = 0; i < 100'000; ++i) binary += static_cast<char>(i * 37 % 251);
  for (const char* name : {"t.obj", "t.ply", "t.gltf", "t.glb", "t.txt", "t.leaves"})
    EXPECT_NE(outcome(file(name, binary)), "read") << name;
  for (const char* count : {"4294967296", "18446744073709551615", "99999999999999999999", "-1"})
    EXPECT_NE(outcome(file("t.ply", "ply\nformat binary_little_endian 1.0\nelement vertex " + std::string(count) +
                                        "\nproperty float x\nproperty float y\nproperty float z\nend_header\n")),
              "read");
  // The header of a .glb whose chunk says to be longer than the file.
  EXPECT_NE(outcome(file("t.glb", std::string("glTF\2\0\0\0\xff\xff\xff\x7f\xff\xff\xff\x7fJSON{}", 22))), "read");
}
