#include "render/compare/picture_difference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/random.hpp"
#include "render/compare/picture_sheet.hpp"
#include "render/false_colour.hpp"
#include "render/tone_mapping.hpp"

using namespace sunfleck;

namespace {

Image even(int width, int height, std::vector<std::string> channels, const std::vector<float>& pixel) {
  Image image{.width = width, .height = height, .channels = std::move(channels), .values = {}};
  for (int i = 0; i < width * height; ++i) image.values.insert(image.values.end(), pixel.begin(), pixel.end());
  return image;
}

// Nearly normal: the sum of twelve even numbers has variance 1.
float noise(Random& random) {
  float sum = -6.f;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

}  // namespace

// Check the error of even pictures by hand, and that pixels count by how much the picture covers of them.
TEST(R31_PictureDifference, WeighsPixelsByTheirCoverage) {
  Image picture = even(4, 2, {"R", "G", "B", "A"}, {0.3f, 0.2f, 0.1f, 1.f});
  const Image reference = even(4, 2, {"R", "G", "B"}, {0.2f, 0.2f, 0.2f});
  const PictureError error = pictureError(picture, reference);
  EXPECT_NEAR(error.rms, std::sqrt(0.02 / 0.12), 1e-6);  // roundings of single precision
  EXPECT_EQ(error.without_noise, error.rms);
  EXPECT_EQ(error.noise, 0.);
  EXPECT_EQ(error.standard_error, 0.);
  EXPECT_NEAR(error.bias, 0., 1e-6);
  // A pixel that is half covered and off by 1 in red adds half of 1 to eight pixels of 0.02.
  picture.values[0] = 1.2f;
  picture.values[3] = 0.5f;
  EXPECT_NEAR(pictureError(picture, reference).rms, std::sqrt((7 * 0.02 + 0.5 * 1.01) / (7.5 * 0.12)), 1e-6);
  picture.values[3] = 0.f;
  EXPECT_NEAR(pictureError(picture, reference).rms, std::sqrt(0.02 / 0.12), 1e-6);
  EXPECT_EQ(pictureError(picture, even(4, 2, {"R", "G", "B"}, {0.f, 0.f, 0.f})).rms, 0.);  // nothing to compare with
  EXPECT_THROW(pictureError(picture, even(4, 3, {"R", "G", "B"}, {0.f, 0.f, 0.f})), std::invalid_argument);
  EXPECT_THROW(pictureError(picture, even(4, 2, {"Y"}, {0.f})), std::invalid_argument);
}

// Check that the reference's noise is taken off: of 200 noisy references of a picture that is 10 % off, the means of
// the figures are what they are without noise, and spread as their standard error tells. The mean of 200 has an error
// of 1/14 of one; the spread one of 1/20. Of a perfect picture the square that is left is normal about 0, with a
// deviation v, and the root of it is within two standard errors while the square is within v: 84.1 % of the draws,
// +- 2.6 %.
TEST(R31_PictureDifference, TakesTheNoiseOff) {
  constexpr int kSeeds = 200;
  const Image truth = even(32, 32, {"R", "G", "B"}, {0.2f, 0.3f, 0.1f});
  Image off = truth;
  for (float& value : off.values) value *= 1.1f;
  const Image error = even(32, 32, {"R", "G", "B"}, {0.05f, 0.05f, 0.05f});
  double sum = 0., squares = 0., told = 0., perfect = 0., noise_of = 0.;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed, 0);
    Image reference = truth;
    for (float& value : reference.values) value += 0.05f * noise(random);
    const PictureError found = pictureError(off, reference, &error);
    sum += found.without_noise / kSeeds;
    squares += std::pow(found.without_noise, 2) / kSeeds;
    told += std::pow(found.standard_error, 2) / kSeeds;
    noise_of += found.noise / kSeeds;
    EXPECT_GT(found.rms, found.without_noise);
    const PictureError none = pictureError(truth, reference, &error);
    perfect += none.without_noise <= 2. * none.standard_error ? 1. : 0.;
  }
  const double spread = std::sqrt((squares - sum * sum) * kSeeds / (kSeeds - 1));
  EXPECT_NEAR(sum, 0.1, 5. * spread / std::sqrt(double{kSeeds}) + 1e-3);  // a root is not even: spread^2 / 0.2
  EXPECT_NEAR(spread / std::sqrt(told), 1., 5. / 20.);
  EXPECT_NEAR(noise_of, 0.05 * std::sqrt(3. / 0.14), 1e-3);
  EXPECT_NEAR(perfect / kSeeds, 0.841, 4. * 0.026);
}

