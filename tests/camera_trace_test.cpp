#include "render/reference/camera_trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/require.hpp"
#include "render/reference/forward_trace.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.f;
constexpr double kInversePi = std::numbers::inv_pi;

// A square picture around `target`, seen along `sight`.
PixelRays picture(Direction sight, glm::vec3 target, float half_width, int side) {
  const Axes axes = axesAlong(sight);
  return {.corner = target - half_width * (axes.right + axes.up),
          .right_step = 2.f * half_width / static_cast<float>(side) * axes.right,
          .down_step = 2.f * half_width / static_cast<float>(side) * axes.up,
          .sight = sight,
          .width = side,
          .height = side};
}

// See agrees() of the forward trace: five standard errors, and rounding of radiances where there is no noise.
testing::AssertionResult agrees(const Estimate& found, double expected) {
  const double allowed = 5. * found.standard_error + 2e-6 * expected;
  if (std::abs(found.value - expected) <= allowed) return testing::AssertionSuccess();
  return testing::AssertionFailure() << found.value << " against " << expected << ", allowed " << allowed;
}

}  // namespace

// Check the radiance of one large horizontal leaf from above and from below: reflectance or transmittance times the
// cosine of the sun over pi, without noise, as light that leaves a flat leaf never comes back. The same for the ground.
TEST(R2_CameraTrace, LoneSurfacesHaveLambertsRadiance) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 3}, {5, 0, 0}, {0, 5, 0}));
  finish(mesh, "leaf");
  const RayScene scene(mesh, Stand{}, true);
  const float zenith = 40.f * kDegree;
  TraceLight light{.sun = sunlight(zenith, 1.f), .leaf = {.reflectance = 0.3f, .transmittance = 0.6f}};
  const double cosine = std::cos(double{zenith});
  const Direction down = sunlight(20.f * kDegree, 2.f);
  const TraceEffort effort{.paths = 5000};

  const CameraResult above = traceCamera(scene, light, picture(down, {0, 0, 3}, 1.f, 16), 0.f, effort);
  EXPECT_NEAR(above.mean.value, 0.3 * cosine * kInversePi, 1e-7);
  EXPECT_NEAR(above.mean.standard_error, 0., 1e-8);
  EXPECT_EQ(above.paths, 20u * 256u);  // whole samples of each pixel
  for (float value : above.radiance.values) EXPECT_NEAR(value, 0.3 * cosine * kInversePi, 1e-7);

  const CameraResult below = traceCamera(scene, light, picture(-down, {0, 0, 3}, 1.f, 16), 0.f, effort);
  EXPECT_NEAR(below.mean.value, 0.6 * cosine * kInversePi, 1e-7);

  light.ground_albedo = 0.2f;
  const CameraResult beside = traceCamera(scene, light, picture(down, {50, 0, 0}, 1.f, 16), 0.f, effort);
  EXPECT_NEAR(beside.mean.value, 0.2 * cosine * kInversePi,
              2e-4);  // a leaf of 100 m^2 shades 0.2 % of the ground's sky
  light.ground_albedo = 0.f;
  EXPECT_EQ(traceCamera(scene, light, picture(down, {50, 0, 0}, 1.f, 16), 0.f, effort).mean.value, 0.);
}

