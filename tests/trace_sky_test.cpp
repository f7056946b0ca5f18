// Check that light of skies and of the sun's disc gives what closed forms say, that paths of light and paths from the
// eye agree under each of them, and that lights add up. Monte Carlo means are held to 5.3 standard errors, a false
// alarm of 1.2e-7 for each of the 400 or so, more than half of them per leaf; where a sum is exact, to rounding in
// single precision.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>

#include "core/require.hpp"
#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/detail/scene_light.hpp"
#include "render/reference/detail/scene_optics.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/trace_run.hpp"
#include "sky/preetham.hpp"
#include "sky/sky_models.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr double kPi = std::numbers::pi, kDegree = kPi / 180.;
constexpr double kRounding = 3e-6;  // of weights and directions in single precision, relative

using Sky = std::shared_ptr<const SkyMap>;

Sky uniform(double irradiance) {
  return std::make_shared<SkyMap>(uniformSky(glm::dvec3(irradiance)));
}
Sky overcast() {
  return std::make_shared<SkyMap>(overcastSky({0.5, 0.4, 0.3}));
}
Sky clear(double zenith) {
  const ClearSky sky = preethamSky(zenith, 1., 3.);
  return std::make_shared<SkyMap>(sky.sky.scaled(glm::dvec3(1. / sky.sun.y)));
}
// A few patches of colour, one of them 1000 times as bright as the others, and one black.
Sky patches() {
  std::vector<glm::vec3> radiance;
  Random random(3, 0);
  for (int cell = 0; cell < 8 * 15; ++cell)
    radiance.push_back(0.1f * glm::vec3(random.uniform(), random.uniform(), random.uniform()));
  radiance[50] = {100.f, 80.f, 30.f};
  radiance[70] = glm::vec3(0.f);
  return std::make_shared<SkyMap>(8, 15, 0.4f, std::move(radiance));
}

testing::AssertionResult agrees(const Estimate& found, double expected, double noise = 0.) {
  const double allowed = 5.3 * std::hypot(found.standard_error, noise) + kRounding * std::abs(expected);
  if (std::abs(found.value - expected) <= allowed) return testing::AssertionSuccess();
  return testing::AssertionFailure() << found.value << " against " << expected << ", allowed " << allowed;
}
testing::AssertionResult agree(const Estimate& a, const Estimate& b) {
  return agrees(a, b.value, b.standard_error);
}

Estimate times(double factor, const Estimate& a) {
  return {factor * a.value, factor * a.standard_error};
}
Estimate plus(const Estimate& a, const Estimate& b) {
  return {a.value + b.value, std::hypot(a.standard_error, b.standard_error)};
}

std::vector<BrfResult> brf(const RayScene& scene, const std::vector<TraceLight>& bands,
                           const std::vector<ViewDirection>& views, std::uint64_t paths, std::uint64_t seed = 1) {
  const BrfJob job(scene, bands, views, 256);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = seed, .wanted = {0, job.unitsOf(paths)}}, sums);
  return job.results(sums);
}

// A square picture around the origin, seen along `sight`.
PixelRays picture(Direction sight, float half_width, int side) {
  const Axes axes = axesAlong(sight);
  return {.corner = -half_width * (axes.right + axes.up),
          .right_step = 2.f * half_width / static_cast<float>(side) * axes.right,
          .down_step = 2.f * half_width / static_cast<float>(side) * axes.up,
          .sight = sight,
          .width = side,
          .height = side};
}

const glm::vec3 kTilted = glm::normalize(glm::vec3(0.4f, -0.7f, 0.5f));

// One large leaf of that normal.
TreeMesh tiltedLeaf(float half_side) {
  const Axes axes = axesAlong(kTilted);
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 0}, half_side * axes.right, half_side * axes.up));
  finish(mesh, "leaf");
  return mesh;
}

