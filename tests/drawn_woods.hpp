#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "plants/random_leaves.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/gl/stand_picture.hpp"
#include "render/gl/stand_renderer.hpp"

// Small stands and their pictures for tests.
namespace sunfleck::woods {

// A radiance is a handful of float operations away from its closed form; llvmpipe's exponentials add up to 2e-6.
inline constexpr float kShading = 4e-6f;

// A scene of two kinds of crowns, with their products.
struct Woods {
  Scene scene;
  StandGeometry geometry{{.light_resolution = 64, .sample_resolution = 64, .cells = 8}};

  explicit Woods(std::size_t trees = 5) {
    const auto kind = [](std::uint64_t seed, int leaves) {
      TreeKind of;
      RandomCrown crown;
      crown.leaves = leaves;
      crown.leaf_side = 0.15f;
      of.mesh = std::make_shared<TreeMesh>(randomCrown(crown, seed));
      return of;
    };
    scene.kinds = {kind(1, 800), kind(2, 300)};
    scene.kinds[1].leaf = {LeafOptics{0.1f, 0.1f}, LeafOptics{0.4f, 0.3f}, LeafOptics{0.2f, 0.1f}};
    scene.stand.trees.clear();
    for (std::size_t i = 0; i < trees; ++i)
      scene.stand.trees.push_back(
          {.position = {3.2f * static_cast<float>(i % 3), 3.4f * static_cast<float>(i / 3), 0.f},
           .kind = static_cast<std::uint32_t>(i % 2)});
    scene.ground_albedo = glm::vec3(0.2f, 0.15f, 0.1f);
    scene.suns = {{.zenith = 0.5f, .azimuth = 0.3f},
                  {.zenith = 0.9f, .azimuth = 3.f, .irradiance = {0.2f, 0.3f, 0.4f}}};
    scene.sky.kind = SceneSky::Kind::uniform;
    scene.sky.irradiance = glm::dvec3(0.1, 0.2, 0.3);
  }
  gl::DrawnStand stand() {
    geometry.update(scene);
    return gl::drawnStand(scene, geometry);
  }
  Camera camera(int size = 96) const {
    Camera from = kOverview;
    from.elevation = 0.6f;
    from.width = from.height = size;
    return showingAll(scene, from);
  }
};

inline Camera inPerspective(Camera camera) {
  camera.field_of_view = 0.8f;
  return camera;
}

// Draws with a context of its own, which must have had nothing to say.
class Drawing {
 public:
  explicit Drawing(const gl::DrawnStand& stand) { renderer.update(stand); }
  ~Drawing() {
    EXPECT_NO_THROW(context.requireNoError("drawing"));
    EXPECT_EQ(context.messages(), 0u);
  }
  Image picture(const Camera& camera, const gl::PictureEffort& effort = {}) {
    return gl::standPicture(context, renderer, camera, effort);
  }
  gl::Context context;
  gl::StandRenderer renderer{context, exactPowerTable};
};

inline const std::vector<gl::Layer> kAll(gl::kLayersBesideTotal.begin(), gl::kLayersBesideTotal.end());

inline std::size_t channel(const Image& image, const std::string& name) {
  const auto found = std::ranges::find(image.channels, name);
  EXPECT_NE(found, image.channels.end()) << name;
  return static_cast<std::size_t>(found - image.channels.begin());
}
inline float value(const Image& image, int x, int y, const std::string& name) {
  return image.values[image.at(x, y, channel(image, name))];
}

}  // namespace sunfleck::woods