// Check that two full sheets over a reflecting ground, in a periodic stand, look as bright from everywhere as adding
// and doubling says (the closed form of the forward trace's test).
TEST(R2_CameraTrace, TwoSheetsMatchAddingDoubling) {
  TreeMesh mesh;
  for (float z : {2.f, 1.5f}) addPolygon(mesh, mesh.leaf_triangles, rectangle({3, 4, z}, {.5f, 0, 0}, {0, .5f, 0}));
  finish(mesh, "sheets");
  const RayScene scene(mesh, {.period = glm::vec2(1.f)}, true);
  const double r = 0.4, t = 0.5, ground = 0.6;
  const float zenith = 50.f * kDegree;
  const TraceLight light{
      .sun = sunlight(zenith, 1.f), .leaf = {.reflectance = 0.4f, .transmittance = 0.5f}, .ground_albedo = 0.6f};
  const double pair_reflectance = r + t * t * r / (1. - r * r);
  const double pair_transmittance = t * t / (1. - r * r);
  const double reflected =
      pair_reflectance + pair_transmittance * pair_transmittance * ground / (1. - ground * pair_reflectance);
  for (float view : {0.f, 60.f}) {
    const CameraResult result = traceCamera(scene, light, picture(sunlight(view * kDegree, 4.f), {40, -7, 1}, 3.f, 64),
                                            1.2f, {.paths = 100'000});
    EXPECT_TRUE(agrees(result.mean, reflected * std::cos(double{zenith}) * kInversePi)) << view;
    EXPECT_GT(result.mean.standard_error, 0.);
  }
}

// Check the hot spot: seen along the sun's own direction, every leaf that is seen is lit. Leaves reflect so little that
// light scattered twice is below 1e-6 of the whole. A leaf's edge may shade what was just seen past it by the lift of
// rays, 2 um here: 400 edges of 0.65 m over a picture of 4 m^2 are 1e-4 at the most. Shadow offsets of 1e-4 of the
// coordinates, which are usual, would take 1e-2.
TEST(R2_CameraTrace, NothingSeenAlongTheSunIsShaded) {
  Random random(9, 0);
  TreeMesh mesh;
  for (int i = 0; i < 400; ++i)
    addPolygon(mesh, mesh.leaf_triangles,
               disc({2.f * random.uniform() - 1.f, random.uniform() - 0.5f, random.uniform()}, {0, 0, 1}, 0.1));
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, -0.01f}, {2, 0, 0}, {0, 2, 0}));
  finish(mesh, "discs");
  const float zenith = 35.f * kDegree;
  const TraceLight light{.sun = sunlight(zenith, 0.7f), .leaf = {.reflectance = 1e-6f, .transmittance = 0.f}};
  const CameraResult result = traceCamera(RayScene(mesh, Stand{}, true), light,
                                          picture(light.sun, {0, 0, 0.5f}, 1.f, 64), 0.f, {.paths = 200'000});
  EXPECT_NEAR(result.mean.value / (1e-6 * std::cos(double{zenith}) * kInversePi), 1., 1e-4);
}

// Check that turned and moved copies look as one mesh of the same leaves does.
TEST(R2_CameraTrace, CopiesLookLikeTheLeavesTheyAre) {
  const TreeMesh tree = leafBox(150, 2);
  const Stand stand{.trees = {{.position = {0, 0, 0.5f}}, {.position = {0.3f, 0.6f, 0}, .rotation = 1.2f}}};
  TreeMesh flat;
  for (const Placement& copy : stand.trees) {
    const float c = std::cos(copy.rotation), s = std::sin(copy.rotation);
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    for (const glm::vec3& v : tree.vertices)
      flat.vertices.push_back(copy.position + glm::vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z));
    for (const glm::uvec3& t : tree.leaf_triangles) flat.leaf_triangles.push_back(t + first);
  }
  finish(flat, "both");
  const TraceLight light{.sun = sunlight(30.f * kDegree, 1.f), .ground_albedo = 0.3f};
  const PixelRays rays = picture(sunlight(50.f * kDegree, 3.f), {0, 0, 0}, 1.5f, 64);
  const CameraResult a = traceCamera(RayScene(tree, stand, true), light, rays, -1.f, {.paths = 100'000, .seed = 1});
  const CameraResult b = traceCamera(RayScene(flat, Stand{}, true), light, rays, -1.f, {.paths = 100'000, .seed = 2});
  EXPECT_NEAR(a.mean.value, b.mean.value, 5. * std::hypot(a.mean.standard_error, b.mean.standard_error));
  EXPECT_NE(a.mean.value, b.mean.value);
}

// Check that eye paths and sun paths tell the same: light reflected by a periodic crown is the integral of radiance
// times cosine over directions, here by Gauss's rule in cos^2 of three points and eight azimuths. The rule's own error
// is of the order of 1e-3 of a radiance that varies by a tenth.
TEST(R2_CameraTrace, RadianceIntegratesToTheForwardReflectance) {
  const TreeMesh mesh = leafBox(80, 12);
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  const TraceLight light{.sun = sunlight(0.f, 0.f), .ground_albedo = 0.4f};
  double reflected = 0., variance = 0.;
  constexpr double kNodes[] = {0.1127016654, 0.5, 0.8872983346}, kWeights[] = {5. / 18, 8. / 18, 5. / 18};
  for (int node = 0; node < 3; ++node)
    for (int azimuth = 0; azimuth < 8; ++azimuth) {
      const auto zenith = static_cast<float>(std::acos(std::sqrt(kNodes[node])));
      // The picture spans whole periods of what it sees: its steps on the ground are two by one metre.
      const Direction sight = sunlight(zenith, (static_cast<float>(azimuth) + 0.5f) * 45.f * kDegree);
      const PixelRays rays{.corner = {0, 0, 2},
                           .right_step = {2.f / 32, 0, 0},
                           .down_step = {0, 1.f / 32, 0},
                           .sight = sight,
                           .width = 32,
                           .height = 32};
      const CameraResult result = traceCamera(scene, light, rays, scene.box().low.z,
                                              {.paths = 8192, .seed = static_cast<std::uint64_t>(node * 8 + azimuth)});
      const double weight = std::numbers::pi * kWeights[node] / 8.;
      reflected += weight * result.mean.value;
      variance += std::pow(weight * result.mean.standard_error, 2);
    }
  const ForwardResult forward = traceForward(scene, light, {.paths = 100'000});
  EXPECT_NEAR(reflected, forward.reflected.value,
              5. * std::hypot(std::sqrt(variance), forward.reflected.standard_error) + 1e-3);
}

// Check a picture in perspective against the closed form: a flat leaf, seen from an eye, has Lambert's radiance over
// the part of the picture that it covers by the rules of a pinhole, and none beside it; here turned away from the
// picture's plane and aside of its middle. Pixels on the leaf's edges are the only noise.
TEST(R30_CameraTrace, AFlatLeafCoversWhatAPinholeSees) {
  TreeMesh mesh;
  const glm::vec3 middle(0.5f, -0.3f, 3.f), half_x(0.8f, 0.f, 0.3f), half_y(0.f, 0.9f, -0.2f);
  addPolygon(mesh, mesh.leaf_triangles, rectangle(middle, half_x, half_y));
  finish(mesh, "leaf");
  const RayScene scene(mesh, Stand{}, true);
  const float zenith = 40.f * kDegree;
  const TraceLight light{.sun = sunlight(zenith, 1.f), .leaf = {.reflectance = 0.3f, .transmittance = 0.6f}};
  const glm::vec3 normal = glm::normalize(glm::cross(half_x, half_y));
  const double radiance = 0.3 * double{-glm::dot(normal, light.sun)} * kInversePi;
  for (const float depth : {1.f, 40.f, 4000.f}) {  // of the leaf below the eye [m]; the last nearly parallel
    const glm::vec3 eye(0.f, 0.f, 3.f + depth);
    const float half = 3.f / depth;  // of the picture, at 1 m before the eye [m]
    const PixelRays rays{.corner = {-half, half, -1.f},
                         .right_step = {2.f * half / 64, 0, 0},
                         .down_step = {0, -2.f * half / 64, 0},
                         .width = 64,
                         .height = 64,
                         .eye = eye};
    double area = 0.;  // of the leaf in the picture [m^2]
    std::array<glm::dvec2, 4> corners{};
    const float signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::vec3 from_eye = middle + signs[i][0] * half_x + signs[i][1] * half_y - eye;
      corners[i] = glm::dvec2(from_eye) / double{-from_eye.z};
      ASSERT_LT(std::max(std::abs(corners[i].x), std::abs(corners[i].y)), double{half});
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::dvec2 a = corners[i], b = corners[(i + 1) % 4];
      area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    const CameraResult result = traceCamera(scene, light, rays, 0.f, {.paths = 64 * 64 * 64});
    const double expected = radiance * area / std::pow(2. * double{half}, 2);
    // Samples are even over a pixel, so that the edges leave less noise than their standard error tells.
    EXPECT_NEAR(result.mean.value, expected, 5. * result.mean.standard_error) << depth;
    EXPECT_LT(result.mean.standard_error, 4e-3 * expected);
    for (const float value : result.radiance.values) EXPECT_LE(value, static_cast<float>(radiance) * (1.f + 1e-5f));
  }
}

// Check what an eye sees that stands in a periodic stand, over the ground: not what is behind it. Above the eye stands
// a sheet that is not in sight; the sun comes from the side through no leaf, and the ground shows its albedo.
TEST(R30_CameraTrace, AnEyeSeesNothingBehindItself) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 2}, {0.05f, 0, 0}, {0, 0.05f, 0}));
  finish(mesh, "sheet");
  for (const Stand& stand : {Stand{}, Stand{.period = glm::vec2(5.f)}}) {
    const RayScene scene(mesh, stand, true);
    const TraceLight light{.sun = sunlight(0.5f, 0.f), .ground_albedo = 0.5f};
    PixelRays rays{.corner = {-0.01f, -0.01f, -1.f},
                   .right_step = {0.02f / 8, 0, 0},
                   .down_step = {0, 0.02f / 8, 0},
                   .width = 8,
                   .height = 8,
                   .eye = glm::vec3(0.f, 0.f, 1.9f)};
    const double ground = 0.5 * std::cos(0.5) * kInversePi;
    // The leaf is 1e-2 m^2 at 2 m: it sends back 1e-3 of the light below it at the most.
    EXPECT_NEAR(traceCamera(scene, light, rays, 0.f, {.paths = 4096}).mean.value, ground, 2e-3 * ground);
    rays.eye->z = 2.05f;  // now the leaf is in front, and covers all that is seen
    EXPECT_NEAR(traceCamera(scene, {.sun = light.sun}, rays, 0.f, {.paths = 4096}).mean.value,
                double{LeafOptics{}.reflectance} * std::cos(0.5) * kInversePi, 1e-6);
  }
}

// Check that the bits depend on the seed alone, and that work ended early is whole passes.
TEST(R2_CameraTrace, IsTheSameForAnyNumberOfThreads) {
  const TreeMesh mesh = leafBox(100, 1);
  const RayScene scene(mesh, Stand{}, true);
  const TraceLight light{.sun = sunlight(35.f * kDegree, 1.f)};
  const PixelRays rays = picture(sunlight(50.f * kDegree, 3.f), {0, 0, 0}, 1.f, 37);
  const CameraResult one = traceCamera(scene, light, rays, 0.f, {.paths = 12'000, .threads = 1});
  for (int threads : {0, 2, 5}) {
    const CameraResult many = traceCamera(scene, light, rays, 0.f, {.paths = 12'000, .threads = threads});
    EXPECT_EQ(one.radiance.values, many.radiance.values);
    EXPECT_EQ(one.standard_error.values, many.standard_error.values);
    EXPECT_EQ(one.mean.value, many.mean.value);
  }
  EXPECT_NE(one.mean.value, traceCamera(scene, light, rays, 0.f, {.paths = 12'000, .seed = 2}).mean.value);

  const CameraResult first =
      traceCamera(scene, light, rays, 0.f, {.paths = 12'000, .threads = 1}, [](double) { return false; });
  EXPECT_EQ(first.paths, 32u * 32u);  // one sample for each pixel of the first tile
  EXPECT_GT(first.mean.value, 0.);
  EXPECT_TRUE(std::isfinite(first.mean.standard_error));
}

TEST(R2_CameraTrace, RefusesInvalidInput) {
  const TreeMesh mesh = leafBox(5, 1);
  const RayScene single(mesh, Stand{}, true);
  const PixelRays good = picture({0, 0, -1}, {0, 0, 0}, 1.f, 4);
  const auto trace = [&](const PixelRays& rays, float ground) { traceCamera(single, TraceLight{}, rays, ground, {}); };
  PixelRays rays = good;
  rays.width = 0;
  EXPECT_THROW(trace(rays, 0.f), InvalidInput);
  rays = good;
  rays.sight = {0, 0, 0};
  EXPECT_THROW(trace(rays, 0.f), InvalidInput);
  rays = good;
  rays.right_step.x = std::numeric_limits<float>::infinity();
  EXPECT_THROW(trace(rays, 0.f), InvalidInput);
  EXPECT_THROW(trace(good, std::nanf("")), InvalidInput);
  rays = good;
  rays.eye = glm::vec3(0.f, std::numeric_limits<float>::quiet_NaN(), 0.f);
  EXPECT_THROW(trace(rays, 0.f), InvalidInput);
  rays.eye = glm::vec3(0.f);
  rays.corner.z = 0.f;  // pixels in the plane of the eye
  EXPECT_THROW(trace(rays, 0.f), InvalidInput);
  const RayScene periodic(mesh, {.period = glm::vec2(2.f)}, true);
  EXPECT_THROW(traceCamera(periodic, {.ground_albedo = 0.1f}, good, 0.4f, {}), InvalidInput);
}
