#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "render/compare/detail/radial_scale.hpp"
#include "render/compare/log_plot.hpp"
#include "render/compare/radiance_plot.hpp"
#include "render/compare/slab_answer.hpp"
#include "render/compare/slab_bench.hpp"
#include "render/compare/slab_contestants.hpp"
#include "render/compare/slab_tables.hpp"

namespace {

using namespace sunfleck;

// The exact solution with a constant added to every radiance.
constexpr double kOffset = 0.01;
class OffsetSlab : public SlabSolution {
 public:
  explicit OffsetSlab(const SlabSetup& setup) : exact_(exactSlabModel().solve(setup)) {}
  SlabBudget budget() const override { return exact_->budget(); }
  double incident() const override { return exact_->incident(); }
  pp::Fluxes fluxes(double depth) const override { return exact_->fluxes(depth); }
  void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                 std::span<double> result) override {
    exact_->radiances(depths, mus, phis, result);
    for (double& value : result) value += kOffset;
  }
  int streams() const override { return exact_->streams(); }

 private:
  std::unique_ptr<SlabSolution> exact_;
};

// A solution whose reflectance is 1 / N^2, and all else 0.
class SlowlyConverging : public SlabSolution {
 public:
  explicit SlowlyConverging(const SlabSetup& setup) : streams_(setup.settings.streams) {}
  SlabBudget budget() const override { return {1. / (streams_ * streams_), 0., 0., 0.}; }
  double incident() const override { return 1.; }
  pp::Fluxes fluxes(double) const override { return {}; }
  void radiances(std::span<const double>, std::span<const double>, std::span<const double>,
                 std::span<double>) override {}
  int streams() const override { return streams_; }

 private:
  int streams_;
};

template <typename Solution>
const SlabModel kModelOf{
    .name = "test",
    .label = "test",
    .scope = SlabScope::any,
    .gives_radiance = true,
    .solve = [](const SlabSetup& setup) -> std::unique_ptr<SlabSolution> { return std::make_unique<Solution>(setup); }};

// (R9) Check that the weights of the directions are those of the sphere: they integrate 1, mu^2 and mu^20 exactly.
TEST(R9_SlabTableGrid, IntegratesOverTheSphere) {
  const SlabTableGrid grid = slabTableGrid(10.);
  ASSERT_EQ(grid.sphere.mus.size(), grid.sphere.weights.size());
  for (const int power : {0, 2, 20}) {
    double integral = 0.;
    for (std::size_t i = 0; i < grid.sphere.mus.size(); ++i)
      integral += grid.sphere.weights[i] * std::pow(grid.sphere.mus[i], power);
    EXPECT_NEAR(integral, 1. / (power + 1), 1e-14) << power;  // some roundings of numbers below 1
  }
  EXPECT_EQ(grid.depths.size(), 11u);
  EXPECT_EQ(grid.depths.back(), 10.);
  EXPECT_EQ(slabTableGrid(5.).depths.back(), 5.);
  EXPECT_EQ(slabTableGrid(std::numeric_limits<double>::infinity()).depths.back(), 10.);
}

// (R9) Check that a model that is off by one constant everywhere has that constant as its error, and the exact one
// none.
TEST(R9_SlabRadianceErrors, AreThoseOfAConstantOffset) {
  const std::vector<const SlabModel*> models{&kModelOf<OffsetSlab>, &exactSlabModel()};
  const auto errors = slabRadianceErrors(models, 0.5, 0.9, 5., 4);
  EXPECT_NEAR(errors[0], kOffset, 1e-12 * kOffset);  // roundings of a sum of squares that are all alike
  EXPECT_EQ(errors[1], 0.);
}

// (R9) Check SPP's error for isotropic scatterers in a slab of thickness 10, RMS over the five albedos, against another
// study's 2.81 % (its own exact solver; it does not print its angles and depths, hence 2 % of leave).
TEST(R9_SlabRadianceErrors, OfSppAreThoseOfAnotherStudy) {
  const std::vector<const SlabModel*> models{findSlabModel("spp")};
  double squares = 0.;
  for (const double albedo : {0.5, 0.7, 0.9, 0.95, 0.99})
    squares += std::pow(slabRadianceErrors(models, 0., albedo, 10., 16).front(), 2);
  EXPECT_NEAR(std::sqrt(squares / 5.), 0.0281, 0.02 * 0.0281);
}

