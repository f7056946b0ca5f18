#include "render/reference/forward_trace.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/require.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.f;

// A Monte Carlo mean against a known value. Five standard errors of 64 units and more are a false alarm of 5e-6; the
// absolute term is rounding where there is no noise at all.
testing::AssertionResult agrees(const Estimate& found, double expected, double noise = 0.) {
  const double allowed = 5. * std::hypot(found.standard_error, noise) + 2e-6;
  if (std::abs(found.value - expected) <= allowed) return testing::AssertionSuccess();
  return testing::AssertionFailure() << found.value << " against " << expected << ", allowed " << allowed;
}
testing::AssertionResult agree(const Estimate& a, const Estimate& b) {
  return agrees(a, b.value, b.standard_error);
}

double energy(const ForwardResult& r) {
  return r.reflected.value + r.absorbed_leaves.value + r.absorbed_wood.value + r.absorbed_ground.value;
}

Estimate leafIrradiance(const ForwardResult& r, std::size_t leaf) {
  return {r.leaf_irradiance[leaf], r.leaf_standard_error[leaf]};
}

// Two horizontal sheets of 1 x 1 m, half a metre apart.
TreeMesh twoSheets() {
  TreeMesh mesh;
  for (float z : {2.f, 1.5f}) addPolygon(mesh, mesh.leaf_triangles, rectangle({3, 4, z}, {.5f, 0, 0}, {0, .5f, 0}));
  finish(mesh, "sheets");
  return mesh;
}

}  // namespace

// Check that no light is made or lost, whatever absorbs it: each path ends with the weight it began with, so only
// rounding of the sums remains.
TEST(R1_ForwardTrace, ConservesEnergy) {
  const TreeMesh mesh = leafBox(150, 3);
  for (float albedo : {0.f, 0.5f, 1.f})
    for (float ground : {0.f, 1.f}) {
      Stand stand{.period = glm::vec2(1.3f, 0.8f)};
      const RayScene scene(mesh, stand, true);
      const ForwardResult result = traceForward(scene,
                                                {.sun = sunlight(40.f * kDegree, 1.f),
                                                 .leaf = {.reflectance = albedo * 0.5f, .transmittance = albedo * 0.5f},
                                                 .ground_albedo = ground},
                                                {.paths = 6400});
      EXPECT_NEAR(energy(result), 1., 1e-12) << albedo << " " << ground;
      if (albedo == 1.f) {
        EXPECT_NEAR(result.absorbed_leaves.value, 0., 1e-5);  // rounding of weights in single precision
      }
      if (albedo == 0.f && ground == 0.f) {
        EXPECT_EQ(result.reflected.value, 0.);
        EXPECT_EQ(result.arriving_ground.value, result.arriving_ground_direct.value);
      }
      if (ground == 1.f) {
        EXPECT_EQ(result.absorbed_ground.value, 0.);
      }
    }
}

