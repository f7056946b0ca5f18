#include "render/reference/light_picture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/require.hpp"
#include "render/reference/trace_effort.hpp"
#include "render/reference/trace_run.hpp"
#include "sky/sky_models.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr int kSide = 32;  // [pixel]

// A square picture around the origin, seen along `sight`.
PixelRays picture(Direction sight, float half_width) {
  const Axes axes = axesAlong(sight);
  return {.corner = -half_width * (axes.right + axes.up),
          .right_step = 2.f * half_width / kSide * axes.right,
          .down_step = 2.f * half_width / kSide * axes.up,
          .sight = sight,
          .width = kSide,
          .height = kSide};
}

TraceSums traced(const TraceJob& job, std::uint64_t units, std::uint64_t seed = 1) {
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = seed, .wanted = {0, units}}, sums);
  return sums;
}

std::vector<CameraResult> byLight(const RayScene& scene, const std::vector<TraceLight>& bands, const PixelRays& rays) {
  const CameraJob once(scene, bands, rays, -1.f, 8, Followed::once);
  const LightPictureJob more(scene, bands, rays, 1024);
  return together(once.results(traced(once, once.unitsOf(64))), more.results(traced(more, 128)));
}

// Means of the picture's quarters, as pixels alone are too noisy to tell much.
std::array<Estimate, 4> quarters(const CameraResult& result) {
  std::array<Estimate, 4> means{};
  for (std::size_t y = 0; y < kSide; ++y)
    for (std::size_t x = 0; x < kSide; ++x) {
      Estimate& of = means[2 * (y / (kSide / 2)) + x / (kSide / 2)];
      of.value += 4. / (kSide * kSide) * double{result.radiance.values[2 * (y * kSide + x)]};
      of.standard_error += std::pow(4. / (kSide * kSide) * double{result.standard_error.values[y * kSide + x]}, 2);
    }
  for (Estimate& of : means) of.standard_error = std::sqrt(of.standard_error);
  return means;
}

// Some 30 comparisons at 4.7 standard errors: a false alarm in 1e-4 of all draws.
void expectAlike(const CameraResult& a, const CameraResult& b) {
  const auto agree = [](const Estimate& x, const Estimate& y) {
    EXPECT_GT(x.value, 0.);
    EXPECT_NEAR(x.value, y.value, 4.7 * std::hypot(x.standard_error, y.standard_error));
  };
  agree(a.mean, b.mean);
  const auto of_a = quarters(a), of_b = quarters(b);
  for (std::size_t i = 0; i < 4; ++i) agree(of_a[i], of_b[i]);
}

TreeMesh leavesAndPlank() {
  TreeMesh mesh = leafBox(120, 5);
  addPolygon(mesh, mesh.wood_triangles, rectangle({0, 0, -0.3f}, {0.4f, 0, 0}, {0, 0.3f, 0.1f}));
  finish(mesh, "leaves and a plank");
  return mesh;
}

}  // namespace

// Check that both ways to trace a picture show the same: leaves and wood in two bands under a low sun.
TEST(R23_LightPicture, ShowsWhatTheEyeSees) {
  const RayScene scene(leavesAndPlank(), Stand{}, true);
  const Direction sun = sunlight(0.9f, 1.f);
  const std::vector<TraceLight> bands{
      {.sun = sun, .leaf = {.reflectance = 0.5f, .transmittance = 0.45f}, .wood_reflectance = 0.6f},
      {.sun = sun, .leaf = {.reflectance = 0.2f, .transmittance = 0.5f}, .wood_reflectance = 0.9f}};
  const PixelRays rays = picture(sunlight(0.8f, -1.f), 0.9f);
  const std::vector<CameraResult> eye = traceCameraBands(scene, bands, rays, -1.f, {.paths = 64 * kSide * kSide});
  const std::vector<CameraResult> light = byLight(scene, bands, rays);
  for (std::size_t band = 0; band < 2; ++band) expectAlike(light[band], eye[band]);
  EXPECT_LT(light[0].mean.standard_error, 0.01 * light[0].mean.value);
}

// The same of two trees, one of them turned, glossy, in fog and among turbid leaves, under the sun's disc and a sky.
TEST(R23_LightPicture, ShowsGlossMediaAndSkyToo) {
  const TreeMesh mesh = leavesAndPlank();
  const std::vector<TraceMedium> media{{.box = {.low = glm::vec3(-1.f), .high = glm::vec3(1.f)}, .density = 0.4f},
                                       {.scatterer = TraceMedium::Scatterer::particles,
                                        .asymmetry = 0.6f,
                                        .box = {.low = glm::vec3(-1.f), .high = glm::vec3(1.f)},
                                        .density = 0.5f}};
  const Stand stand{.trees = {{.position = {-0.4f, 0.f, 0.f}}, {.position = {0.4f, 0.2f, 0.f}, .rotation = 1.f}}};
  const RayScene scene(std::array{&mesh}, stand, true, media);
  TraceLight light{.sun = sunlight(0.5f, 2.f),
                   .leaf = {.reflectance = 0.4f, .transmittance = 0.4f},
                   .sun_diameter = 0.2f,
                   .sky = std::make_shared<const SkyMap>(uniformSky(glm::dvec3(0.3)))};
  light.leaf.gloss = 0.5f;
  light.leaf.gloss_roughness = 0.3f;
  light.of_media = {{.reflectance = 0.5f, .transmittance = 0.4f}, {.reflectance = 0.9f, .transmittance = 0.f}};
  const PixelRays rays = picture(sunlight(1.2f, 0.3f), 1.3f);
  expectAlike(byLight(scene, {light}, rays).front(),
              traceCamera(scene, light, rays, -1.f, {.paths = 64 * kSide * kSide}));
}

