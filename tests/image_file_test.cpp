#include "render/image_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numbers>

#include "core/require.hpp"
#include "render/scene.hpp"
#include "tests/temporary_folder.hpp"

namespace {

using namespace sunfleck;
namespace fs = std::filesystem;

Image colours() {
  return {.width = 3,
          .height = 2,
          .channels = {"R", "G", "B", "A"},
          .values = {0.f,  0.5f,   1.f, 1.f, 0.25f, 2.f,   -1.f, 0.5f, 1e-3f, 1e6f, 0.0031308f, 1.f,
                     0.1f, 0.214f, 0.f, 0.f, 0.75f, 1e-9f, 0.2f, 1.f,  0.3f,  0.6f, 0.9f,       1.f}};
}

template <typename T>
std::vector<T> pixels(OIIO::ImageInput& in, OIIO::TypeDesc type) {
  const OIIO::ImageSpec& spec = in.spec();
  std::vector<T> values(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
  EXPECT_TRUE(in.read_image(0, 0, 0, spec.nchannels, type, values.data()));
  return values;
}

// Check that an EXR gives back the very floats and channel names it was written with, and that nothing in it changes
// from one writing to the next.
TEST(ImageFile, ExrKeepsEveryValue) {
  const TemporaryFolder folder;
  const Image image = colours();
  writeImage(folder / "a.exr", image, 7.f);
  const auto in = OIIO::ImageInput::open((folder / "a.exr").string());
  ASSERT_TRUE(in);
  EXPECT_EQ(in->spec().channelnames, image.channels);
  EXPECT_EQ(in->spec().get_string_attribute("DateTime"), "");
  EXPECT_EQ(pixels<float>(*in, OIIO::TypeDesc::FLOAT), image.values);
  EXPECT_EQ(folder.files(), 1);
}

// Check that a PNG shows radiance times exposure by the published curve of sRGB (IEC 61966-2-1): linear .214 is code
// 127, .0031308 is 10, half is 188; what is negative is black, what is above 1 white.
TEST(ImageFile, PngIsSRgb) {
  const TemporaryFolder folder;
  writeImage(folder / "a.PNG", colours(), 1.f);
  const auto in = OIIO::ImageInput::open((folder / "a.PNG").string());
  ASSERT_TRUE(in);
  ASSERT_EQ(in->spec().nchannels, 3);
  const auto codes = pixels<std::uint8_t>(*in, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(codes, (std::vector<std::uint8_t>{0, 188, 255, 137, 255, 0, 3, 255, 10,  //
                                              89, 127, 0, 225, 0, 124, 149, 203, 243}));
}

// Check that exposure brightens, that one channel is grey, and that what is not a number is black.
TEST(ImageFile, PngOfOneChannelIsGrey) {
  const Image image{
      .width = 3, .height = 1, .channels = {"Y"}, .values = {0.107f, std::numeric_limits<float>::quiet_NaN(), 0.5f}};
  std::string bytes = pngBytes(image, 2.f);
  EXPECT_EQ(bytes, pngBytes(image, 2.f));
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto in = OIIO::ImageInput::open("a.png", nullptr, &memory);
  ASSERT_TRUE(in);
  ASSERT_EQ(in->spec().nchannels, 1);
  EXPECT_EQ(pixels<std::uint8_t>(*in, OIIO::TypeDesc::UINT8), (std::vector<std::uint8_t>{127, 0, 255}));
}

// Check that what cannot be written is refused by one line that names the file, and leaves nothing behind.
TEST(ImageFile, RefusesWhatItCannotWrite) {
  const TemporaryFolder folder;
  for (const fs::path& bad :
       {folder / "a.jpg", folder / "a", folder / "none" / "a.png", folder / "none" / "a.exr", folder.path()}) {
    try {
      writeImage(bad, colours(), 1.f);
      FAIL() << bad << " was written";
    } catch (const InvalidInput& e) {
      EXPECT_EQ(std::string(e.what()).find(bad.string()), 0u) << e.what();
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

std::shared_ptr<TreeMesh> oneLeaf() {
  auto mesh = std::make_shared<TreeMesh>();
  mesh->vertices = {{1.f, 0.f, 0.f}, {3.f, 0.f, 1.f}, {1.f, 1.f, 2.f}};
  mesh->leaf_triangles = {{0, 1, 2}};
  finish(*mesh, "test");
  return mesh;
}

// Check the camera's axes: unit, at right angles, the eye where elevation and azimuth say, up upward. Error: sine and
// cosine in float.
TEST(SceneGeometry, ViewAxesLookFromTheEye) {
  constexpr float quarter = 0.5f * std::numbers::pi_v<float>;
  for (const float elevation : {-quarter, -0.4f, 0.f, 0.6f, quarter})
    for (const float azimuth : {0.f, 1.f, 4.f}) {
      const Axes axes = viewAxes({.elevation = elevation, .azimuth = azimuth});
      const glm::vec3 eye(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                          std::sin(elevation));
      EXPECT_LT(glm::length(axes.along + eye), 4e-7f);
      EXPECT_LT(glm::length(glm::cross(axes.right, axes.up) - eye), 4e-7f);
      EXPECT_EQ(axes.right.z, 0.f);
      EXPECT_GE(axes.up.z, -1e-7f);
    }
}

// Check the box of a stand with a shifted and a rotated tree. Error: a few roundings.
TEST(SceneGeometry, BoundsHoldAllTrees) {
  Scene scene;
  scene.kinds[0].mesh = oneLeaf();
  scene.stand.trees = {{.position = {10.f, 0.f, 0.f}}, {.rotation = std::numbers::pi_v<float>}};
  const Bounds box = bounds(scene);
  EXPECT_LT(glm::length(box.low - glm::vec3(-3.f, -1.f, 0.f)), 2e-6f);
  EXPECT_LT(glm::length(box.high - glm::vec3(13.f, 1.f, 2.f)), 2e-6f);
}

// Check that the camera made for a scene shows every vertex, and wastes no more than a third of the picture's width on
// a tree as wide as high; and that the scene's own camera is kept.
TEST(SceneGeometry, CameraShowsTheWholeStand) {
  Scene scene;
  scene.kinds[0].mesh = oneLeaf();
  const Camera camera = cameraOf(scene);
  const Axes axes = viewAxes(camera);
  float farthest = 0.f;
  for (const glm::vec3& vertex : scene.kinds[0].mesh->vertices)
    for (const glm::vec3& axis : {axes.right, axes.up})
      farthest = std::max(farthest, std::abs(glm::dot(vertex - camera.target, axis)));
  EXPECT_LT(farthest, camera.half_width);
  EXPECT_GT(farthest, camera.half_width * 2.f / 3.f);
  scene.camera = Camera{.half_width = 5.f};
  EXPECT_EQ(cameraOf(scene).half_width, 5.f);
}

}  // namespace

// Check that the bytes of a PNG are read as the file of them is, and that what they are not is refused.
TEST(ImageFile, OpacityIsReadFromBytes) {
  const TemporaryFolder folder;
  const fs::path file = folder / "leaf.png";
  writePng(file, 2, 1, std::vector<std::uint8_t>{255, 0, 0, 0, 255, 51});
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const Image of_file = readOpacity(file, {}), of_bytes = readOpacity("other.png", bytes);
  EXPECT_EQ(of_bytes.channels, of_file.channels);
  EXPECT_EQ(of_bytes.values, of_file.values);
  ASSERT_EQ(of_bytes.values.size(), 6u);
  EXPECT_EQ(of_bytes.values[4], 1.f);
  EXPECT_NEAR(of_bytes.values[5], 51.f / 255.f, 1e-6f);  // rounding of the division
  EXPECT_THROW(readOpacity("other.png", std::string_view(bytes).substr(0, 4)), InvalidInput);
  EXPECT_THROW(readOpacity("other.jpg", bytes), InvalidInput);
  EXPECT_THROW(readOpacity("other", bytes), InvalidInput);
}
