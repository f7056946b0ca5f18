// The contents of a leaf from its spectrum, and the species that were measured.
#include "leaves/prospect_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/require.hpp"
#include "leaves/measured_leaves.hpp"
#include "leaves/prospect.hpp"

namespace sunfleck {
namespace {

using State = FittedContent::State;

MeasuredSpectrum spectrumOf(const LeafContents& leaf, double from, double to, double step, double noise = 0.,
                            unsigned seed = 1) {
  MeasuredSpectrum measured;
  for (double w = from; w <= to; w += step) measured.wavelengths.push_back(w);
  std::vector<LeafSides> sides(measured.wavelengths.size());
  Prospect(measured.wavelengths).solve(leaf, sides);
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0., noise > 0. ? noise : 1.);
  for (const LeafSides& side : sides) {
    measured.reflectance.push_back(side.reflectance + (noise > 0. ? error(random) : 0.));
    measured.transmittance.push_back(side.transmittance + (noise > 0. ? error(random) : 0.));
  }
  return measured;
}

LeafContents randomLeaf(std::mt19937& random, bool parts) {
  std::uniform_real_distribution<double> share(0., 1.);
  LeafContents leaf{.structure = 1.05 + 1.5 * share(random),
                    .chlorophyll = 5. + 80. * share(random),
                    .carotenoids = 2. + 18. * share(random),
                    .anthocyanins = 0.5 + 10. * share(random),
                    .brown_pigments = 0.02 + 0.5 * share(random),
                    .water = 0.003 + 0.03 * share(random),
                    .dry_matter = 0.002 + 0.02 * share(random)};
  if (!parts) return leaf;
  leaf.protein = 0.1 * leaf.dry_matter;
  leaf.carbon_constituents = 0.9 * leaf.dry_matter;
  leaf.dry_matter = 0.;
  return leaf;
}

// Check that a leaf of the model is found again from its own spectrum, wherever it lies.
TEST(L7_FitProspect, FindsExactLeaves) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 24; ++trial) {
    const bool parts = trial % 3 == 0;
    const LeafContents truth = randomLeaf(random, parts);
    const ProspectFit fit = fitProspect(spectrumOf(truth, 400., 2500., 20.), {.parts = parts, .held = {}});
    EXPECT_TRUE(fit.converged) << trial;
    EXPECT_LT(fit.rmse, 1e-8) << trial;  // the method ends where a step gains less than rounding
    for (const LeafContent& content : leafContents())
      EXPECT_NEAR(fit.contents.*content.value, truth.*content.value, 1e-5 * content.usual_high)
          << trial << " " << content.name;
  }
}

// Check stated errors: over many noisy spectra of known leaves, what is found deviates by its standard error.
TEST(L7_FitProspect, StatesItsErrors) {
  constexpr int kTrials = 60;
  std::mt19937 random(11);
  std::vector<double> squares(leafContents().size());
  for (int trial = 0; trial < kTrials; ++trial) {
    const LeafContents truth = randomLeaf(random, false);
    const ProspectFit fit =
        fitProspect(spectrumOf(truth, 400., 2500., 15., 0.002, static_cast<unsigned>(trial) + 100u));
    EXPECT_NEAR(fit.rmse, 0.002, 3e-4) << trial;  // of 282 data: 4 % by chance, four times as much allowed
    for (std::size_t c = 0; c < fit.each.size(); ++c) {
      ASSERT_EQ(fit.each[c].state, State::found) << trial << " " << fit.each[c].content->name;
      const double deviation = fit.each[c].value - truth.*fit.each[c].content->value;
      squares[c] += std::pow(deviation / fit.each[c].standard_error, 2);
    }
  }
  // The sum of squares of 60 normal deviates is 60 +- 11: four of these deviations.
  for (std::size_t c = 0; c < 7; ++c) EXPECT_NEAR(squares[c], kTrials, 44.) << leafContents()[c].name;
}

// Check that one of both sides is enough, that what cannot be seen is told, and what is known is held.
TEST(L7_FitProspect, TellsWhatItCannotSee) {
  const LeafContents truth{.anthocyanins = 2., .brown_pigments = 0.};
  MeasuredSpectrum visible = spectrumOf(truth, 400., 690., 2.);
  visible.transmittance.clear();
  const ProspectFit fit = fitProspect(
      visible, {.parts = false, .held = {{"structure", 1.5}, {"dry_matter", 0.009}, {"brown_pigments", 0.}}});
  EXPECT_FALSE(fit.rmse_transmittance);
  EXPECT_LT(fit.rmse, 1e-7);
  for (const FittedContent& each : fit.each) {
    if (each.content->name == "water") {
      EXPECT_EQ(each.state, State::unseen);
    } else if (each.content->name == "structure") {
      EXPECT_EQ(each.state, State::held);
    } else {
      EXPECT_NEAR(each.value, truth.*each.content->value, 1e-4 * each.content->usual_high) << each.content->name;
    }
  }
}

