// Check that run times and errors of the ways to light a scene are told as (F25) has them.

#include "render/compare/scene_bench.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/require.hpp"
#include "plants/random_leaves.hpp"
#include "render/compare/validation.hpp"

namespace {

using namespace sunfleck;

Scene layer() {
  Scene scene{.name = "layer"};
  scene.kinds[0].mesh = std::make_shared<const TreeMesh>(
      randomLayer({.size = {0.5f, 0.5f}, .height = 0.5f, .leaf_side = 0.04f, .leaf_area_index = 3.f}, 1));
  scene.kinds[0].leaf.fill({.reflectance = 0.475f, .transmittance = 0.475f});
  return scene;
}

SceneBenchEffort smallEffort() {
  return {.reference = {.paths = 65'536, .seed = 7},
          .paths = {1'024, 16'384},
          .geometry = {.light_resolution = 128, .sample_resolution = 64, .cells = 8},
          .rounds = 1};
}

// (F25) Check that points that follow the law give it back. Error: a few roundings.
TEST(F25_TraceCourse, IsTheLawThatItsPointsFollow) {
  const auto point = [](double paths) { return TracePoint{paths, 0.02 + 3e-6 * paths, 5. / std::sqrt(paths)}; };
  const TraceCourse course = traceCourse({point(1e4), point(1e5), point(1e6)});
  EXPECT_NEAR(course.start, 0.02, 1e-12);
  EXPECT_NEAR(course.by_path, 3e-6, 1e-18);
  EXPECT_NEAR(course.timeOf(0.005), point(1e6).seconds, 1e-9);
  EXPECT_NEAR(course.timeOf(0.0005), point(1e8).seconds, 1e-6);
}

// (F25) Check the corners: one point alone, whose start is not known, and times that noise has turned round.
TEST(F25_TraceCourse, StaysAboveZero) {
  EXPECT_DOUBLE_EQ(traceCourse({{1e4, 0.5, 0.1}}).timeOf(0.1), 0.5);
  const TraceCourse odd = traceCourse({{1e4, 0.5, 0.1}, {2e4, 0.4, 0.08}});
  EXPECT_GT(odd.by_path, 0.);
  EXPECT_GE(odd.start, 0.);
}

// (F25) Check models and Monte Carlo against what validate() finds with the same reference, and against the law of
// large numbers: paths whose random numbers are not the reference's are off by their own noise, which is that of the
// reference times the root of the paths. Bounds: of the some forty categories a share of the leaves counts, their RMS
// from two answers is within a factor of 2.
TEST(F25_BenchScene, TellsTheErrorsOfModelsAndTheNoiseOfMonteCarlo) {
  const Scene scene = layer();
  const SceneBenchEffort effort = smallEffort();
  const SceneBench bench = benchScene(scene, effort);
  constexpr std::size_t kSlabs = kModels.size() - 1,
                        kFields = 8;  // the field is last, in several resolutions of lines and of cells
  ASSERT_EQ(bench.rows.size(), kSlabs + kFields + effort.paths.size());

  StandGeometry stand(effort.geometry);
  stand.update(scene);
  const Validation v = validate(scene, stand, {.trace = effort.reference});
  EXPECT_DOUBLE_EQ(bench.category_noise, v.category_noise.value());
  for (std::size_t i = 0; i < kSlabs; ++i) {
    const SceneBenchRow& row = bench.rows[i];
    EXPECT_EQ(row.method, nameOf(v.models[i].model));
    EXPECT_NEAR(row.weighted, v.models[i].errors.rms_weighted.value(), 1e-12);
    EXPECT_NEAR(row.leaf, v.models[i].errors.rms_leaf.value(), 1e-12);
    EXPECT_NEAR(row.weighted_without_noise, std::sqrt(row.weighted * row.weighted - std::pow(bench.category_noise, 2)),
                1e-12);
    EXPECT_GT(row.from_nothing.cpu, 0.);
    EXPECT_GT(row.sun_turned.wall, 0.);
    EXPECT_TRUE(row.monte_carlo && *row.monte_carlo > 0.);
  }
  for (std::size_t i = 0; i < kFields; ++i) {
    const SceneBenchRow& row = bench.rows[kSlabs + i];
    EXPECT_EQ(row.method, i < 4 ? "field" : "grid");
    if (row.method == "field" && row.setting == 40.) {
      EXPECT_NEAR(row.weighted, v.models.back().errors.rms_weighted.value(), 1e-12);
    }
  }
  for (std::size_t i = 0; i < effort.paths.size(); ++i) {
    const SceneBenchRow& row = bench.rows[kSlabs + kFields + i];
    const double expected = bench.category_noise * std::sqrt(static_cast<double>(effort.reference.paths) /
                                                             static_cast<double>(effort.paths[i]));
    EXPECT_GT(row.weighted_without_noise, 0.5 * expected) << row.setting;
    EXPECT_LT(row.weighted_without_noise, 2. * expected) << row.setting;
    EXPECT_FALSE(row.monte_carlo);
  }
}

// Check that what is ended early tells nothing, and that there must be something to compare with.
TEST(BenchScene, NeedsTimeAndLight) {
  for (const double end : {0., 0.5}) {
    try {
      EXPECT_TRUE(benchScene(layer(), smallEffort(), [=](double done) { return done < end; }).rows.empty());
    } catch (const std::runtime_error& ended) {
      EXPECT_STREQ(ended.what(), "interrupted");
    }
  }
  TreeMesh upright;  // the sun does not see it
  upright.vertices = {{0.f, 0.f, 0.f}, {0.f, 1.f, 0.f}, {0.f, 1.f, 1.f}};
  upright.leaf_triangles = {{0, 1, 2}};
  finish(upright, "test");
  Scene dark = layer();
  dark.kinds[0].mesh = std::make_shared<const TreeMesh>(upright);
  EXPECT_THROW(benchScene(dark, smallEffort()), InvalidInput);
}

// Check that both files hold every row, and no number that is none.
TEST(BenchScene, IsToldAsCsvAndPlot) {
  SceneBench bench = benchScene(layer(), smallEffort());
  bench.rows[0].weighted_without_noise = 0.;  // has no place on a logarithmic axis
  const std::string csv = sceneBenchCsv(bench), svg = sceneBenchPlot(bench);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), bench.rows.size() + 1);
  EXPECT_NE(csv.find("\nmonte_carlo,16384,"), std::string::npos);
  EXPECT_NE(svg.find(">16.4 k<"), std::string::npos);
  EXPECT_NE(svg.find(">sppg<"), std::string::npos);
  for (const char* none : {"nan", "inf"}) EXPECT_EQ((csv + svg).find(none), std::string::npos);
}

}  // namespace