// Check that a horizontal leaf that fills the box's top receives exactly the sun's irradiance, that a lone flat leaf is
// lit once, and what becomes of that light. Error: rounding of sums; for the shares see agrees().
TEST(R1_ForwardTrace, HorizontalLeafUnderZenithSun) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({1, 2, 3}, {1, 0, 0}, {0, 2, 0}));
  finish(mesh, "leaf");
  const RayScene scene(mesh, Stand{}, true);
  const ForwardResult result =
      traceForward(scene, {.leaf = {.reflectance = 0.3f, .transmittance = 0.5f}}, {.paths = 64'000});
  EXPECT_NEAR(result.leaf_irradiance[0], 1., 1e-12);
  EXPECT_NEAR(result.leaf_standard_error[0], 0., 1e-12);
  EXPECT_TRUE(agrees(result.reflected, 0.3));
  EXPECT_TRUE(agrees(result.arriving_ground, 0.5));
  EXPECT_EQ(result.arriving_ground_direct.value, 0.);
  EXPECT_NEAR(result.absorbed_leaves.value, 0.2, 1e-7);  // an albedo of 0.8f is 0.8 to half an ulp
  EXPECT_EQ(result.paths, 64'000u);
}

// Check that a flat leaf of ten triangles, however it is turned and wherever it stands, is never met again by the light
// that leaves it: the same sun rays count as often on a leaf that scatters all as on one that absorbs all.
TEST(R1_ForwardTrace, FlatLeafDoesNotMeetItself) {
  Random random(11, 0);
  for (int i = 0; i < 40; ++i) {
    TreeMesh mesh;
    addPolygon(mesh, mesh.leaf_triangles, disc({0.3f, -0.1f, 7.f}, onSphere(random), 0.1));
    finish(mesh, "leaf");
    Stand stand;
    if (i % 2) stand.trees = {{.position = {1e5f, -3e4f, 200.f}, .rotation = 1.f + static_cast<float>(i)}};
    const RayScene scene(mesh, stand, true);
    const Direction sun = sunlight(50.f * kDegree, random.uniform() * 6.f);
    const TraceEffort effort{.paths = 6400};
    const ForwardResult white =
        traceForward(scene, {.sun = sun, .leaf = {.reflectance = 0.5f, .transmittance = 0.5f}}, effort);
    const ForwardResult black = traceForward(scene, {.sun = sun, .leaf = {0.f, 0.f}}, effort);
    EXPECT_EQ(white.leaf_irradiance, black.leaf_irradiance) << i;
    EXPECT_GT(black.absorbed_leaves.value, 0.);
    EXPECT_NEAR(white.absorbed_leaves.value, 0., 1e-6);  // rounding of weights in single precision
  }
}

// Check two sheets without end, each of a kind of its own, in the order of the kinds and against it: with r and t of
// the upper (a) and of the lower (b), D = t_a / (1 - r_a r_b) arrives at the lower and D r_b comes back up.
TEST(R1_ForwardTrace, EachKindHasItsOpticsAndLeaves) {
  const auto sheet = [](float z) {
    TreeMesh mesh;
    addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, z}, {.5f, 0, 0}, {0, .5f, 0}));
    finish(mesh, "sheet");
    return mesh;
  };
  const TreeMesh high = sheet(2.f), low = sheet(1.5f);
  const LeafOptics a{.reflectance = 0.5f, .transmittance = 0.4f}, b{.reflectance = 0.3f, .transmittance = 0.1f};
  const double down = 0.4 / (1. - 0.5 * 0.3), up = 0.3 * down;
  for (const std::size_t first : {0u, 1u}) {  // whether the upper is
    const std::array kinds = first == 0 ? std::array{&high, &low} : std::array{&low, &high};
    const Stand stand{.trees = {{.kind = 0}, {.position = {0.3f, 0.1f, 0.f}, .kind = 1}}, .period = glm::vec2(1.f)};
    const RayScene scene(kinds, stand, true);
    TraceLight light{.of_kinds = {{a, 0.f}, {b, 0.f}}};
    if (first == 1) std::swap(light.of_kinds[0], light.of_kinds[1]);
    const ForwardResult result = traceForward(scene, light, {.paths = 200'000});
    ASSERT_EQ(result.leaf_irradiance.size(), 2u);
    EXPECT_TRUE(agrees(leafIrradiance(result, first), 1. + up));
    EXPECT_TRUE(agrees(leafIrradiance(result, 1 - first), down));
    EXPECT_TRUE(agrees(result.reflected, 0.5 + 0.4 * up));
    EXPECT_TRUE(agrees(result.arriving_ground, 0.1 * down));
  }
}

// Check that a leaf's irradiance is the mean over the trees of its kind, however many of the other kind there are.
TEST(R1_ForwardTrace, IrradianceIsTheMeanOverTheTreesOfItsKind) {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.4f, -0.7f, 0.5f));
  TreeMesh level, tilted;
  addPolygon(level, level.leaf_triangles, disc({0, 0, 1}, {0, 0, 1}, 0.3));
  addPolygon(tilted, tilted.leaf_triangles, disc({0, 0, 1}, normal, 0.2));
  finish(level, "level");
  finish(tilted, "tilted");
  const RayScene scene(std::array<const TreeMesh*, 2>{&level, &tilted},
                       {.trees = {{}, {.position = {0, 20, 0}, .kind = 1}, {.position = {0, -20, 0}, .kind = 1}}},
                       true);
  const ForwardResult result = traceForward(scene, {.leaf = {0.f, 0.f}}, {.paths = 1'000'000});
  EXPECT_TRUE(agrees(leafIrradiance(result, 0), 1.));
  EXPECT_TRUE(agrees(leafIrradiance(result, 1), std::abs(double{normal.z})));
}

