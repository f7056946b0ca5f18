// Check that reflectance factors from single points of view and the albedo from all of them agree with closed forms,
// with the light that is traced from the sun and with one another.
#include "render/reference/brf_trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

#include "core/require.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/trace_run.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;
namespace fs = std::filesystem;

namespace {

constexpr double kDegree = std::numbers::pi / 180.;

std::vector<BrfResult> trace(const RayScene& scene, const std::vector<TraceLight>& bands,
                             const std::vector<ViewDirection>& views, std::uint64_t paths, std::uint64_t per_unit,
                             std::uint64_t seed = 1) {
  const BrfJob job(scene, bands, views, per_unit);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = seed, .wanted = {0, job.unitsOf(paths)}}, sums);
  return job.results(sums);
}

double zOf(const Estimate& a, const Estimate& b) {
  return (a.value - b.value) / std::hypot(a.standard_error, b.standard_error);
}

TreeMesh twoSheets() {
  TreeMesh mesh;
  for (float z : {2.f, 1.5f}) addPolygon(mesh, mesh.leaf_triangles, rectangle({3, 4, z}, {.5f, 0, 0}, {0, .5f, 0}));
  finish(mesh, "sheets");
  return mesh;
}

const std::vector<ViewDirection> kAround{{0., 0.}, {0.3, 1.}, {50. * kDegree, 1.}, {70. * kDegree, 4.}};

}  // namespace

