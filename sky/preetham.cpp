#include "sky/preetham.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <vector>

#include "core/require.hpp"
#include "sky/linear_rgb.hpp"

namespace sunfleck {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kRows = 90, kColumns = 360;  // of one degree

// The formula of Perez: luminance or chromaticity of a point of the sky, up to a factor.
struct Perez {
  double a, b, c, d, e;
  double operator()(double cos_zenith, double cos_sun) const {
    const double from_sun = std::acos(std::clamp(cos_sun, -1., 1.));
    return (1. + a * std::exp(b / cos_zenith)) * (1. + c * std::exp(d * from_sun) + e * cos_sun * cos_sun);
  }
};

// Luminance and chromaticities over the sky of one sun and turbidity, scaled so that they are right in the zenith.
class Distribution {
 public:
  Distribution(double sun_zenith, double t)
      : chroma_x_{-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
                  -0.0033 * t + 0.0452},
        chroma_y_{-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
                  -0.0109 * t + 0.0529},
        luminance_{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                   -0.0670 * t + 0.3703} {
    const double s = sun_zenith;
    const glm::dvec3 zenith{
        t * t * (((0.00166 * s - 0.00375) * s + 0.00209) * s) +
            t * (((-0.02903 * s + 0.06377) * s - 0.03202) * s + 0.00394) +
            (((0.11693 * s - 0.21196) * s + 0.06052) * s + 0.25886),
        t * t * (((0.00275 * s - 0.00610) * s + 0.00317) * s) +
            t * (((-0.04214 * s + 0.08970) * s - 0.04153) * s + 0.00516) +
            (((0.15346 * s - 0.26756) * s + 0.06670) * s + 0.26688),
        (4.0453 * t - 4.9710) * std::tan((4. / 9. - t / 120.) * (kPi - 2. * s)) - 0.2155 * t + 2.4192};
    factors_ = zenith / shape(1., std::cos(s));
  }
  glm::dvec3 operator()(double cos_zenith, double cos_sun) const { return factors_ * shape(cos_zenith, cos_sun); }

 private:
  glm::dvec3 shape(double cos_zenith, double cos_sun) const {
    return {chroma_x_(cos_zenith, cos_sun), chroma_y_(cos_zenith, cos_sun), luminance_(cos_zenith, cos_sun)};
  }
  Perez chroma_x_, chroma_y_, luminance_;
  glm::dvec3 factors_;
};

void validate(double sun_zenith, double turbidity) {
  require(sun_zenith >= 0. && sun_zenith <= kMostSunZenith, "zenith angle of the sun", sun_zenith,
          "from 0 to 89.9 degrees, in radians");
  require(turbidity >= kLeastTurbidity && turbidity <= kMostTurbidity, "turbidity", turbidity, "in [1.7, 10]");
}

glm::dvec3 rgbOf(const glm::dvec3& chroma_luminance) {
  const auto [x, y, luminance] = std::array{chroma_luminance.x, chroma_luminance.y, chroma_luminance.z};
  return glm::max(linearRgb({x / y * luminance, luminance, (1. - x - y) / y * luminance}), glm::dvec3(0.));
}

// CIE 1931 colour matching functions at a wavelength [nm], within 1 % of their peaks (Wyman et al. 2013).
glm::dvec3 colourMatching(double wavelength) {
  const auto lobe = [&](double height, double middle, double below, double above) {
    const double t = (wavelength - middle) / (wavelength < middle ? below : above);
    return height * std::exp(-0.5 * t * t);
  };
  return {lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
          lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
          lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)};
}

// From 380 to 750 nm in steps of 10: the sun's radiance outside the air [100 W m^-2 nm^-1 sr^-1], and what ozone [1/cm]
// and water vapour [1/cm] absorb. The mixed gases absorb beyond.
constexpr std::array kSunRadiance{165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6,
                                  306.6, 288.3, 287.1, 278.2, 271.0, 272.3, 263.6, 255.0, 250.6, 253.1,
                                  253.5, 251.3, 246.3, 241.7, 236.8, 232.1, 228.2, 223.4, 219.7, 215.3,
                                  211.0, 207.3, 202.4, 198.7, 194.3, 190.7, 186.3, 182.6};