// (R9) Check that n streams' error, azimuth orders included, is no larger in a slab of thickness 10, RMS over the five
// albedos, than in that study: half a unit of its last digit, and 20 % because the orders that are left out weigh the
// more, the more oblique the beams are, which it does not tell.
TEST(R9_SlabRadianceErrors, OfStreamsAreNoLargerThanThoseOfAnotherStudy) {
  const std::vector<const SlabModel*> models{findSlabModel("nstream:2:1"), findSlabModel("nstream"),
                                             findSlabModel("best")};
  const std::map<double, std::array<double, 3>> studied{{0.5, {.234, .047, .004}}, {-0.5, {.126, .049, .004}}};
  for (const auto& [g, percent] : studied) {
    std::array<double, 3> squares{};
    for (const double albedo : {0.5, 0.7, 0.9, 0.95, 0.99}) {
      const auto errors = slabRadianceErrors(models, g, albedo, 10., 24);
      for (std::size_t m = 0; m < models.size(); ++m) squares[m] += std::pow(100. * errors[m], 2) / 5.;
    }
    for (std::size_t m = 0; m < models.size(); ++m)
      EXPECT_LT(std::sqrt(squares[m]), 1.2 * percent[m] + 5e-4) << g << " " << models[m]->name;
  }
}

// Check that closed forms take one slab of any medium under a beam on black ground, and Monte Carlo only Henyey and
// Greenstein's.
TEST(SlabModels, TakeWhatTheyCan) {
  const SlabModel &closed = *findSlabModel("nstream:3"), &sampled = *findSlabModel("mc");
  SlabSetup setup = homogeneousSlab({.asymmetry = 0.3, .albedo = 0.9, .thickness = 2., .mu0 = 0.4});
  EXPECT_TRUE(takes(closed, setup) && takes(sampled, setup));
  setup.homogeneous.reset();
  setup.problem.layers[0].medium = LeafScattering{};
  EXPECT_TRUE(takes(closed, setup));
  EXPECT_FALSE(takes(sampled, setup));
  const auto refuses = [&](auto change) {
    SlabSetup other = setup;
    change(other.problem);
    return !takes(closed, other) && takes(exactSlabModel(), other);
  };
  EXPECT_TRUE(refuses([](pp::Problem& p) { p.ground.albedo = 0.1; }));
  EXPECT_TRUE(refuses([](pp::Problem& p) { p.above = 1.; }));
  EXPECT_TRUE(refuses([](pp::Problem& p) { p.beam->irradiance = 2.; }));
  EXPECT_TRUE(refuses([](pp::Problem& p) { p.beam.reset(); }));
  EXPECT_TRUE(refuses([](pp::Problem& p) { p.layers.push_back(p.layers[0]); }));
  EXPECT_TRUE(refuses([](pp::Problem& p) { p.layers[0].emission_top = 1.; }));
  EXPECT_TRUE(refuses([](pp::Problem& p) { std::get<LeafScattering>(p.layers[0].medium).hot_spot = 0.1; }));
  EXPECT_EQ(findSlabModel("nstream:9"), nullptr);
}

// (S4) Check the irradiance of leaves in slabs of thickness 1 to 16 against another study's errors: SPP 38 %, the
// default within 1 % (it has 0.7 %). The study does not tell its definition: ours was picked from several because it
// comes nearest to its figures, 38 %, two-stream 4.9 and n = 2 0.71 %. Depths at whole numbers give 36.1, 4.28 and
// 0.47 %, leaves that face the beam 29.0, 3.45 and 0.38 %.
TEST(S4_SlabIrradianceErrors, AreThoseOfAnotherStudy) {
  const std::vector<const SlabModel*> models{findSlabModel("spp"), findSlabModel("nstream"), &exactSlabModel()};
  const auto errors = slabIrradianceErrors(models, kIrradianceAlbedo, 16);
  EXPECT_NEAR(errors[0], 0.38, 0.005);  // half of its last digit
  EXPECT_LT(errors[1], 0.01);
  EXPECT_EQ(errors[2], 0.);
}