// Check that two full sheets over a reflecting ground reflect alike to everywhere, as adding and doubling says (the
// closed form of the forward trace's test), also split by how often light was scattered; within five standard errors,
// and rounding where there is no noise.
TEST(R12_BrfTrace, TwoSheetsMatchAddingDoubling) {
  const TreeMesh mesh = twoSheets();
  const RayScene scene(mesh, {.period = glm::vec2(1.f)}, true);
  const TraceLight light{
      .sun = sunlight(0.9f, 1.f), .leaf = {.reflectance = 0.4f, .transmittance = 0.5f}, .ground_albedo = 0.6f};
  const double r = 0.4, t = 0.5, ground = 0.6;
  const double pair_reflectance = r + t * t * r / (1. - r * r), pair_transmittance = t * t / (1. - r * r);
  const double reflected =
      pair_reflectance + pair_transmittance * pair_transmittance * ground / (1. - ground * pair_reflectance);
  const std::vector<BrfResult> results = trace(scene, {light}, kAround, 40'000, 256);
  const BrfResult& result = results.front();
  std::vector<ReflectanceParts> all = result.views;
  all.push_back(result.albedo);
  for (const ReflectanceParts& parts : all) {
    EXPECT_NEAR(parts.whole.value, reflected, 5. * parts.whole.standard_error);
    EXPECT_GT(parts.whole.standard_error, 0.);
    EXPECT_NEAR(parts.leaf_once.value, r, 2e-6 * r);
    EXPECT_EQ(parts.ground_once.value, 0.);
    EXPECT_EQ(parts.wood_once.value, 0.);
    EXPECT_NEAR(parts.more.value + parts.leaf_once.value, parts.whole.value, 1e-12);
  }
  EXPECT_EQ(result.paths, 5u * 157u * 256u);  // of four views and the albedo, in whole units
}

// Check that nothing is lost: white sheets over white ground have the reflectance factor 1 in all directions, white
// leaves at random the albedo 1, within five standard errors. Wood stands on the ground of the latter and is white too.
TEST(R12_BrfTrace, WhiteStandsReflectAllLight) {
  const LeafOptics white{.reflectance = 0.3f, .transmittance = 0.7f};
  const TraceLight light{.sun = sunlight(0.5f, 1.f), .leaf = white, .wood_reflectance = 1.f, .ground_albedo = 1.f};
  const TreeMesh sheets = twoSheets();
  const RayScene full(sheets, {.period = glm::vec2(1.f)}, true);
  const std::vector<BrfResult> of_sheets = trace(full, {light}, kAround, 20'000, 128);
  for (const ReflectanceParts& view : of_sheets.front().views)
    EXPECT_NEAR(view.whole.value, 1., 5. * view.whole.standard_error);

  TreeMesh leaves = leafBox(60, 4);
  addPolygon(leaves, leaves.wood_triangles, rectangle({0, 0, -0.3f}, {0.2f, 0, 0}, {0, 0.2f, 0.05f}));
  finish(leaves, "leaves and wood");
  const RayScene open(leaves, {.period = glm::vec2(2.f, 1.f)}, true);
  const BrfResult result = trace(open, {light}, {{0.2, 0.}}, 40'000, 256).front();
  EXPECT_NEAR(result.albedo.whole.value, 1., 5. * result.albedo.whole.standard_error);
  EXPECT_LT(result.albedo.whole.standard_error, 0.01);
  EXPECT_GT(result.albedo.wood_once.value, 0.);
}

// Check the albedo from the views against the light traced from the sun, in two bands, within five of the errors of
// both; and what was scattered once by leaves or never by any against the forward orders. Ground counts there as none.
TEST(R12_BrfTrace, AlbedoIsTheForwardReflectance) {
  const TreeMesh mesh = leafBox(60, 12);
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  const std::vector<TraceLight> bands{
      {.sun = sunlight(0.7f, 1.f), .leaf = {.reflectance = 0.5f, .transmittance = 0.45f}, .ground_albedo = 0.4f},
      {.sun = sunlight(0.7f, 1.f), .leaf = {.reflectance = 0.1f, .transmittance = 0.f}, .ground_albedo = 0.15f}};
  const std::vector<BrfResult> backward = trace(scene, bands, {{0., 0.}}, 60'000, 256);
  const std::vector<ForwardResult> forward = traceForwardBands(scene, bands, {.paths = 60'000, .seed = 2});
  for (std::size_t band = 0; band < bands.size(); ++band) {
    EXPECT_LE(std::abs(zOf(backward[band].albedo.whole, forward[band].reflected)), 5.) << band;
    EXPECT_LE(std::abs(zOf(backward[band].albedo.ground_once, forward[band].reflected_by_order.ofOrder(0))), 5.)
        << band;
    EXPECT_LT(backward[band].albedo.whole.standard_error, 0.01 * backward[band].albedo.whole.value);
  }
}

// Check the target: views end at it, in each band, and another look asks for nothing.
TEST(R12_BrfTrace, ReachesTheErrorItIsAskedFor) {
  const TreeMesh mesh = leafBox(60, 12);
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  const std::vector<TraceLight> bands{
      {.sun = sunlight(0.7f, 1.f), .ground_albedo = 0.4f},
      {.sun = sunlight(0.7f, 1.f), .leaf = {.reflectance = 0.1f, .transmittance = 0.f}}};
  const BrfJob job(scene, bands, kAround, 64);
  TraceSums sums(job.bins(), job.groups());
  int rounds = 0;
  for (UnitRanges next; (next = job.unitsFor(0.02, 100'000, sums, 1)).count() > 0; ++rounds) {
    ASSERT_LT(rounds, 30);
    runUnits(job, {.wanted = next}, sums);
  }
  for (const BrfResult& result : job.results(sums))
    for (const ReflectanceParts& view : result.views) EXPECT_LE(view.whole.standard_error, 0.02 * view.whole.value);
  EXPECT_GT(rounds, 1);
  EXPECT_TRUE(job.reached(0.02, sums));
  EXPECT_EQ(job.unitsFor(0.001, 20, sums, 1).countOf(0, job.groups()), 0u);  // more than 20 are there
  EXPECT_FALSE(job.reached(0.001, sums));
}

TEST(R12_BrfTrace, RefusesInvalidInput) {
  const TreeMesh mesh = leafBox(5, 1);
  const RayScene periodic(mesh, {.period = glm::vec2(2.f)}, true), alone(mesh, Stand{}, true);
  const auto make = [](const RayScene& scene, std::vector<ViewDirection> views) {
    BrfJob(scene, {TraceLight{}}, std::move(views), 64);
  };
  EXPECT_NO_THROW(make(periodic, {{kMostViewZenith, 0.}}));
  EXPECT_THROW(make(alone, {{0., 0.}}), InvalidInput);
  EXPECT_THROW(make(periodic, {}), InvalidInput);
  EXPECT_THROW(make(periodic, {{1.56, 0.}}), InvalidInput);
  EXPECT_THROW(make(periodic, {{-0.1, 0.}}), InvalidInput);
  EXPECT_THROW(make(periodic, {{std::nan(""), 0.}}), InvalidInput);
  EXPECT_THROW(make(periodic, {{0., std::numeric_limits<double>::infinity()}}), InvalidInput);
}
