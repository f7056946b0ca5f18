#include "render/compare/reference_picture.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include "core/require.hpp"
#include "render/compare/pixel_rays.hpp"
#include "render/compare/validation.hpp"
#include "render/reference/camera_trace.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

// A few leaves in three colours, seen from near in perspective.
Scene someLeaves() {
  Scene scene;
  scene.kinds[0].mesh = std::make_shared<TreeMesh>(leafBox(60, 3));
  for (int band = 0; band < kBands; ++band)
    scene.kinds[0].leaf[static_cast<std::size_t>(band)] = {.reflectance = 0.1f + 0.15f * static_cast<float>(band),
                                                           .transmittance = 0.2f};
  scene.suns[0].zenith = 0.6f;
  scene.ground_albedo = glm::vec3(0.2f);
  Camera camera = kOverview;
  camera.field_of_view = 0.6f;
  camera.width = 70;
  camera.height = 40;
  scene.camera = showingAll(scene, camera);
  return scene;
}

template <typename Done>
ReferencePicture::Snapshot waitFor(const ReferencePicture& picture, const Done& done) {
  for (int i = 0; i < 60'000; ++i) {
    const ReferencePicture::Snapshot shot = picture.snapshot();
    if (done(shot)) return shot;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ADD_FAILURE() << "a minute has passed";
  return picture.snapshot();
}

bool ended(const ReferencePicture::Snapshot& shot) {
  return !shot.running;
}

}  // namespace

// Check that the finished picture is as good as asked, the same to the bit for any number of threads, and differs with
// the seed; and that while it is traced, its noise falls and its paths grow.
TEST(R2_ReferencePicture, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = someLeaves();
  const auto traced = [&](int threads, std::uint64_t seed) {
    ReferencePicture picture(threads, seed);
    picture.start(scene, 0.05);
    std::uint64_t paths = 0;
    const auto shot = waitFor(picture, [&](const ReferencePicture::Snapshot& s) {
      EXPECT_GE(s.paths, paths);
      paths = s.paths;
      return ended(s);
    });
    EXPECT_TRUE(shot.finished);
    EXPECT_EQ(shot.failure, "");
    EXPECT_LE(shot.noise, 0.05);
    EXPECT_GT(shot.noise, 0.02);  // a stage brings it down by 0.7, and stages take what is known of the noise then
    return shot;
  };
  const auto one = traced(1, 1), three = traced(3, 1), other = traced(2, 2);
  EXPECT_EQ(one.radiance.values, three.radiance.values);
  EXPECT_EQ(one.standard_error.values, three.standard_error.values);
  EXPECT_EQ(one.paths, three.paths);
  EXPECT_NE(one.radiance.values, other.radiance.values);
  EXPECT_EQ(one.radiance.channels, (std::vector<std::string>{"R", "G", "B"}));
}

// Check it against the picture that is traced at one go, in each band, and that the light of two suns adds up: five
// standard errors of the means.
TEST(R2_ReferencePicture, AgreesWithThePictureTracedAtOneGo) {
  Scene scene = someLeaves();
  const auto once = [](const Scene& of) {
    return traceCameraBands(RayScene(meshes(of), of.stand, true), traceLights(of, {0, 1, 2}), pixelRays(of),
                            bounds(of).low.z, {.paths = 64 * 70 * 40, .seed = 7});
  };
  const std::vector<CameraResult> first = once(scene);
  Scene second = scene;
  second.suns[0] = {.zenith = 1.f, .azimuth = 2.f, .irradiance = {0.5f, 0.3f, 0.1f}};
  const std::vector<CameraResult> more = once(second);
  for (const bool both : {false, true}) {
    if (both) scene.suns.push_back(second.suns[0]);
    ReferencePicture picture(2);
    picture.start(scene, 0.05);
    const auto shot = waitFor(picture, ended);
    for (std::size_t band = 0; band < kBands; ++band) {
      double mean = 0., variance = 0.;
      const double pixels = 70. * 40.;
      for (std::size_t i = band; i < shot.radiance.values.size(); i += kBands) {
        mean += double{shot.radiance.values[i]} / pixels;
        variance += std::pow(double{shot.standard_error.values[i]} / pixels, 2);
      }
      double expected = first[band].mean.value, of_expected = std::pow(first[band].mean.standard_error, 2);
      if (both) {
        expected += more[band].mean.value;
        of_expected += std::pow(more[band].mean.standard_error, 2);
      }
      EXPECT_GT(expected, 0.);
      EXPECT_NEAR(mean, expected, 5. * std::sqrt(variance + of_expected)) << both << " " << band;
    }
  }
}

// Check that starting anew drops what was traced of the scene before, whatever changed; that ending it keeps what was
// found; that neither waits; and that it may be destroyed at any time.
TEST(R2_ReferencePicture, IsCancelledAndStartedAnewAtOnce) {
  const Scene scene = someLeaves();
  Scene turned = scene;
  turned.camera->azimuth += 1.f;
  Scene grown = scene;
  grown.stand.trees.push_back({.position = {3.f, 0.f, 0.f}});
  ReferencePicture picture(2);
  EXPECT_EQ(picture.snapshot().paths, 0u);
  EXPECT_TRUE(std::isinf(picture.snapshot().noise));
  for (const Scene& of : {scene, turned, grown, scene, grown}) {
    picture.start(of, 1e-6);
    waitFor(picture, [](const auto& shot) { return shot.paths > 20'000; });
  }
  for (int i = 0; i < 20; ++i) picture.start(i % 2 ? turned : grown, 1e-6);
  picture.start(scene, 1e-6);
  waitFor(picture, [](const auto& shot) { return shot.paths > 20'000; });
  picture.cancel();
  const auto cancelled = waitFor(picture, ended);
  EXPECT_FALSE(cancelled.finished);
  EXPECT_GT(cancelled.paths, 20'000u);
  EXPECT_EQ(picture.snapshot().radiance.values, cancelled.radiance.values);

  // The same scene gives the same, whatever was traced before.
  picture.start(scene, 0.1);
  ReferencePicture fresh(1);
  fresh.start(scene, 0.1);
  EXPECT_EQ(waitFor(picture, ended).radiance.values, waitFor(fresh, ended).radiance.values);
  picture.start(scene, 1e-6);
}

// Check that what cannot be traced is told, and is no end of it.
TEST(R2_ReferencePicture, TellsWhatCannotBeTraced) {
  Scene scene = someLeaves();
  scene.stand.period = glm::vec2(-1.f);
  ReferencePicture picture(1);
  picture.start(scene);
  EXPECT_NE(waitFor(picture, ended).failure.find("period"), std::string::npos);
  scene.stand.period.reset();
  scene.suns[0].zenith = 2.f;  // it has set: the picture is black
  picture.start(scene, 0.3);
  const auto shot = waitFor(picture, ended);
  EXPECT_EQ(shot.failure, "");
  EXPECT_TRUE(shot.finished);
  for (const float value : shot.radiance.values) EXPECT_EQ(value, 0.f);
  EXPECT_THROW(ReferencePicture(0), InvalidInput);
  EXPECT_THROW(picture.start(scene, 0.), InvalidInput);
}