// Irradiance of one side of a plane, by the midpoint rule on steps of a quarter of a degree.
double irradianceOf(const SkyMap& sky, int band, const glm::vec3& normal) {
  constexpr int kRows = 360;
  constexpr double kStep = 0.5 * kPi / kRows;
  double sum = 0.;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < 4 * kRows; ++column) {
      const double zenith = (row + 0.5) * kStep, azimuth = (column + 0.5) * kStep + double{sky.firstAzimuth()};
      const glm::vec3 d(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith));
      sum +=
          double{sky.radiance(d)[band]} * std::max(0., double{glm::dot(normal, d)}) * std::sin(zenith) * kStep * kStep;
    }
  return sum;
}

struct SceneOfLeaves {
  TreeMesh mesh = leafBox(60, 12);
  RayScene scene{mesh, {.period = glm::vec2(2.f, 1.f)}, true};
};

// Three bands, of the sky's three.
std::vector<TraceLight> threeBands(const Sky& sky, const glm::vec3& sun_irradiance, float diameter) {
  std::vector<TraceLight> bands;
  for (int band = 0; band < kBands; ++band)
    bands.push_back({.sun = sunlight(0.7f, 1.f),
                     .leaf = {.reflectance = 0.5f - 0.2f * static_cast<float>(band), .transmittance = 0.3f},
                     .ground_albedo = 0.4f,
                     .sun_irradiance = sun_irradiance[band],
                     .sun_diameter = diameter,
                     .sky = sky,
                     .sky_band = band});
  return bands;
}

}  // namespace