// Check that the number of streams is the smallest whose next differs by less than the tolerance: 1/N^2 - 1/(2N)^2 is
// 0.0117 at 8 and 0.0029 at 16; and that one out of reach is told with the last difference.
TEST(SlabAnswer, ChoosesTheSmallestSufficientNumberOfStreams) {
  const SlabAnswer chosen = answerWithin(0.01, kModelOf<SlowlyConverging>, {});
  EXPECT_EQ(chosen.streams, 16);
  EXPECT_DOUBLE_EQ(chosen.difference.value(), 0.75 / 256.);
  const SlabAnswer last = answerWithin(1e-9, kModelOf<SlowlyConverging>, {});
  EXPECT_EQ(last.streams, 256);
  EXPECT_DOUBLE_EQ(last.difference.value(), 0.75 / (128. * 128.));
}

// Check that fluxes come as shares of what arrives: at the top the beam is 1, and what comes up is the reflectance.
TEST(SlabAnswer, GivesFluxesAsShares) {
  for (const SlabModel& model : slabModels()) {
    SlabQuestion question{.setup = homogeneousSlab({.asymmetry = 0.3, .albedo = 0.9, .thickness = 2., .mu0 = 0.4}),
                          .depths = {0., 2.}};
    const SlabAnswer found = answer(model, question);
    EXPECT_NEAR(found.fluxes[0].direct, 1., 1e-14) << model.name;  // a quotient of like numbers
    EXPECT_NEAR(found.fluxes[0].up, found.budget.reflectance, 1e-12) << model.name;
    EXPECT_NEAR(found.fluxes[1].down + found.fluxes[1].direct, found.budget.transmittance, 1e-12) << model.name;
  }
}

// Check that difference() measures shares as they are and radiances relative to the largest of the finer answer.
TEST(SlabAnswer, DifferenceIsTheLargestOne) {
  SlabAnswer a{.budget = {0.5, 0.2, 0.1, 0.3}, .radiances = {1., 4.}};
  SlabAnswer b = a;
  EXPECT_EQ(difference(a, b), 0.);
  b.budget.reflectance = 0.501;
  EXPECT_NEAR(difference(a, b), 0.001, 1e-15);  // a difference of numbers near 1/2
  b.radiances = {1.04, 4.};
  EXPECT_NEAR(difference(a, b), 0.01, 1e-15);
}

