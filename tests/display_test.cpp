#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "render/false_colour.hpp"
#include "render/tone_mapping.hpp"

using namespace sunfleck;

// Check the plain curve against IEC 61966-2-1 written out, to the bit: pictures of a given exposure stay what they are.
TEST(ToneMapping, TheDefaultShowsLightAsItIs) {
  const auto published = [](float linear) {
    const float light = linear > 0.f ? std::min(linear, 1.f) : 0.f;
    return light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1.f / 2.4f) - 0.055f;
  };
  for (float radiance = -0.1f; radiance < 0.5f; radiance += 1.7e-4f)
    EXPECT_EQ(Display(3.f).code(radiance), published(3.f * radiance)) << radiance;
  EXPECT_EQ(Display(1.f).code(std::numeric_limits<float>::infinity()), published(1.f));
  EXPECT_EQ(Display(1.f).code(std::numeric_limits<float>::quiet_NaN()), 0.f);
}

// Check the filmic curve: black stays black, all of it grows without end until it is white, which it reaches softly,
// and Narkowicz's values, here from the fit in double precision.
TEST(ToneMapping, TheFilmicCurveFadesIntoWhite) {
  const Display filmic(1.f, ToneCurve::filmic);
  EXPECT_EQ(filmic.code(0.f), 0.f);
  EXPECT_EQ(filmic.code(-1.f), 0.f);
  EXPECT_EQ(filmic.code(std::numeric_limits<float>::quiet_NaN()), 0.f);
  EXPECT_EQ(filmic.code(std::numeric_limits<float>::infinity()), Display(1.f).code(1.f));
  float last = 0.f;
  for (float light = 1e-3f; light < 5.f; light *= 1.1f) {
    const double x = double{light}, fit = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    const float shown = tone_mapping::shownLight(tone_mapping::kFilmicCurve, light);
    EXPECT_NEAR(shown, fit, 2e-6);  // a few roundings
    EXPECT_GT(shown, last);
    last = shown;
  }
  EXPECT_LT(last, 1.f);
  EXPECT_EQ(tone_mapping::shownLight(tone_mapping::kFilmicCurve, 30.f), 1.f);
}

// Check that codes and light lead back to each other; error: pow in single precision.
TEST(ToneMapping, CodesLeadBackToLight) {
  for (int code = 0; code <= 255; ++code) {
    const float share = static_cast<float>(code) / 255.f;
    EXPECT_NEAR(tone_mapping::srgbCode(tone_mapping::srgbLight(share)), share, 2e-6f);
  }
}

// Check the false colours against nine published ones of viridis, which the polynomial meets to five codes of 255; that
// they grow brighter all the way; and what is outside of the range.
TEST(FalseColour, IsViridis) {
  const glm::vec3 published[] = {{0.267f, 0.005f, 0.329f}, {0.279f, 0.175f, 0.483f}, {0.230f, 0.322f, 0.546f},
                                 {0.173f, 0.449f, 0.558f}, {0.128f, 0.567f, 0.551f}, {0.158f, 0.684f, 0.502f},
                                 {0.369f, 0.789f, 0.383f}, {0.678f, 0.864f, 0.190f}, {0.993f, 0.906f, 0.144f}};
  for (int i = 0; i <= 8; ++i) {
    const glm::vec3 off = glm::abs(falseColour(static_cast<float>(i) / 8.f) - published[i]);
    EXPECT_LT(std::max({off.x, off.y, off.z}), 0.02f) << i;
  }
  float last = 0.f;
  for (float share = 0.f; share <= 1.f; share += 0.01f) {
    const glm::vec3 code = falseColour(share);
    const float luminance = 0.2126f * tone_mapping::srgbLight(code.x) + 0.7152f * tone_mapping::srgbLight(code.y) +
                            0.0722f * tone_mapping::srgbLight(code.z);
    EXPECT_GT(luminance, last) << share;
    last = luminance;
  }
  EXPECT_EQ(falseColour(-3.f), falseColour(0.f));
  EXPECT_EQ(falseColour(std::numeric_limits<float>::quiet_NaN()), falseColour(0.f));
  EXPECT_EQ(falseColour(std::numeric_limits<float>::infinity()), falseColour(1.f));
}
