#include "plants/detail/portable_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"

namespace portable = sunfleck::detail::portable;
using sunfleck::Random;

namespace {

// Distance in units of the last place of what a wider type gives.
double unitsOff(double value, long double exact) {
  const double nearest = static_cast<double>(exact);
  const double unit = std::nextafter(std::abs(nearest), std::numeric_limits<double>::infinity()) - std::abs(nearest);
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact)) / unit;
}

constexpr int kTries = 200'000;

}  // namespace

// Check sines and cosines against long double, at all sizes of angles up to 1e4, also close to multiples of pi / 2.
TEST(PortableMath, SinesAreThoseOfAWiderType) {
  Random random(1, 0);
  double worst = 0.;
  for (int i = 0; i < kTries; ++i) {
    double angle = (2. * random.uniformDouble() - 1.) * std::pow(10., 8. * random.uniformDouble() - 4.);
    if (i % 4 == 0) angle = std::nearbyint(angle) * 0.5 * std::numbers::pi * (1. + 1e-9 * random.uniformDouble());
    worst = std::max({worst, unitsOff(portable::sine(angle), std::sin(static_cast<long double>(angle))),
                      unitsOff(portable::cosine(angle), std::cos(static_cast<long double>(angle)))});
  }
  EXPECT_LT(worst, 2.);  // as the header promises
  EXPECT_EQ(portable::sine(0.), 0.);
  EXPECT_EQ(portable::cosine(0.), 1.);
}

// Check angles of points in all quadrants, on the axes and of any ratio, and of cosines.
TEST(PortableMath, ArctangentsAreThoseOfAWiderType) {
  Random random(2, 0);
  double worst = 0.;
  for (int i = 0; i < kTries; ++i) {
    const double y = (2. * random.uniformDouble() - 1.) * std::pow(10., 6. * random.uniformDouble() - 3.);
    const double x = 2. * random.uniformDouble() - 1.;
    worst = std::max(worst, unitsOff(portable::arctangent(y, x),
                                     std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
    worst = std::max(worst, unitsOff(portable::arccosine(x), std::acos(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 2.);  // as the header promises
  EXPECT_EQ(portable::arctangent(0., 0.), 0.);
  EXPECT_EQ(portable::arctangent(0., -1.), std::numbers::pi);
  EXPECT_EQ(portable::arctangent(1., 0.), 0.5 * std::numbers::pi);
  EXPECT_EQ(portable::arctangent(-1., 0.), -0.5 * std::numbers::pi);
  EXPECT_EQ(portable::arccosine(1.), 0.);
  EXPECT_EQ(portable::arccosine(-1.), std::numbers::pi);
}

// Check powers: an error of the logarithm's last place grows with the exponent.
TEST(PortableMath, PowersAreThoseOfAWiderType) {
  Random random(3, 0);
  for (int i = 0; i < kTries; ++i) {
    const double base = random.uniformDouble() * std::pow(10., 4. * random.uniformDouble() - 2.);
    const double exponent = 10. * random.uniformDouble();
    const double size = std::abs(exponent * std::log(base));
    ASSERT_LT(unitsOff(portable::power(base, exponent),
                       std::pow(static_cast<long double>(base), static_cast<long double>(exponent))),
              4. + 2. * size)
        << base << " ^ " << exponent;
  }
  EXPECT_EQ(portable::power(0., 2.), 0.);
  EXPECT_EQ(portable::power(0., 0.), 1.);
  EXPECT_EQ(portable::power(1., 7.), 1.);
  EXPECT_EQ(portable::power(0.5, 1e4), 0.);
  EXPECT_EQ(portable::length(3., 4.), 5.);
}