// Check the furnace: under a sky of radiance 1, white leaves over white ground have radiance 1 everywhere, reflect as
// they are lit, absorb nothing, and every side of every leaf receives pi.
TEST(R18_TraceSky, FurnaceOfWhiteLeavesShowsRadianceOne) {
  const SceneOfLeaves of;
  const TraceLight light{.leaf = {.reflectance = 0.3f, .transmittance = 0.7f},
                         .wood_reflectance = 1.f,
                         .ground_albedo = 1.f,
                         .sun_irradiance = 0.f,
                         .sky = uniform(kPi)};
  const float low = of.scene.box().low.z;
  for (const float zenith : {30.f, 80.f, 120.f}) {  // the last looks up: leaves from below, and the sky
    const CameraResult seen = traceCamera(
        of.scene, light, picture(sunlight(zenith * static_cast<float>(kDegree), 2.f), 1.f, 32), low, {.paths = 16'384});
    EXPECT_TRUE(agrees(seen.mean, 1.)) << zenith;
    EXPECT_LT(seen.mean.standard_error, 0.02);
  }
  const CameraResult alone = traceCamera(RayScene(of.mesh, Stand{}, true), light, picture(sunlight(1.f, 2.f), 1.f, 32),
                                         low, {.paths = 16'384});
  EXPECT_TRUE(agrees(alone.mean, 1.));
  const BrfResult factors = brf(of.scene, {light}, {{0.3, 1.}, {1.2, 4.}}, 20'000).front();
  for (const ReflectanceParts& view : {factors.views[0], factors.views[1], factors.albedo})
    EXPECT_TRUE(agrees(view.whole, 1.));
}

// The same with all at once that sends on all light it gets: glossy leaves, turbid leaves, fog with a strong forward
// peak, a white ground. Half a per mill of the gloss is the error of its table (R20).
TEST(R18_TraceSky, FurnaceHoldsGlossTurbidLeavesAndFogToo) {
  const TreeMesh mesh = leafBox(60, 12);
  constexpr float kEverywhere = std::numeric_limits<float>::infinity();
  const Bounds layer{.low = {-kEverywhere, -kEverywhere, -0.5f}, .high = {kEverywhere, kEverywhere, 0.5f}};
  const std::vector<TraceMedium> media{
      {.scatterer = TraceMedium::Scatterer::leaves, .box = layer, .density = 1.5f},
      {.scatterer = TraceMedium::Scatterer::particles, .asymmetry = 0.8f, .box = layer, .density = 2.f}};
  const RayScene scene(std::array{&mesh}, {.period = glm::vec2(2.f, 1.f)}, true, media);
  const float gloss = 0.5f;
  TraceLight light{.leaf = {.reflectance = 0.3f, .transmittance = 0.7f},
                   .ground_albedo = 1.f,
                   .sun_irradiance = 0.f,
                   .sky = uniform(kPi)};
  light.of_media = {{.reflectance = 0.6f, .transmittance = 0.4f}, {.reflectance = 1.f, .transmittance = 0.f}};
  light.leaf.gloss = gloss;
  light.leaf.gloss_roughness = 0.3f;
  // A path is scattered by some three leaves on the mean.
  const double table = 3. * 5e-4 * double{gloss};
  for (const float zenith : {20.f, 75.f}) {
    const CameraResult seen =
        traceCamera(scene, light, picture(sunlight(zenith * static_cast<float>(kDegree), 2.f), 1.f, 32),
                    scene.box().low.z, {.paths = 32'768});
    EXPECT_TRUE(agrees(seen.mean, 1., table / 5.3)) << zenith;
    EXPECT_LT(seen.mean.standard_error, 0.01);
  }
  const BrfResult factors = brf(scene, {light}, {{0.3, 1.}, {1.2, 4.}}, 20'000).front();
  for (const ReflectanceParts& view : {factors.views[0], factors.views[1], factors.albedo})
    EXPECT_TRUE(agrees(view.whole, 1., table / 5.3));
  const ForwardResult result = traceForward(scene, light, {.paths = 20'000});
  EXPECT_TRUE(
      agrees(result.reflected, 1., table / 5.3));  // a glossy reflection is weighed: no leaf is white path by path
  EXPECT_TRUE(agrees(result.absorbed_leaves, 0., table / 5.3));
  EXPECT_LT(result.reflected.standard_error, 0.002);
  EXPECT_NEAR(result.absorbed_particles->value, 0., kRounding * 10.);
}

TEST(R19_TraceSky, FurnaceOfWhiteLeavesLightsAllSidesAlike) {
  const SceneOfLeaves of;
  const TraceLight light{.leaf = {.reflectance = 0.3f, .transmittance = 0.7f},
                         .ground_albedo = 1.f,
                         .sun_irradiance = 0.f,
                         .sky = uniform(kPi)};
  const ForwardResult result = traceForward(of.scene, light, {.paths = 40'000});
  EXPECT_NEAR(result.reflected.value, 1., kRounding * 10.);  // weights drift by a rounding step at each scattering
  EXPECT_NEAR(result.absorbed_leaves.value, 0., kRounding * 10.);
  EXPECT_EQ(result.absorbed_ground.value, 0.);
  EXPECT_EQ(result.sky_share, 1.);
  double mean_front = 0., variance = 0.;
  for (std::size_t leaf = 0; leaf < result.leaf_front.size(); ++leaf) {
    EXPECT_TRUE(agrees(result.leaf_front[leaf], kPi)) << leaf;
    EXPECT_TRUE(agrees(result.leaf_back[leaf], kPi)) << leaf;
    mean_front += result.leaf_front[leaf].value / 60.;
    variance += std::pow(result.leaf_front[leaf].standard_error / 60., 2);
  }
  EXPECT_NEAR(mean_front / kPi, 1., 0.02);  // 5 standard errors of 60 leaves that share paths
  EXPECT_LT(std::sqrt(variance), 0.02 * kPi);
}

// Check the light that reaches either side of a lone tilted leaf, as paths of light count it in the box around it,
// against the integral over the sky; the leaf is black, so that all of it is direct. And the radiance that the eye sees
// of a leaf that scatters: reflectance times the light on the side seen and transmittance times that on the other, over
// pi. The midpoint rule misses 1e-4 where the edge of a patch or the leaf's own horizon falls between its nodes.
TEST(R19_TraceSky, LoneLeafReceivesTheIntegralOverTheSky) {
  const TreeMesh mesh = tiltedLeaf(0.5f);
  const RayScene scene(mesh, Stand{}, true);
  for (const Sky& sky : {uniform(kPi), overcast(), clear(0.9), patches()}) {
    const double front = irradianceOf(*sky, 1, kTilted), back = irradianceOf(*sky, 1, -kTilted);
    const TraceLight black{.leaf = {0.f, 0.f}, .sun_irradiance = 0.f, .sky = sky, .sky_band = 1};
    const ForwardResult found = traceForward(scene, black, {.paths = 100'000});
    EXPECT_TRUE(agrees(found.leaf_front[0], front, 3e-5 * front));
    EXPECT_TRUE(agrees(found.leaf_back[0], back, 3e-5 * front));
    EXPECT_TRUE(agrees(found.leaf_direct[0], front + back, 3e-5 * front));
    TraceLight grey = black;
    grey.leaf = {.reflectance = 0.3f, .transmittance = 0.6f};
    for (const float side : {1.f, -1.f}) {
      const CameraResult seen = traceCamera(scene, grey, picture(-side * kTilted, 0.2f, 8), -1.f, {.paths = 20'000});
      const double expected = (side > 0.f ? 0.3 * front + 0.6 * back : 0.3 * back + 0.6 * front) / kPi;
      EXPECT_TRUE(agrees(seen.mean, expected, 3e-5 * front));
      EXPECT_LT(seen.mean.standard_error, 0.02 * expected);
    }
  }
  // In closed form: a uniform sky of radiance 1 gives pi (1 + cos) / 2 to the upper side.
  EXPECT_NEAR(irradianceOf(*uniform(kPi), 0, kTilted), 0.5 * kPi * (1. + double{kTilted.z}), 3e-4);
}

// Check the sun's disc: as long as all of it stands on one side of a leaf, the leaf receives the cosine of its middle,
// however wide it is, whether or not the disc reaches over the planes of the box's sides; forward and from the eye.
TEST(R19_TraceSky, DiscOfTheSunGivesTheCosineOfItsMiddle) {
  const TreeMesh mesh = tiltedLeaf(0.5f);
  const RayScene scene(mesh, Stand{}, true);
  for (const double diameter : {0.533, 10., 40.})
    for (const double azimuth : {0., -50.}) {
      const TraceLight light{.sun = sunlight(static_cast<float>(35. * kDegree), static_cast<float>(azimuth * kDegree)),
                             .leaf = {.reflectance = 0.3f, .transmittance = 0.f},
                             .sun_diameter = static_cast<float>(diameter * kDegree)};
      const double cosine = -double{glm::dot(kTilted, light.sun)};
      ASSERT_GT(cosine, std::sin(0.5 * diameter * kDegree));
      const ForwardResult found = traceForward(scene, light, {.paths = 100'000});
      EXPECT_TRUE(agrees(found.leaf_front[0], cosine)) << diameter << " " << azimuth;
      EXPECT_EQ(found.leaf_back[0].value, 0.);
      EXPECT_EQ(found.sky_share, 0.);
      const CameraResult seen = traceCamera(scene, light, picture(-kTilted, 0.2f, 8), -1.f, {.paths = 20'000});
      // The smallest disc's light is met by chance, and not drawn, in less than one path of all, which then brings as
      // much as the others on the mean: too rare for the standard error to know.
      EXPECT_TRUE(agrees(seen.mean, 0.3 * cosine / kPi, 0.3 * cosine / kPi / 20'000.)) << diameter << " " << azimuth;
    }
}

// Check that an eye that looks into the sun's disc sees its radiance, and one that looks beside it does not.
TEST(R18_TraceSky, EyeSeesTheDiscItself) {
  const TreeMesh mesh = tiltedLeaf(0.1f);
  const RayScene scene(mesh, Stand{}, true);
  const TraceLight light{.sun = sunlight(0.5f, 1.f), .sun_diameter = static_cast<float>(2. * kDegree)};
  const auto mean = [&](float zenith) {
    PixelRays rays = picture(-sunlight(zenith, 1.f), 0.1f, 4);
    rays.corner += glm::vec3(5.f, 0.f, 0.f);
    return traceCamera(scene, light, rays, -1.f, {.paths = 1000}).mean.value;
  };
  EXPECT_NEAR(mean(0.5f) * kPi * std::pow(std::sin(kDegree), 2), 1., 1e-5);
  EXPECT_GT(mean(0.5f + static_cast<float>(0.98 * kDegree)), 0.);
  EXPECT_EQ(mean(0.5f + static_cast<float>(1.02 * kDegree)), 0.);
}

// Check that a disc of the sun's size and a point light a crown alike: penumbras change sums over many leaves by less
// than 1e-3, as their width is 5 mm where leaves are 0.2 m wide and 1 m apart.
TEST(R19_TraceSky, SmallDiscIsThePointInTheLimit) {
  const SceneOfLeaves of;
  TraceLight light{.sun = sunlight(0.7f, 1.f), .ground_albedo = 0.3f};
  const ForwardResult point = traceForward(of.scene, light, {.paths = 50'000, .seed = 1});
  const BrfResult seen_point = brf(of.scene, {light}, {{0.4, 2.}}, 15'000, 3).front();
  light.sun_diameter = kLeastSunDiameter;
  const ForwardResult disc = traceForward(of.scene, light, {.paths = 50'000, .seed = 2});
  const BrfResult seen_disc = brf(of.scene, {light}, {{0.4, 2.}}, 15'000, 4).front();
  EXPECT_TRUE(agrees(disc.reflected, point.reflected.value, std::hypot(point.reflected.standard_error, 2e-4)));
  EXPECT_TRUE(agrees(disc.arriving_ground_direct, point.arriving_ground_direct.value,
                     std::hypot(point.arriving_ground_direct.standard_error, 2e-4)));
  for (const auto& [a, b] : {std::pair{seen_disc.albedo, seen_point.albedo}, {seen_disc.views[0], seen_point.views[0]}})
    EXPECT_TRUE(agrees(a.whole, b.whole.value, std::hypot(b.whole.standard_error, 2e-4)));
}

// Check that paths of light and paths from the eye find the same reflected light under each sky, with and without sun,
// in three bands of other colours on one path.
TEST(R18_TraceSky, EyeAndLightAgreeUnderEverySky) {
  const SceneOfLeaves of;
  struct Case {
    Sky sky;
    glm::vec3 sun;
    float diameter;
  };
  for (const Case& c : {Case{uniform(0.3), glm::vec3(0.f), 0.f}, Case{overcast(), {1.f, 0.8f, 0.5f}, 0.f},
                        Case{clear(0.7), {1.f, 0.9f, 0.8f}, static_cast<float>(0.533 * kDegree)},
                        Case{patches(), {0.f, 0.2f, 0.f}, 0.3f}}) {
    const std::vector<TraceLight> bands = threeBands(c.sky, c.sun, c.diameter);
    const std::vector<BrfResult> seen = brf(of.scene, bands, {{0.3, 0.}}, 15'000);
    const std::vector<ForwardResult> sent = traceForwardBands(of.scene, bands, {.paths = 25'000, .seed = 2});
    for (std::size_t band = 0; band < bands.size(); ++band) {
      EXPECT_TRUE(agree(seen[band].albedo.whole, sent[band].reflected)) << band;
      EXPECT_TRUE(agree(seen[band].albedo.ground_once, sent[band].reflected_by_order.ofOrder(0))) << band;
      EXPECT_LT(seen[band].albedo.whole.standard_error, 0.05 * seen[band].albedo.whole.value);
      const double sum =
          sent[band].reflected.value + sent[band].absorbed_leaves.value + sent[band].absorbed_ground.value;
      EXPECT_NEAR(sum, 1., 0.05);  // see forward_trace.hpp; weights below 3: five times 1.5 / sqrt(25,000)
      const double level = double{c.sun[static_cast<int>(band)]} * std::cos(0.7),
                   sky = c.sky->irradiance()[static_cast<int>(band)];
      EXPECT_NEAR(sent[band].sky_share, sky / (level + sky), 1e-6);
    }
    // Alone, on paths of its own, a band finds the same, and no light is made or lost.
    const ForwardResult alone = traceForward(of.scene, bands[2], {.paths = 25'000, .seed = 5});
    EXPECT_TRUE(agree(alone.reflected, sent[2].reflected));
    EXPECT_TRUE(agree(alone.arriving_ground_direct, sent[2].arriving_ground_direct));
    EXPECT_NEAR(alone.reflected.value + alone.absorbed_leaves.value + alone.absorbed_ground.value, 1., 1e-12);
  }
}

// Check that what sun and sky give together is what they give one by one: irradiance of the leaves and radiance seen.
TEST(R19_TraceSky, LightsAddUp) {
  const SceneOfLeaves of;
  const TraceLight sun{.sun = sunlight(0.7f, 1.f), .ground_albedo = 0.3f, .sun_irradiance = 0.8f};
  TraceLight sky = sun, both = sun;
  sky.sun_irradiance = 0.f;
  sky.sky = both.sky = clear(0.7);
  const auto forward = [&](const TraceLight& light, std::uint64_t seed) {
    return traceForward(of.scene, light, {.paths = 30'000, .seed = seed});
  };
  const ForwardResult f_sun = forward(sun, 1), f_sky = forward(sky, 2), f_both = forward(both, 3);
  const double of_sun = 0.8 * std::cos(0.7), of_sky = both.sky->irradiance().x;  // of a horizontal plane
  const auto sum = [&](const auto& figure) { return plus(times(of_sun, figure(f_sun)), times(of_sky, figure(f_sky))); };
  const auto absorbed = [](const ForwardResult& r) { return r.absorbed_leaves; };
  const auto direct = [](const ForwardResult& r) { return r.arriving_ground_direct; };
  EXPECT_TRUE(agree(times(of_sun + of_sky, absorbed(f_both)), sum(absorbed)));
  EXPECT_TRUE(agree(times(of_sun + of_sky, direct(f_both)), sum(direct)));
  for (std::size_t leaf = 0; leaf < f_both.leaf_front.size(); ++leaf) {
    EXPECT_TRUE(agree(f_both.leaf_front[leaf], plus(f_sun.leaf_front[leaf], f_sky.leaf_front[leaf]))) << leaf;
    EXPECT_TRUE(agree(f_both.leaf_direct[leaf], plus(f_sun.leaf_direct[leaf], f_sky.leaf_direct[leaf]))) << leaf;
  }
  const auto albedo = [&](const TraceLight& light, std::uint64_t seed) {
    return brf(of.scene, {light}, {{0.3, 0.}}, 15'000, seed).front().albedo.whole;
  };
  EXPECT_TRUE(agree(times(of_sun + of_sky, albedo(both, 1)),
                    plus(times(of_sun, albedo(sun, 2)), times(of_sky, albedo(sky, 3)))));
}

// Check the three estimators of what a leaf sends on of a sky with a small bright patch and a disc: light drawn alone,
// light met alone, and both by the balance heuristic, against the integral over the sky; and that the last is the least
// noisy of them or near it.
TEST(R18_TraceSky, DrawnAndMetLightHaveOneMean) {
  using namespace sunfleck::detail;
  const Sky sky = patches();
  const std::vector<TraceLight> bands{{.sun = sunlight(0.5f, -1.f),
                                       .leaf = {.reflectance = 0.5f, .transmittance = 0.2f},
                                       .sun_diameter = 0.3f,
                                       .sky = sky,
                                       .sky_band = 0}};
  const SceneLight light(bands);
  const RayScene scene(tiltedLeaf(0.5f), Stand{}, false);
  const SceneOptics<1> optics(bands, scene.geometry());
  const glm::vec3 sight = -kTilted;
  const Hit hit{.surface = Surface::leaf, .normal = kTilted};
  const double to_sun = -double{glm::dot(kTilted, bands.front().sun)};
  ASSERT_GT(to_sun, std::sin(0.15));  // all of the disc is in front
  const double expected =
      (0.5 * (irradianceOf(*sky, 0, kTilted) + to_sun) + 0.2 * irradianceOf(*sky, 0, -kTilted)) / kPi;
  constexpr int kSamples = 200'000;
  std::array<double, 3> sums{}, squares{};
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    PathRandom random(Stream::light, 6, i);
    std::array<double, 3> found{};
    light.draw<1>(random, [&](const DrawnLight<1>& drawn) {
      const double sent = double{optics.sent(hit, sight, drawn.to_light)[0]} * double{drawn.radiance[0]};
      found[0] += sent / double{drawn.density};
      found[2] += sent / double{drawn.density + optics.density(hit, sight, BandLanes<1>::all(1.f), drawn.to_light)};
    });
    BandLanes<1> weight = BandLanes<1>::all(1.f);
    const Onward onward = optics.scatter(hit, sight, weight, random);
    if (onward.fate != Fate::absorbed) {
      const float density = optics.density(hit, sight, BandLanes<1>::all(1.f), onward.direction);
      found[1] += double{weight[0]} * double{light.met<1>(onward.direction, std::numeric_limits<float>::infinity())[0]};
      found[2] += double{weight[0]} * double{light.met<1>(onward.direction, density)[0]};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      sums[k] += found[k] / kSamples;
      squares[k] += found[k] * found[k] / kSamples;
    }
  }
  std::array<double, 3> errors{};
  for (std::size_t k = 0; k < 3; ++k) {
    errors[k] = std::sqrt((squares[k] - sums[k] * sums[k]) / kSamples);
    EXPECT_NEAR(sums[k], expected, 5. * errors[k] + 3e-4 * expected) << k;  // the rule's nodes against the patches
    EXPECT_LT(errors[k], 0.05 * expected) << k;
  }
  EXPECT_LT(errors[2], 1.1 * std::min(errors[0], errors[1]));
}

// Check that what changes the light is part of what tells one run from another.
TEST(R18_TraceSky, IdentityCoversTheLight) {
  const SceneOfLeaves of;
  const TraceLight light{.sun = sunlight(0.5f, 1.f), .sky = uniform(0.2)};
  const auto identity = [&](const std::function<void(TraceLight&)>& change) {
    TraceLight changed = light;
    change(changed);
    return ForwardJob(of.scene, {changed}, 64).identity();
  };
  const TraceIdentity same = identity([](TraceLight&) {});
  EXPECT_EQ(same, identity([](TraceLight& l) { l.sky = uniform(0.2); }));
  EXPECT_NE(same, identity([](TraceLight& l) { l.sky = uniform(0.3); }));
  EXPECT_NE(same, identity([](TraceLight& l) { l.sky = nullptr; }));
  EXPECT_NE(same, identity([](TraceLight& l) { l.sky_band = 1; }));
  EXPECT_NE(same, identity([](TraceLight& l) { l.sun_irradiance = 0.5f; }));
  EXPECT_NE(same, identity([](TraceLight& l) { l.sun_diameter = 0.01f; }));
}

TEST(R19_TraceSky, RefusesInvalidLight) {
  const SceneOfLeaves of;
  const auto trace = [&](const TraceLight& light) { traceForward(of.scene, light, {.paths = 64}); };
  EXPECT_THROW(trace({.sun_irradiance = -1.f}), InvalidInput);
  EXPECT_THROW(trace({.sun_irradiance = 11.f}), InvalidInput);
  EXPECT_THROW(trace({.sun_irradiance = std::nanf("")}), InvalidInput);
  EXPECT_THROW(trace({.sun_irradiance = 0.f}), InvalidInput);  // no light at all
  EXPECT_THROW(trace({.sun_irradiance = 0.f, .sky = uniform(0.)}), InvalidInput);
  EXPECT_THROW(trace({.sun_diameter = 1e-4f}), InvalidInput);
  EXPECT_THROW(trace({.sun_diameter = 2.f}), InvalidInput);
  EXPECT_THROW(trace({.sun = sunlight(1.5f, 0.f), .sun_diameter = 0.2f}), InvalidInput);  // sets
  EXPECT_THROW(trace({.sky = uniform(1.), .sky_band = 3}), InvalidInput);
  EXPECT_THROW(traceForwardBands(of.scene, {{.sky = uniform(1.)}, {.sky = uniform(1.)}}, {.paths = 64}), InvalidInput);
  EXPECT_THROW(traceForwardBands(of.scene, {{.sun_diameter = 0.1f}, {.sun_diameter = 0.2f}}, {.paths = 64}),
               InvalidInput);
}