// Check data of too few wavelengths, however often they come: what they leave open is told, and nothing is no number.
TEST(L7_FitProspect, TellsWhatItCannotTellApart) {
  MeasuredSpectrum twice;
  for (int i = 0; i < 20; ++i) {
    twice.wavelengths.push_back(i % 2 ? 550. : 800.);
    twice.reflectance.push_back((i % 2 ? 0.12 : 0.45) + 1e-3 * (i % 3));
  }
  const ProspectFit fit = fitProspect(twice);
  int unseen = 0;
  for (const FittedContent& each : fit.each) {
    EXPECT_TRUE(std::isfinite(each.value) && std::isfinite(each.standard_error)) << each.content->name;
    unseen += each.state == State::unseen;
  }
  EXPECT_GE(unseen, 2);
  EXPECT_LT(fit.rmse, 2e-3);
}

// Check a leaf that lies on the limits of its contents, with noise that draws beyond.
TEST(L7_FitProspect, StaysWithinLimits) {
  const LeafContents truth{.structure = 1., .anthocyanins = 0., .brown_pigments = 0.};
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const ProspectFit fit = fitProspect(spectrumOf(truth, 400., 2500., 15., 0.002, seed));
    EXPECT_TRUE(fit.converged) << seed;
    EXPECT_GE(fit.contents.structure, 1.);
    EXPECT_GE(fit.contents.anthocyanins, 0.);
    EXPECT_GE(fit.contents.brown_pigments, 0.);
    EXPECT_NEAR(fit.contents.chlorophyll, truth.chlorophyll, 2.) << seed;
  }
}

// Check that data which are none, or too few, are refused.
TEST(L7_FitProspect, RefusesWhatIsNoSpectrum) {
  MeasuredSpectrum few{.wavelengths = {450., 550., 670.}, .reflectance = {0.05, 0.1, 0.05}, .transmittance = {}};
  EXPECT_THROW(fitProspect(few), InvalidInput);
  MeasuredSpectrum measured = spectrumOf({}, 400., 2500., 100.);
  measured.reflectance[3] = 1.2;
  EXPECT_THROW(fitProspect(measured), InvalidInput);
  measured.reflectance[3] = std::nan("");
  EXPECT_THROW(fitProspect(measured), InvalidInput);
  measured.reflectance.pop_back();
  EXPECT_THROW(fitProspect(measured), InvalidInput);
  EXPECT_THROW(fitProspect({}), InvalidInput);
  const MeasuredSpectrum good = spectrumOf({}, 400., 2500., 100.);
  EXPECT_THROW(fitProspect(good, {.parts = false, .held = {{"sugar", 1.}}}), InvalidInput);
  EXPECT_THROW(fitProspect(good, {.parts = false, .held = {{"water", 0.01}, {"water", 0.01}}}), InvalidInput);
  EXPECT_THROW(fitProspect(good, {.parts = false, .held = {{"protein", 0.001}}}), InvalidInput);
}

// Check the species by what was measured of them: the leaf of the model stands as far from it as its source states.
TEST(L7_FitProspect, SpeciesAreNearWhatWasMeasured) {
  ASSERT_GE(measuredLeafNames().size(), 17u);
  for (const std::string& name : measuredLeafNames()) {
    const MeasuredLeaf& leaf = measuredLeaf(name);
    const LeafSpectrum spectrum = prospect(leaf.contents);
    double squares = 0.;
    for (std::size_t i = 0; i < leaf.bands.size(); ++i) {
      const LeafSides model = meanIn(spectrum, leaf.bands[i]);
      squares += std::pow(model.reflectance - leaf.measured[i].reflectance, 2) +
                 std::pow(model.transmittance - leaf.measured[i].transmittance, 2);
    }
    const double rmse = std::sqrt(squares / static_cast<double>(2 * leaf.bands.size()));
    // The source's figure is over all wavelengths, ours over eight, most of them where the model is worst.
    EXPECT_LT(rmse, 2. * leaf.fit_rmse) << name;
  }
  EXPECT_THROW(measuredLeaf("unicorn"), InvalidInput);
}

}  // namespace
}  // namespace sunfleck