// Check the irradiance |n . s| of a lone tilted leaf, single or in a sparse stand of turned copies, for a tilted sun.
TEST(R1_ForwardTrace, TiltedLeafReceivesTheCosine) {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.4f, -0.7f, 0.5f));
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, disc({0, 0, 1}, normal, 0.3));
  finish(mesh, "leaf");
  const Direction sun = sunlight(60.f * kDegree, 40.f * kDegree);
  const TraceEffort effort{.paths = 200'000};

  const RayScene single(mesh, Stand{}, true);
  const ForwardResult one = traceForward(single, {.sun = sun}, effort);
  EXPECT_TRUE(agrees(leafIrradiance(one, 0), std::abs(double{glm::dot(normal, sun)})));

  // Two copies 30 m apart, one turned by a quarter; what each scatters onto the other is below 1e-5.
  const RayScene pair(mesh, {.trees = {{}, {.position = {0, 30, 0}, .rotation = 90.f * kDegree}}}, true);
  const glm::vec3 turned(-normal.y, normal.x, normal.z);
  const double mean = 0.5 * (std::abs(double{glm::dot(normal, sun)}) + std::abs(double{glm::dot(turned, sun)}));
  const ForwardResult two = traceForward(pair, {.sun = sun}, {.paths = 1'000'000});
  EXPECT_TRUE(agrees(leafIrradiance(two, 0), mean, 1e-5));
}

