#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "plants/random_leaves.hpp"
#include "render/compare/base64.hpp"
#include "render/compare/category_errors.hpp"
#include "render/compare/report_html.hpp"
#include "render/compare/report_json.hpp"
#include "render/compare/svg_plot.hpp"
#include "render/compare/validation.hpp"

namespace {

using namespace sunfleck;

// Eight leaves in two categories of 5 and 2, and one alone.
LeafDepths eightLeaves() {
  return {.depth = {0.f, 0.1f, 0.2f, 0.4f, 0.f, 2.f, 2.f, 7.f},
          .thickness = {3.f, 3.2f, 2.9f, 3.f, 3.f, 4.f, 4.f, 9.f}};
}

// (R6) Check that leaves are grouped by rounded depth and thickness, and that small categories are left out.
TEST(R6_Categories, HoldLeavesOfEqualRoundedDepthAndThickness) {
  const auto large = categories(eightLeaves());
  ASSERT_EQ(large.size(), 1u);
  EXPECT_EQ(large[0].depth, 0);
  EXPECT_EQ(large[0].thickness, 3);
  EXPECT_EQ(large[0].leaves, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(categories(eightLeaves(), 1).size(), 3u);
}

// (R6) Check the three RMS and the bias on numbers worked out by hand: category means are 1 (model 1.1) for five leaves
// and 2 (model 1.8) for two.
TEST(R6_ModelErrors, AreThoseWorkedOutByHand) {
  const std::vector<double> reference{0.5, 1.5, 1., 1., 1., 2., 2., 0.};
  const std::vector<float> model{1.1f, 1.1f, 1.1f, 1.1f, 1.1f, 1.8f, 1.8f, 0.f};
  const auto errors = modelErrors(model, reference, categories(eightLeaves(), 2));
  EXPECT_NEAR(errors.rms_category.value(), std::sqrt((0.01 + 0.04) / (1. + 4.)), 1e-7);  // float input
  EXPECT_NEAR(errors.rms_weighted.value(), std::sqrt((5. * 0.01 + 2. * 0.04) / (5. + 2. * 4.)), 1e-7);
  EXPECT_NEAR(errors.rms_leaf.value(), std::sqrt((0.36 + 0.16 + 3. * 0.01 + 2. * 0.04) / (0.25 + 2.25 + 3. + 8.)),
              1e-7);
  EXPECT_NEAR(errors.bias.value(), 0.1 / 9., 1e-7);
}

// (R6) Check that a perfect model has no error, and that where there is nothing to compare with there is none to tell:
// the reference dark, or no category.
TEST(R6_ModelErrors, AreZeroForThePerfectModelAndUndefinedInDarkness) {
  const std::vector<double> reference{0.5, 1.5, 1., 1., 1., 2., 2., 0.25};
  const std::vector<float> perfect(reference.begin(), reference.end());
  const auto none = modelErrors(perfect, reference, categories(eightLeaves(), 1));
  EXPECT_EQ(none.rms_category.value(), 0.);
  EXPECT_EQ(none.rms_leaf.value(), 0.);
  EXPECT_EQ(none.bias.value(), 0.);

  const std::vector<double> dark(8, 0.);
  const auto in_darkness = modelErrors(perfect, dark, categories(eightLeaves(), 1));
  EXPECT_FALSE(in_darkness.rms_category);
  EXPECT_FALSE(in_darkness.rms_leaf);
  EXPECT_FALSE(in_darkness.bias);
  EXPECT_FALSE(modelErrors(perfect, reference, {}).rms_weighted);
  EXPECT_FALSE(referenceNoise(dark, dark));
}

// (R6) Check the noise on a triangle of 3, 4 and 5.
TEST(ReferenceNoise, IsTheRmsOfStandardErrors) {
  EXPECT_DOUBLE_EQ(referenceNoise(std::vector<double>{3., 4.}, std::vector<double>{0.3, 0.4}).value(), 0.1);
}

// Check base64 on the test vectors of RFC 4648 section 10.
TEST(Base64, MeetsTheStandardsVectors) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

// Check that names from files cannot break out of the page.
TEST(Report, EscapesNames) {
  EXPECT_EQ(escapeMarkup("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
}

// Check that plots of nothing, of zeros and of one point are still well formed and hold no NaN.
TEST(SvgPlot, HoldsNoNanInTheCorners) {
  for (const std::string& svg : {linePlot("x", "y", {}), linePlot("x", "y", {{"a", "#000", {{0., 0., 0.}}}}),
                                 barPlot("y", {}), barPlot("y", {{"g", "l", "#000", 0., false}})}) {
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
    EXPECT_EQ(svg.substr(svg.size() - 6), "</svg>");
  }
}

Validation smallValidation(bool periodic, float albedo) {
  const RandomLayer layer{.size = {0.5f, 0.5f}, .height = 0.5f, .leaf_side = 0.04f, .leaf_area_index = 3.f};
  Scene scene{.name = "<layer>"};
  scene.kinds[0].source = "test";
  scene.kinds[0].mesh = std::make_shared<const TreeMesh>(randomLayer(layer, 1));
  scene.kinds[0].leaf.fill({.reflectance = 0.5f * albedo, .transmittance = 0.5f * albedo});
  if (periodic) scene.stand.period = layer.size;
  StandGeometry stand({.light_resolution = 128, .sample_resolution = 64, .cells = 8});
  stand.update(scene);
  return validate(scene, stand, {.trace = {.paths = 200'000, .seed = 11}});
}

// (R7) Check that black leaves see direct light alone, so that all models of slabs agree. Error: a few roundings of
// numbers up to 1.
TEST(R7_LeafIrradiance, OfBlackLeavesIsDirectLight) {
  const Validation v = smallValidation(true, 0.f);
  for (std::size_t leaf = 0; leaf < v.models[0].irradiance.size(); ++leaf)
    for (const ModelResult& m : v.models) {
      if (m.model == Model::field) continue;
      ASSERT_NEAR(m.irradiance[leaf], v.models[0].irradiance[leaf], 1e-6f);
    }
}

// (R7) Check one black leaf that lies flat under the sun, and one below it in its shadow: the first takes up the whole
// irradiance 1, as Monte Carlo finds too; the second, at depth 1, e^-1 by Beer and Lambert's law, which counts on
// chance where Monte Carlo and the field, whose direct light is seen, find darkness.
TEST(R7_LeafIrradiance, OfFlatLeavesUnderTheSun) {
  TreeMesh mesh;
  for (const float z : {1.f, 0.f}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
      mesh.vertices.emplace_back(corner, z);
    for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) mesh.leaf_triangles.push_back(first + t);
  }
  finish(mesh, "test");
  Scene scene{.name = "two"};
  scene.kinds[0].mesh = std::make_shared<const TreeMesh>(mesh);
  scene.kinds[0].leaf.fill({.reflectance = 0.f, .transmittance = 0.f});
  StandGeometry stand({.light_resolution = 32, .sample_resolution = 32, .cells = 4});
  stand.update(scene);
  const Validation v = validate(scene, stand, {.trace = {.paths = 10'000, .seed = 2}});
  for (const ModelResult& m : v.models) {
    // The field counts pixels, of which 22.6 lie along a side.
    EXPECT_NEAR(m.irradiance[0], 1.f, m.model == Model::field ? 0.03f : 1e-6f) << nameOf(m.model);
    EXPECT_FLOAT_EQ(m.irradiance[1], m.model == Model::field ? 0.f : std::exp(-1.f)) << nameOf(m.model);
  }
  // All light that enters the box meets the first leaf, whose sides are the box's: no spread, only rounding.
  EXPECT_NEAR(v.reference.leaf_irradiance[0], 1., 1e-5);
  EXPECT_EQ(v.reference.leaf_irradiance[1], 0.);
}

// (R7) Check the order that physics asks for: multiple scattering adds light, its compensation takes some away again.
TEST(R7_LeafIrradiance, OrdersTheModels) {
  const Validation v = smallValidation(false, 0.95f);
  for (std::size_t leaf = 0; leaf < v.models[0].irradiance.size(); ++leaf) {
    EXPECT_LE(v.models[0].irradiance[leaf], v.models[2].irradiance[leaf]);
    EXPECT_LE(v.models[2].irradiance[leaf], v.models[1].irradiance[leaf]);
    EXPECT_TRUE(std::isfinite(v.models[1].irradiance[leaf]));
  }
}

// Check report.json against the keys that scripts rely on, and that the page holds its parts and no raw names.
TEST(Report, HoldsWhatScriptsAndPeopleRelyOn) {
  const std::vector<Validation> validations{smallValidation(false, 0.95f), smallValidation(true, 0.95f)};
  const auto json = nlohmann::json::parse(reportJson(validations, "1.2.3", "abc"));
  EXPECT_EQ(json["sunfleck"], "1.2.3");
  EXPECT_EQ(json["commit"], "abc");
  for (const char* key : {"name", "leaves", "leaf_area_m2", "mean_depth", "mean_thickness", "albedo", "sun_zenith_deg"})
    EXPECT_TRUE(json["scene"].contains(key)) << key;
  for (const char* key : {"paths", "seconds", "rms_noise"}) EXPECT_TRUE(json["reference"][key].is_number()) << key;
  ASSERT_EQ(json["models"].size(), kModels.size());
  const std::array names{"ss", "spp", "sppg", "sppr", "nstreamg", "pp", "field"};
  for (std::size_t i = 0; i < kModels.size(); ++i) EXPECT_EQ(json["models"][i]["name"], names[i]);
  for (const char* key : {"rms_category", "rms_weighted", "rms_leaf", "prepare_seconds", "shade_seconds"})
    EXPECT_TRUE(json["periodic"]["models"][1][key].is_number()) << key;

  const std::string html =
      reportHtml(validations, std::vector<ReportPicture>{{"a picture", "png"}}, {"sunfleck <x>", "1.2.3", "abc"});
  EXPECT_EQ(html.find("<layer>"), std::string::npos);
  EXPECT_NE(html.find("&lt;layer&gt;"), std::string::npos);
  EXPECT_NE(html.find("sunfleck &lt;x&gt;"), std::string::npos);
  EXPECT_NE(html.find("data:image/png;base64,cG5n"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(html.find("src=\"http"), std::string::npos);
}

}  // namespace