constexpr std::array kOzone{0.001, 0.001, 0.002, 0.002, 0.002, 0.003, 0.003, 0.003, 0.006, 0.009, 0.014, 0.021, 0.030,
                            0.040, 0.048, 0.063, 0.075, 0.085, 0.103, 0.120, 0.120, 0.115, 0.125, 0.120, 0.105, 0.090,
                            0.079, 0.067, 0.057, 0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009};
constexpr std::array kWater{0.016, 0.024, 0.0125, 1.0, 0.87, 0.061, 0.001};  // the last, from 690 nm on
constexpr double kFirstWavelength = 380., kStep = 10.;                       // [nm]
constexpr double kSunSolidAngle = 6.8e-5;                                    // [sr]
constexpr double kLuminousEfficacy = 683.;                                   // [lm/W]

// Illuminance of a plane that faces the sun as X, Y and Z [klx].
glm::dvec3 sunXyz(double zenith, double turbidity) {
  const double degrees = zenith * 180. / kPi;
  const double air = 1. / (std::cos(zenith) + 0.15 * std::pow(93.885 - degrees, -1.253));  // relative optical mass
  const double haze = 0.04608365822050 * turbidity - 0.04586025928522;                     // Angstrom's coefficient
  constexpr double kOzoneAmount = 0.35, kWaterAmount = 2.;                                 // [cm]
  glm::dvec3 sum(0.);
  for (std::size_t i = 0; i < kSunRadiance.size(); ++i) {
    const double wavelength = kFirstWavelength + kStep * static_cast<double>(i), micrometres = 1e-3 * wavelength;
    const double rayleigh = 0.008735 * std::pow(micrometres, -4.08), aerosol = haze * std::pow(micrometres, -1.3);
    const std::size_t before_water = kSunRadiance.size() - kWater.size();
    const double vapour = i < before_water ? 0. : kWater[i - before_water] * kWaterAmount * air;
    const double water = 0.2385 * vapour / std::pow(1. + 20.07 * vapour, 0.45);
    const double passed = std::exp(-air * (rayleigh + aerosol + kOzone[i] * kOzoneAmount) - water);
    sum += kSunRadiance[i] * passed * colourMatching(wavelength);
  }
  return 100. * kSunSolidAngle * kLuminousEfficacy * kStep * 1e-3 * sum;
}

}  // namespace

glm::dvec3 preethamChromaLuminance(double cos_zenith, double cos_sun, double sun_zenith, double turbidity) {
  validate(sun_zenith, turbidity);
  require(cos_zenith > 0. && cos_zenith <= 1., "cosine of the zenith angle", cos_zenith, "above 0, at most 1");
  require(cos_sun >= -1. && cos_sun <= 1., "cosine of the angle to the sun", cos_sun, "in [-1, 1]");
  return Distribution(sun_zenith, turbidity)(cos_zenith, cos_sun);
}

// The mean of each cell by Gauss's rule of two points each way.
ClearSky preethamSky(double sun_zenith, double sun_azimuth, double turbidity) {
  validate(sun_zenith, turbidity);
  require(std::abs(sun_azimuth) <= 100., "azimuth of the sun", sun_azimuth, "in [-100, 100] rad");
  const Distribution sky(sun_zenith, turbidity);
  constexpr double kStepOfCell = 0.5 * kPi / kRows;
  const double node = 0.5 / std::sqrt(3.);
  std::vector<glm::vec3> radiance;
  for (int row = 0; row < kRows; ++row) {
    const double above = std::cos(row * kStepOfCell), below = std::cos((row + 1) * kStepOfCell);
    for (int column = 0; column < kColumns; ++column) {
      glm::dvec3 sum(0.);
      for (const double at : {0.5 - node, 0.5 + node})
        for (const double turn : {0.5 - node, 0.5 + node}) {
          const double cosine = above + at * (below - above), azimuth = (column + turn) * kStepOfCell;
          const double from_sun = cosine * std::cos(sun_zenith) +
                                  std::sqrt(1. - cosine * cosine) * std::sin(sun_zenith) * std::cos(azimuth);
          sum += rgbOf(sky(cosine, from_sun));
        }
      radiance.emplace_back(0.25 * sum);
    }
  }
  return {.sky = SkyMap(kRows, kColumns, static_cast<float>(sun_azimuth), std::move(radiance)),
          .sun = glm::max(linearRgb(sunXyz(sun_zenith, turbidity)), glm::dvec3(0.))};
}

}  // namespace sunfleck