// Check the whole budget and both irradiances between two full sheets over a reflecting ground against the closed form
// of multiple reflection: sheets that scatter by Lambert's law pass diffuse light on as they pass sunlight.
TEST(R1_ForwardTrace, TwoSheetsMatchAddingDoubling) {
  const TreeMesh mesh = twoSheets();
  const RayScene scene(mesh, {.period = glm::vec2(1.f)}, true);
  for (const auto& [r, t, ground] : {std::tuple{0.3, 0.5, 0.}, {0.6, 0.4, 0.5}, {0.05, 0.02, 0.15}, {0.5, 0.5, 0.}}) {
    const float zenith = 55.f * kDegree;
    const ForwardResult result =
        traceForward(scene,
                     {.sun = sunlight(zenith, 0.3f),
                      .leaf = {.reflectance = static_cast<float>(r), .transmittance = static_cast<float>(t)},
                      .ground_albedo = static_cast<float>(ground)},
                     {.paths = 100'000});
    const double pair_reflectance = r + t * t * r / (1. - r * r);
    const double pair_transmittance = t * t / (1. - r * r);
    const double arriving = pair_transmittance / (1. - ground * pair_reflectance);
    const double up_from_ground = ground * arriving;
    // Between the sheets: `down` meets the lower one, `up` the upper one.
    const double down = (t + r * t * up_from_ground) / (1. - r * r);
    const double up = r * down + t * up_from_ground;
    const double reflected = r + t * up;
    EXPECT_TRUE(agrees(result.reflected, reflected));
    EXPECT_TRUE(agrees(result.arriving_ground, arriving));
    EXPECT_TRUE(agrees(result.absorbed_ground, (1. - ground) * arriving));
    EXPECT_TRUE(agrees(result.absorbed_leaves, (1. - r - t) * (1. + up + down + up_from_ground)));
    const double sun_on_top = std::cos(double{zenith});
    EXPECT_TRUE(agrees(leafIrradiance(result, 0), sun_on_top * (1. + up)));
    EXPECT_TRUE(agrees(leafIrradiance(result, 1), sun_on_top * (down + up_from_ground)));
    EXPECT_NEAR(result.arriving_ground_direct.value, 0., 1e-5);  // what slips through the seam between two periods
  }
}

// Check that wood reflects upward and absorbs the rest, and that it is not there without `with_wood`.
TEST(R1_ForwardTrace, WoodReflectsAndAbsorbs) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0.5f, 0.5f, 1}, {.5f, 0, 0}, {0, .5f, 0}));
  addPolygon(mesh, mesh.wood_triangles, rectangle({1.5f, 0.5f, 1}, {.5f, 0, 0}, {0, .5f, 0}));
  finish(mesh, "leaf and plank");
  const TraceLight light{.leaf = {.reflectance = 0.f, .transmittance = 0.f}, .wood_reflectance = 0.25f};
  const ForwardResult with = traceForward(RayScene(mesh, Stand{}, true), light, {.paths = 64'000});
  EXPECT_TRUE(agrees(with.absorbed_leaves, 0.5));
  EXPECT_TRUE(agrees(with.absorbed_wood, 0.375));
  EXPECT_TRUE(agrees(with.reflected, 0.125));
  EXPECT_EQ(with.arriving_ground.value, 0.);
  const ForwardResult without = traceForward(RayScene(mesh, Stand{}, false), light, {.paths = 64'000});
  EXPECT_NEAR(without.absorbed_leaves.value, 1., 1e-12);
  EXPECT_EQ(without.absorbed_wood.value, 0.);
}

// Check that a periodic stand is the same whichever way it is described: a crown wider than its period, its leaves
// moved home one by one into one period, and four crowns in a period twice as large.
TEST(R1_ForwardTrace, PeriodicStandDoesNotDependOnItsCell) {
  const glm::vec2 period(0.9f, 0.7f);
  const TreeMesh wide = leafBox(60, 5);
  TreeMesh home;
  for (std::size_t first = 0; first < wide.vertices.size(); first += 12) {
    std::vector<glm::vec3> corners(wide.vertices.begin() + static_cast<std::ptrdiff_t>(first),
                                   wide.vertices.begin() + static_cast<std::ptrdiff_t>(first + 12));
    const glm::vec2 cell = glm::floor(glm::vec2(corners[0]) / period) * period;
    for (glm::vec3& corner : corners) corner -= glm::vec3(cell, 0.f);
    addPolygon(home, home.leaf_triangles, corners);
  }
  finish(home, "leaves moved home");
  const TraceLight light{.sun = sunlight(30.f * kDegree, 2.f), .ground_albedo = 0.3f};
  const TraceEffort effort{.paths = 60'000};
  const ForwardResult a = traceForward(RayScene(wide, {.period = period}, true), light, effort);
  const ForwardResult b =
      traceForward(RayScene(home, {.period = period}, true), light, {.paths = effort.paths, .seed = 2});
  Stand four{.trees = {}, .period = 2.f * period};
  for (float x : {0.f, period.x})
    for (float y : {0.f, period.y}) four.trees.push_back({.position = {x, y, 0.f}});
  const ForwardResult c = traceForward(RayScene(wide, four, true), light, {.paths = effort.paths, .seed = 3});
  for (const ForwardResult* other : {&b, &c}) {
    EXPECT_TRUE(agree(a.reflected, other->reflected));
    EXPECT_TRUE(agree(a.absorbed_leaves, other->absorbed_leaves));
    EXPECT_TRUE(agree(a.arriving_ground, other->arriving_ground));
    EXPECT_TRUE(agree(a.arriving_ground_direct, other->arriving_ground_direct));
    for (std::size_t leaf = 0; leaf < a.leaf_irradiance.size(); ++leaf)
      EXPECT_TRUE(agree(leafIrradiance(a, leaf), leafIrradiance(*other, leaf))) << leaf;
  }
}

// Check that the standard errors of leaves tell the truth: the squared difference of two runs, over its expectation by
// both standard errors, averages to (63/61) over many leaves. The mean over 400 leaves scatters by about
// sqrt(2.1 / 400) = 0.07, and by somewhat more as one path meets several leaves; 0.3 is over four of that.
TEST(R1_ForwardTrace, StandardErrorsAreCalibrated) {
  const TreeMesh mesh = leafBox(400, 8);
  const RayScene scene(mesh, Stand{}, true);
  const TraceLight light{.sun = sunlight(20.f * kDegree, 0.f)};
  const ForwardResult a = traceForward(scene, light, {.paths = 64'000, .seed = 1});
  const ForwardResult b = traceForward(scene, light, {.paths = 64'000, .seed = 2});
  double sum = 0.;
  for (std::size_t i = 0; i < mesh.leaf_count; ++i)
    sum += std::pow(a.leaf_irradiance[i] - b.leaf_irradiance[i], 2) /
           (std::pow(a.leaf_standard_error[i], 2) + std::pow(b.leaf_standard_error[i], 2));
  EXPECT_NEAR(sum / mesh.leaf_count, 63. / 61., 0.3);
  EXPECT_NE(a.leaf_irradiance, b.leaf_irradiance);
}

// Check that the bits do not depend on the number of threads, nor on anything but the seed.
TEST(R1_ForwardTrace, IsTheSameForAnyNumberOfThreads) {
  const TreeMesh mesh = leafBox(100, 1);
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  const TraceLight light{.sun = sunlight(35.f * kDegree, 1.f), .ground_albedo = 0.2f};
  const ForwardResult one = traceForward(scene, light, {.paths = 10'000, .threads = 1});
  EXPECT_EQ(one.paths, 10'112u);  // 79 units of 128
  for (int threads : {0, 2, 5}) {
    const ForwardResult many = traceForward(scene, light, {.paths = 10'000, .threads = threads});
    EXPECT_EQ(one.leaf_irradiance, many.leaf_irradiance);
    EXPECT_EQ(one.leaf_standard_error, many.leaf_standard_error);
    EXPECT_EQ(one.reflected.value, many.reflected.value);
    EXPECT_EQ(one.arriving_ground.standard_error, many.arriving_ground.standard_error);
  }
}

// Check that work ended early is the beginning of the whole work, with standard errors from what was done; and that one
// batch alone claims nothing better than its own value.
TEST(R1_ForwardTrace, EndsEarlyWithWhatIsThere) {
  const TreeMesh mesh = leafBox(50, 1);
  const RayScene scene(mesh, Stand{}, true);
  const TraceLight light{.sun = sunlight(35.f * kDegree, 1.f)};
  for (int batches : {1, 3}) {
    std::vector<double> calls;
    const ForwardResult result = traceForward(scene, light, {.paths = 64'000}, [&](double done) {
      calls.push_back(done);
      return static_cast<int>(calls.size()) < batches;
    });
    EXPECT_EQ(static_cast<int>(calls.size()), batches);
    EXPECT_DOUBLE_EQ(calls.back(), batches / 125.);  // units of 512 paths
    EXPECT_EQ(result.paths, 512u * static_cast<unsigned>(batches));
    EXPECT_NEAR(energy(result), 1., 1e-12);
    for (std::size_t i = 0; i < mesh.leaf_count; ++i) EXPECT_TRUE(std::isfinite(result.leaf_standard_error[i]));
    if (batches == 1) {
      EXPECT_EQ(result.reflected.standard_error, result.reflected.value);
    }
    if (batches == 3) {
      EXPECT_LT(result.reflected.standard_error, 0.2 * result.reflected.value);
    }
  }
}

// Check that what cannot be traced is refused before work, with one line.
TEST(R1_ForwardTrace, RefusesInvalidInput) {
  const TreeMesh mesh = leafBox(5, 1);
  const RayScene single(mesh, Stand{}, true);
  const auto trace = [&](const TraceLight& light, const TraceEffort& effort) { traceForward(single, light, effort); };
  EXPECT_THROW(trace({.sun = {0, 0, 1}}, {}), InvalidInput);
  EXPECT_THROW(trace({.sun = {0, 0, -2}}, {}), InvalidInput);
  EXPECT_THROW(trace({.sun = {0, 0, std::nanf("")}}, {}), InvalidInput);
  EXPECT_THROW(trace({.leaf = {0.9f, 0.9f}}, {}), InvalidInput);
  EXPECT_THROW(trace({.wood_reflectance = -0.1f}, {}), InvalidInput);
  EXPECT_THROW(trace({.of_kinds = {{}, {}}}, {}), InvalidInput);
  EXPECT_THROW(trace({.of_kinds = {{.leaf = {0.9f, 0.9f}}}}, {}), InvalidInput);
  EXPECT_THROW(trace({}, {.paths = 63}), InvalidInput);
  EXPECT_THROW(trace({}, {.threads = -1}), InvalidInput);
  try {
    trace({.ground_albedo = 0.5f}, {});
    FAIL() << "a reflecting ground under a single tree went through";
  } catch (const InvalidInput& e) {
    EXPECT_STREQ(e.what(), "ground albedo = 0.5: must be 0 in a forward trace of a stand without period");
  }
}
