// PROSPECT-D and PROSPECT-PRO, and what bands of light see of their spectra.
#include "leaves/prospect.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "core/require.hpp"
#include "leaves/light_bands.hpp"

namespace sunfleck {
namespace {

struct Reference {
  double wavelength, reflectance, transmittance;
};
// PROSPECT-D, N 1.5, Cab 40, Car 8, Cw 0.01, Cm 0.009, by prosail 2.0.5: leaf_optics.json of the shared references.
constexpr Reference kReferences[] = {{450, 0.041251, 0.001399},  {490, 0.043844, 0.010245}, {550, 0.151167, 0.150253},
                                     {560, 0.141082, 0.140682},  {670, 0.036352, 0.006068}, {680, 0.036002, 0.005272},
                                     {705, 0.178384, 0.192751},  {750, 0.422494, 0.45264},  {850, 0.442253, 0.474193},
                                     {1200, 0.413188, 0.464797}, {1450, 0.16503, 0.209699}, {1650, 0.310483, 0.401549},
                                     {2200, 0.154747, 0.253136}};

// Check the published model's own values.
TEST(L6_Prospect, MeetsTheReference) {
  const LeafSpectrum spectrum = prospect({});
  ASSERT_EQ(spectrum.sides.size(), 2101u);
  for (const Reference& reference : kReferences) {
    const LeafSides sides = meanIn(spectrum, {reference.wavelength, reference.wavelength});
    // Six digits are printed; the two tables of coefficients differ in their last digits.
    EXPECT_NEAR(sides.reflectance, reference.reflectance, 2e-6) << reference.wavelength;
    EXPECT_NEAR(sides.transmittance, reference.transmittance, 2e-6) << reference.wavelength;
  }
}

// Check that proteins and carbon-based constituents stand in for dry matter: their split of it has nearly its spectrum.
TEST(L6_Prospect, ProteinAndCarbonAreDryMatter) {
  LeafContents parts;
  const std::pair<std::string, double> values[] = {{"protein", 0.001}, {"carbon_constituents", 0.008}};
  setContents(parts, values, "");
  EXPECT_EQ(parts.dry_matter, 0.);
  const LeafSpectrum whole = prospect({}), split = prospect(parts);
  double squares = 0.;
  for (std::size_t i = 0; i < whole.sides.size(); ++i)
    squares += std::pow(whole.sides[i].reflectance - split.sides[i].reflectance, 2);
  const double rms = std::sqrt(squares / static_cast<double>(whole.sides.size()));
  EXPECT_LT(rms, 0.02);  // PROSPECT-PRO was calibrated to keep the spectra of PROSPECT-D within about 0.02
  EXPECT_GT(rms, 1e-4);  // and is another model
}

// Check random leaves, and the corners of the ranges: shares are shares, and more of anything lets less through.
TEST(L6_Prospect, IsPhysicalEverywhere) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> corner(0, 3);
  std::uniform_real_distribution<double> share(0., 1.);
  for (int trial = 0; trial < 60; ++trial) {
    LeafContents leaf;
    for (const LeafContent& content : leafContents()) {
      const int where = corner(random);
      leaf.*content.value = where == 0   ? content.low
                            : where == 1 ? content.high
                                         : content.low + share(random) * (content.usual_high - content.low);
    }
    if (trial % 2)
      leaf.dry_matter = 0.;
    else
      leaf.protein = leaf.carbon_constituents = 0.;
    LeafContents more = leaf;
    more.water = std::min(1.1 * leaf.water + 1e-3, 10.);
    const LeafSpectrum spectrum = prospect(leaf), darker = prospect(more);
    for (std::size_t i = 0; i < spectrum.sides.size(); ++i) {
      const auto [reflectance, transmittance] = spectrum.sides[i];
      ASSERT_TRUE(reflectance >= 0. && transmittance >= 0. && reflectance + transmittance <= 1.) << trial << " " << i;
      ASSERT_LE(darker.sides[i].transmittance, transmittance + 1e-15) << trial << " " << i;  // rounding
    }
  }
}

// Check that nothing is lost where nothing absorbs.
TEST(L6_Prospect, ConservesEnergy) {
  LeafContents empty;
  for (const LeafContent& content : leafContents()) empty.*content.value = content.low;
  for (const double structure : {1., 1.37, 10.}) {
    empty.structure = structure;
    for (const LeafSides& sides : prospect(empty).sides)
      ASSERT_NEAR(sides.reflectance + sides.transmittance, 1., 1e-14) << structure;  // rounding
  }
}

// Check the derivatives against differences of whole spectra.
TEST(L6_Prospect, Differentiates) {
  const double wavelengths[] = {432.5, 680., 1000., 1450.25, 2500.};
  const Prospect model(wavelengths);
  LeafContents leaf{
      .anthocyanins = 2., .brown_pigments = 0.1, .dry_matter = 0., .protein = 0.001, .carbon_constituents = 0.008};
  std::vector<LeafSides> slopes(leafContents().size() * model.size()), less(model.size()), more(model.size());
  model.differentiate(leaf, slopes);
  for (std::size_t c = 0; c < leafContents().size(); ++c) {
    if (leafContents()[c].name == "dry_matter") continue;  // beside its parts it must be 0
    double& value = leaf.*leafContents()[c].value;
    const double kept = value, step = 1e-3 * value;
    value = kept - step;
    model.solve(leaf, less);
    value = kept + step;
    model.solve(leaf, more);
    value = kept;
    for (std::size_t i = 0; i < model.size(); ++i) {
      const double expected = (more[i].reflectance - less[i].reflectance) / (2. * step);
      // Both are differences: errors of their steps' squares, 1e-6, and of rounding over the steps.
      EXPECT_NEAR(slopes[c * model.size() + i].reflectance, expected, 1e-5 * std::abs(expected) + 1e-9)
          << c << " " << i;
    }
  }
}

// Check that each content is held to its range, and names are known.
TEST(L6_Prospect, RefusesWhatIsNoLeaf) {
  const auto message = [](const LeafContents& leaf) -> std::string {
    try {
      prospect(leaf);
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message({.structure = 0.9}), "structure = 0.9: must be in [1, 10]");
  EXPECT_EQ(message({.chlorophyll = -1.}), "chlorophyll = -1: must be in [0, 1000] ug/cm^2");
  EXPECT_EQ(message({.water = std::nan("")}), "water = nan: must be in [0, 10] cm");
  EXPECT_EQ(message({.protein = 0.001}),
            "dry_matter = 0.009: must be 0 beside protein or carbon_constituents, which are that dry matter");
  LeafContents leaf;
  const std::pair<std::string, double> unknown[] = {{"sugar", 1.}};
  EXPECT_THROW(setContents(leaf, unknown, ""), InvalidInput);
  const std::pair<std::string, double> twice[] = {{"water", 0.01}, {"water", 0.01}};
  EXPECT_THROW(setContents(leaf, twice, ""), InvalidInput);
  const double outside[] = {399.};
  EXPECT_THROW(Prospect{outside}, InvalidInput);
}

LeafSpectrum constant(double reflectance, double transmittance) {
  return {std::vector<LeafSides>(2101, {.reflectance = reflectance, .transmittance = transmittance})};
}
// Reflects 1 within the band and else nothing.
LeafSpectrum reflectsIn(int low, int high) {
  LeafSpectrum spectrum = constant(0., 0.);
  for (int w = low; w <= high; ++w) spectrum.sides[static_cast<std::size_t>(w - 400)].reflectance = 1.;
  return spectrum;
}

// Check means of a band against a straight line's, with limits between the table's wavelengths.
TEST(L4_MeanIn, IsExactForStraightLines) {
  LeafSpectrum line = constant(0., 0.);
  for (std::size_t i = 0; i < line.sides.size(); ++i)
    line.sides[i] = {.reflectance = static_cast<double>(i) / 2100., .transmittance = 0.};
  for (const auto& [low, high] :
       {std::pair{400., 2500.}, {450.3, 495.8}, {1000.2, 1000.7}, {2499.5, 2500.}, {555., 555.}})
    EXPECT_NEAR(meanIn(line, {low, high}).reflectance, (0.5 * (low + high) - 400.) / 2100., 1e-13);  // rounding
  EXPECT_NEAR(meanIn(reflectsIn(500, 599), {400., 700.}).reflectance, 100. / 300., 1e-13);
  EXPECT_THROW(meanIn(line, {399., 500.}), InvalidInput);
  EXPECT_THROW(meanIn(line, {600., 500.}), InvalidInput);
  EXPECT_THROW(meanIn(line, {std::nan(""), 500.}), InvalidInput);
}

// Check that grey leaves are grey, that colours fall where they belong, and that shares stay shares.
TEST(L5_RgbOf, IsTheColourOfTheLeaf) {
  for (const LeafSides& band : rgbOf(constant(0.3, 0.6))) {
    EXPECT_NEAR(band.reflectance, 0.3, 1e-14);  // rounding
    EXPECT_NEAR(band.transmittance, 0.6, 1e-14);
  }
  const auto red = rgbOf(reflectsIn(620, 780)), blue = rgbOf(reflectsIn(400, 480)), green = rgbOf(reflectsIn(510, 560));
  EXPECT_GT(red[0].reflectance, 0.4);
  EXPECT_LT(red[2].reflectance, 0.05);
  EXPECT_GT(blue[2].reflectance, 0.8);
  EXPECT_LT(blue[1].reflectance, 0.05);
  EXPECT_GT(green[1].reflectance, 0.5);
  EXPECT_EQ(green[0].reflectance, 0.);  // beyond what a display shows: cut
  const auto leaf = rgbOf(prospect({}));
  EXPECT_GT(leaf[1].reflectance, leaf[0].reflectance);
  EXPECT_GT(leaf[0].reflectance, leaf[2].reflectance);
  // White paper by which a leaf lets green through and reflects all else: the sum of what was cut must not exceed 1.
  LeafSpectrum parted = reflectsIn(510, 560);
  for (LeafSides& sides : parted.sides) sides.transmittance = 1. - sides.reflectance;
  for (const LeafSides& band : rgbOf(parted)) {
    EXPECT_LE(band.reflectance + band.transmittance, 1.);
    EXPECT_GE(band.transmittance, 0.);
  }
}

// Check against the standard's own matrix.
TEST(L5_RgbOf, IsThatOfTheStandard) {
  // X, Y, Z of what reflects 560 to 600 nm alone, from the table, summed by a script of its own, over the sum of ybar
  // D65.
  const auto box = rgbOf(reflectsIn(560, 600));
  const double x = 0.349883, y = 0.340606, z = 0.000748;
  // The matrix of IEC 61966-2-1 has four digits, and makes white 1, 1, 1 within as much.
  EXPECT_NEAR(box[0].reflectance, std::clamp(3.2406 * x - 1.5372 * y - 0.4986 * z, 0., 1.), 2e-4);
  EXPECT_NEAR(box[1].reflectance, std::clamp(-0.9689 * x + 1.8758 * y + 0.0415 * z, 0., 1.), 2e-4);
}

// Check that single precision keeps the sum at most 1, whatever is rounded.
TEST(L5_RgbOf, RoundsToValidOptics) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0., 1.);
  for (int i = 0; i < 10000; ++i) {
    const double reflectance = share(random);
    const LeafOptics optics = leafOptics({.reflectance = reflectance, .transmittance = 1. - reflectance});
    EXPECT_NO_THROW(validate(optics));
    EXPECT_NEAR(optics.transmittance, 1. - reflectance, 2e-7);  // two roundings
  }
  const BandOptics bands = bandOptics(
      prospect({}), std::array{WavelengthBand{620., 680.}, WavelengthBand{520., 570.}, WavelengthBand{450., 450.}});
  EXPECT_FLOAT_EQ(bands[2].reflectance, static_cast<float>(prospect({}).sides[50].reflectance));
}

}  // namespace
}  // namespace sunfleck