// Check the difference's pixels, and that what covers nothing is 0.
TEST(R31_PictureDifference, ShowsWhereItIs) {
  Image picture = even(2, 2, {"R", "G", "B", "A"}, {0.2f, 0.2f, 0.2f, 1.f});
  Image reference = even(2, 2, {"R", "G", "B"}, {0.2f, 0.2f, 0.2f});
  picture.values[0] = 0.5f;                                               // the first pixel is off by 0.3 in red
  reference.values[3] = reference.values[4] = reference.values[5] = 0.f;  // the second has no reference
  picture.values[11] = 0.f;                                               // the third covers nothing
  picture.values[8] = 1.f;
  const Image difference = differencePicture(picture, reference);
  EXPECT_EQ(difference.channels, (std::vector<std::string>{"Y"}));
  EXPECT_NEAR(difference.values[0], 0.3 / std::sqrt(3.), 1e-6);
  EXPECT_NEAR(difference.values[1], 0.2, 1e-6);
  EXPECT_EQ(difference.values[2], 0.f);
  EXPECT_EQ(difference.values[3], 0.f);
}

// Check a sheet of pictures: as the display shows them above their differences, up to the same value; and their table.
TEST(R31_PictureDifference, SheetsShowPicturesAboveDifferences) {
  const Image reference = even(30, 20, {"R", "G", "B"}, {0.1f, 0.1f, 0.1f});
  std::vector<ComparedPicture> pictures{{"far", even(30, 20, {"R", "G", "B", "A"}, {0.3f, 0.3f, 0.3f, 1.f}), {}},
                                        {"near", even(30, 20, {"R", "G", "B", "A"}, {0.2f, 0.2f, 0.2f, 1.f}), {}}};
  for (ComparedPicture& of : pictures) of.error = pictureError(of.picture, reference);
  const Display display(2.f);
  const Image sheet = pictureSheet(reference, pictures, display);
  const auto code = [&](int x, int y) { return Display(1.f).code(sheet.values[sheet.at(x, y, 1)]); };
  constexpr float kRounding = 2e-6f;  // of pow in single precision
  EXPECT_EQ(sheet.height, 2 * 20 + 4);
  EXPECT_NEAR(code(10, 10), display.code(0.1f), kRounding);
  EXPECT_NEAR(code(34 + 10, 10), display.code(0.3f), kRounding);
  EXPECT_NEAR(code(68 + 10, 10), display.code(0.2f), kRounding);
  EXPECT_EQ(code(10, 24 + 10), 0.f);
  EXPECT_NEAR(code(34 + 10, 24 + 10), falseColour(1.f).y, kRounding);
  EXPECT_NEAR(code(68 + 10, 24 + 10), falseColour(0.5f).y, 1e-5f);  // half, to a rounding of 0.2 and 0.1
  EXPECT_EQ(pictureErrorRows("scene", {pictures[1]}), "scene,near,1,0,1,0,1\n");
  EXPECT_EQ(pictureErrorRows("oak, \"45\"", {pictures[1]}), "\"oak, \"\"45\"\"\",near,1,0,1,0,1\n");
}

// Check false colours as a PNG shows them, and the bar: the picture stays, the bar runs from the lowest colour below to
// the highest on top, and numbers of another range or unit look different.
TEST(R31_PictureDifference, FalseColoursHaveABar) {
  Image values{.width = 40, .height = 60, .channels = {"Y"}, .values = {}};
  for (int i = 0; i < 40 * 60; ++i) values.values.push_back(static_cast<float>(i) / 2400.f);
  const Image colours = inFalseColours(values, 1.f);
  const glm::vec3 expected = falseColour(1200.f / 2400.f);
  for (int band = 0; band < 3; ++band)
    EXPECT_NEAR(Display(1.f).code(colours.values[colours.at(0, 30, static_cast<std::size_t>(band))]), expected[band],
                2e-6f);  // pow in single precision
  const Image with_bar = withColourBar(colours, 1.f, false);
  EXPECT_EQ(with_bar.height, 60);
  ASSERT_GT(with_bar.width, 60);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 40; ++x) EXPECT_EQ(with_bar.values[with_bar.at(x, y, 1)], colours.values[colours.at(x, y, 1)]);
  const int bar = 40 + 6 + 6;  // the middle of it
  const auto code = [&](int y) { return Display(1.f).code(with_bar.values[with_bar.at(bar, y, 1)]); };
  EXPECT_NEAR(code(6), falseColour(1.f).y, 0.02f);
  EXPECT_NEAR(code(53), falseColour(0.f).y, 0.02f);
  EXPECT_EQ(with_bar.values[with_bar.at(bar, 2, 1)], 0.f);
  EXPECT_NE(with_bar.values, withColourBar(colours, 2.f, false).values);
  EXPECT_NE(with_bar.values, withColourBar(colours, 1.f, true).values);
  // Of any size, without writing outside of it.
  for (const int side : {1, 5, 700}) {
    const Image tiny{.width = side,
                     .height = side,
                     .channels = {"R", "G", "B"},
                     .values = std::vector<float>(static_cast<std::size_t>(3 * side * side))};
    EXPECT_GT(withColourBar(tiny, 0.3f, true).width, side);
  }
}