// Check scales worked out by hand: round rings up to the largest value, decades with a round end.
TEST(RadialScale, HasRoundRings) {
  const RadialScale linear = radialScale(0.01, 0.26, false);
  EXPECT_NEAR(linear.high, 0.3, 1e-15);
  EXPECT_EQ(linear.rings.size(), 3u);
  EXPECT_NEAR(linear.at(0.15), 0.5, 1e-15);
  const RadialScale logarithmic = radialScale(0.02, 1.5, true);
  EXPECT_DOUBLE_EQ(logarithmic.low, 0.01);
  EXPECT_DOUBLE_EQ(logarithmic.high, 2.);
  EXPECT_EQ(logarithmic.at(0.), 0.);
  EXPECT_DOUBLE_EQ(logarithmic.at(2.), 1.);
  for (const bool log : {false, true})  // nothing to show is no reason to fail
    EXPECT_TRUE(std::isfinite(radialScale(0., 0., log).at(0.)));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// Check that a plot has a curve for each depth and model, names both, draws the beam, and escapes what is typed.
TEST(RadiancePlot, ShowsEachCurveOnce) {
  const std::vector<double> angles{0., 1., 2., 3.};
  RadiancePlot plot{.title = "a < b",
                    .planes = {{"pp", 0., angles, {1., 2., 0., 1.}}, {"spp", 2.5, angles, {1., 1., 0.5, 0.5}}},
                    .beam_mu0 = 0.5};
  const std::string svg = radiancePlot(plot);
  EXPECT_EQ(count(svg, "<path d=\"M"), 3u);  // two curves and the arrow's tip
  EXPECT_NE(svg.find("spp, depth 2.5"), std::string::npos);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  plot.beam_mu0.reset();
  EXPECT_EQ(radiancePlot(plot).find("beam"), std::string::npos);
  plot.map =
      RadianceMap{.model = "pp", .depth = 1., .zeniths = 2, .azimuths = 2, .values = std::vector<double>(8, 0.1)};
  EXPECT_EQ(count(radiancePlot(plot), "data:image/png"), 2u);  // one disc for each hemisphere
}

// Check that a decade is a decade: of points at 1e-4, 1e-3 and 1e-2 s the middle one lies in the middle, and that what
// a logarithm cannot show is left out.
TEST(LogPlot, IsLogarithmic) {
  const LogPanel panel{.title = "t",
                       .x_title = "x",
                       .y_title = "y",
                       .curves = {{.label = "curve",
                                   .colour = "red",
                                   .points = {{1e-4, 1., ""}, {1e-3, 0.1, ""}, {1e-2, 0.01, ""}, {1., 0., ""}}}}};
  const std::string svg = logPlot("title", "about", {panel}, 1);
  EXPECT_EQ(count(svg, "<circle"), 3u);
  EXPECT_NE(svg.find("M74.0 40.0 L357.0 250.0 L640.0 460.0"), std::string::npos) << svg;
}

// Check that two marks of points at one place are not written over each other, and that time has its units.
TEST(LogPlot, MovesMarksAsideAndNamesUnits) {
  LogPanel panel{.title = "t",
                 .x_title = "x",
                 .y_title = "y",
                 .x_seconds = true,
                 .curves = {{.label = "curve", .colour = "red", .points = {{1e-7, 1., "one"}, {1e-7, 1., "two"}}}}};
  const std::string svg = logPlot("title", "about", {panel}, 1);
  const auto placeOf = [&](const std::string& mark) {
    const std::size_t end = svg.find(">" + mark + "<"), start = svg.rfind("<text", end);
    return svg.substr(start, svg.find("text-anchor", start) - start);
  };
  EXPECT_NE(placeOf("one"), placeOf("two"));
  EXPECT_NE(svg.find(">100 ns<"), std::string::npos);
  EXPECT_NE(svg.find(">1 us<"), std::string::npos);
}

// Check that a file of measurements has a line for each and the header's number of fields, that a table, which has no
// fluxes, leaves its field empty, as all but the exact solver leave that of batches, and that the plot has each point
// where it belongs.
TEST(SlabBench, WritesALineForEachRow) {
  SlabBench bench{.machine = "this one", .rows = {}};
  for (const char* kind : {"closed form", "exact", "table"})
    bench.rows.push_back({.model = kind,
                          .kind = kind,
                          .streams = 4,
                          .azimuth_orders = kind[0] == 'c' ? 2 : 0,
                          .power_seconds = 1e-6,
                          .radiance_seconds = 1e-5,
                          .irradiance_error = 0.1,
                          .flux_error = kind[0] == 't' ? std::numeric_limits<double>::quiet_NaN() : 0.2,
                          .radiance_error = 0.01});
  bench.rows[0].own_powers = false;
  bench.rows[1].batch_seconds = 1e-7;
  const std::string csv = slabBenchCsv(bench);
  EXPECT_EQ(count(csv, "\n"), 4u);
  EXPECT_EQ(count(csv, ","), 4u * 9u);
  EXPECT_NE(csv.find("table,table,4,0,1e-06,0.1,,1e-05,0.01,\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("exact,exact,4,0,1e-06,0.1,0.2,1e-05,0.01,1e-07\n"), std::string::npos) << csv;
  EXPECT_EQ(count(slabBenchPlot(bench), "<circle"), 7u);  // the closed form's powers and fluxes are those of another
}

// Check that every contestant's answer is near the exact one on the course, each by what it is good for: the worst
// closed form in radiance is SPP (0.033), in irradiance too (0.28); the exact solver with N = 16 is right to 1e-4 in
// both.
TEST(SlabContestants, AnswerTheSameQuestion) {
  SlabCourse course = slabCourse();
  course.slabs = {course.slabs[2], course.slabs[9]};
  course.sphere.phis.resize(2);
  const auto exact = exactContestant(course, 32)->answer();
  const auto near = [&](SlabContestant& contestant, double irradiance, double radiance) {
    const auto found = contestant.answer();
    ASSERT_EQ(found.powers.size(), course.places());
    ASSERT_EQ(found.radiances.size(), course.places() * course.sphere.directions());
    for (std::size_t i = 0; i < exact.powers.size(); ++i)
      EXPECT_NEAR(found.powers[i], exact.powers[i], irradiance * exact.powers[i]);
    double squares = 0.;
    for (std::size_t i = 0; i < exact.radiances.size(); ++i)
      squares += std::pow(found.radiances[i] - exact.radiances[i], 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(exact.radiances.size())), radiance);
  };
  near(*exactContestant(course, 16), 1e-4, 1e-4);
  for (const spp::SlabTier& tier : spp::slabTiers())
    if (tier.form != spp::SlabForm::kDirect) near(*tierContestant(course, tier), 0.6, 0.05);
}

}  // namespace