// Check that both ways show the same from an eye near the stand, aside of the middle, where pixels at the edge see less
// of it than those in the middle.
TEST(R30_LightPicture, ShowsWhatAnEyeNearbySees) {
  const RayScene scene(leavesAndPlank(), Stand{}, true);
  const TraceLight light{.sun = sunlight(0.9f, 1.f), .leaf = {.reflectance = 0.5f, .transmittance = 0.45f}};
  PixelRays rays = picture(sunlight(0.8f, -1.f), 0.9f);
  rays.eye = glm::vec3(0.3f, -0.2f, 0.f) - 2.2f * rays.sight;
  rays.corner += 1.9f * rays.sight;
  ASSERT_TRUE(LightPictureJob::suits(scene, {light}, rays));
  expectAlike(byLight(scene, {light}, rays).front(),
              traceCamera(scene, light, rays, -1.f, {.paths = 64 * kSide * kSide}));
  rays.eye = glm::vec3(0.f);
  EXPECT_FALSE(LightPictureJob::suits(scene, {light}, rays));
  EXPECT_THROW(LightPictureJob(scene, {light}, rays, 64), InvalidInput);
}

// Check the standard errors: the spread of a pixel's and of the mean's estimates over 60 seeds has an error of 1 / 11.
TEST(R23_LightPicture, StandardErrorsTellTheSpread) {
  const RayScene scene(leavesAndPlank(), Stand{}, true);
  const LightPictureJob job(scene, {{.sun = sunlight(0.4f, 1.f)}}, picture(sunlight(0.6f, 2.f), 0.8f), 256);
  constexpr int kSeeds = 60;
  double sum = 0., squares = 0., told = 0., pixels_told = 0., pixels_squares = 0.;
  std::vector<double> pixel_sums(kSide * kSide);
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const CameraResult result = job.results(traced(job, 16, static_cast<std::uint64_t>(seed))).front();
    sum += result.mean.value / kSeeds;
    squares += std::pow(result.mean.value, 2) / kSeeds;
    told += std::pow(result.mean.standard_error, 2) / kSeeds;
    for (std::size_t i = 0; i < pixel_sums.size(); ++i) {
      pixel_sums[i] += double{result.radiance.values[2 * i]};
      pixels_squares += std::pow(double{result.radiance.values[2 * i]}, 2);
      pixels_told += std::pow(double{result.standard_error.values[i]}, 2);
    }
  }
  for (const double pixel : pixel_sums) pixels_squares -= pixel * pixel / kSeeds;
  // A thousand pixels make the second ratio exact to half a per cent.
  EXPECT_NEAR(std::sqrt(pixels_squares / (kSeeds - 1) / (pixels_told / kSeeds)), 1., 0.03);
  EXPECT_NEAR(std::sqrt((squares - sum * sum) * kSeeds / (kSeeds - 1) / told), 1., 5. / 11.);
}

// Check where light paths are chosen, and where they are refused.
TEST(R23_LightPicture, SuitsStandsSeenWholeOverBlackGround) {
  const TreeMesh mesh = leavesAndPlank();
  const RayScene alone(mesh, Stand{}, true), periodic(mesh, {.period = glm::vec2(3.f)}, true);
  const TraceLight light{.sun = sunlight(0.4f, 1.f)}, on_ground{.sun = sunlight(0.4f, 1.f), .ground_albedo = 0.1f};
  const PixelRays whole = picture(sunlight(0.6f, 2.f), 2.f), near = picture(sunlight(0.6f, 2.f), 0.2f);
  EXPECT_TRUE(LightPictureJob::suits(alone, {light}, whole));
  EXPECT_FALSE(LightPictureJob::suits(alone, {light}, near));
  EXPECT_FALSE(LightPictureJob::suits(alone, {on_ground}, whole));
  EXPECT_FALSE(LightPictureJob::suits(periodic, {light}, whole));
  EXPECT_THROW(LightPictureJob(periodic, {light}, whole, 64), InvalidInput);
  EXPECT_THROW(LightPictureJob(alone, {on_ground}, whole, 64), InvalidInput);
  EXPECT_THROW(LightPictureJob(alone, {light}, whole, 0), InvalidInput);
}
