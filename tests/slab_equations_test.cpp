#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "spp/slab.hpp"

// Check the shared formulas against the equations they solve, with exact derivatives: they take a number that carries
// its derivative by the depth.
namespace {

using namespace sunfleck;

struct Dual {
  double value = 0., slope = 0.;

  Dual() = default;
  Dual(double v) : value(v) {}
  Dual(double v, double s) : value(v), slope(s) {}

  friend Dual operator-(Dual a) { return {-a.value, -a.slope}; }
  friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.value * b.slope + a.slope * b.value}; }
  friend Dual operator/(Dual a, Dual b) {
    const double q = a.value / b.value;
    return {q, b.slope == 0. ? a.slope / b.value : (a.slope - q * b.slope) / b.value};
  }
  Dual& operator+=(Dual b) { return *this = *this + b; }
  Dual& operator-=(Dual b) { return *this = *this - b; }
  Dual& operator*=(Dual b) { return *this = *this * b; }
  friend bool operator<(Dual a, Dual b) { return a.value < b.value; }
};
Dual exp(Dual a) {
  return {std::exp(a.value), a.slope == 0. ? 0. : a.slope * std::exp(a.value)};
}
Dual sqrt(Dual a) {
  return std::sqrt(a.value);  // only of what does not depend on the depth
}
Dual abs(Dual a) {
  return a.value < 0. ? -a : a;
}

}  // namespace

template <>
struct sunfleck::spp::PrecisionOf<Dual> {
  using Real = double;
};

namespace {

using Formulas = spp::StreamFormulas<Dual>;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
const std::vector<double> kAlbedos{0., 0.5, 0.95, 0.9999, 1. - 0x1p-24, 1. - 1e-12, 1. - 1e-15, 1.};
const std::vector<double> kShares{0., 0.2, 0.5, 0.9, 0.999999, 1.};
const std::vector<double> kCosines{1., 0.6, 0.05, 1e-3, 1e-7};
const std::vector<double> kThicknesses{1e-30, 1e-8, 1e-3, 0.3, 2., 50., 1e4, 1e9, 1e30, kInfinite};

// (S2) Check mu0 P+' = -P+ + omega (T P+ + R P-), -mu0 P-' = -P- + omega (R P+ + T P-), P+(0) = 1 and P-(w) = 0 over
// the range in which the formulas are stressed. Error: some ten roundings of the powers of the place, however dim it is
// (those below 1e-290 have lost digits).
TEST(S2_SppPowers, SolvesItsEquationsToRounding) {
  double worst = 0., worst_boundary = 0.;
  for (double omega : kAlbedos)
    for (double T : kShares)
      for (double mu0 : kCosines)
        for (double w : kThicknesses) {
          const auto at = [&](double z) { return Formulas::sppPowers(Dual(z, 1.), w, mu0, omega, T); };
          for (double part : {0., 1e-9, 0.1, 0.5, 0.999, 1.})
            for (double z : {part * std::min(w, 1e30), part * std::min({w, mu0, 1e30})}) {
              const auto [down, up] = at(z);
              const double R = 1. - T;
              const double left =
                  std::max(std::abs(mu0 * down.slope + down.value - omega * (T * down.value + R * up.value)),
                           std::abs(-mu0 * up.slope + up.value - omega * (R * down.value + T * up.value)));
              worst = std::max(worst, left / (down.value + up.value + 1e-290));
              ASSERT_TRUE(std::isfinite(down.slope + up.slope)) << omega << " " << T << " " << mu0 << " " << w;
            }
          worst_boundary = std::max(worst_boundary, std::abs(at(0.).down.value - 1.));
          EXPECT_EQ(at(w).up.value, 0.) << omega << " " << T << " " << mu0 << " " << w;
        }
  EXPECT_LT(worst, 2e-15);
  EXPECT_LT(worst_boundary, 1e-14);
  RecordProperty("worst", std::to_string(worst * 1e15));
}

// (S2) Check against the equations integrated step by step from the far face, where P+ = 1 and P- = 0, to the lit one,
// and then scaled to P+ = 1 there. Runge and Kutta's error is (h / mu0)^4 / 100 of the powers, below 1e-10 for 2,000
// steps.
TEST(S2_SppPowers, IsTheNumericalIntegral) {
  constexpr int kSteps = 2000;
  for (double omega : {0., 0.5, 0.95, 1.})
    for (double T : {0.2, 0.5, 0.9})
      for (double mu0 : {0.3, 1.})
        for (double w : {0.1, 1., 5.}) {
          struct Powers {
            double down, up;
          };
          const auto slope = [&](Powers p) {
            return Powers{(-p.down + omega * (T * p.down + (1. - T) * p.up)) / mu0,
                          (p.up - omega * ((1. - T) * p.down + T * p.up)) / mu0};
          };
          const auto moved = [](Powers p, Powers by, double h) {
            return Powers{p.down + h * by.down, p.up + h * by.up};
          };
          std::vector<Powers> powers{{1., 0.}};
          const double h = -w / kSteps;
          for (int i = 0; i < kSteps; ++i) {
            const Powers p = powers.back(), a = slope(p), b = slope(moved(p, a, 0.5 * h)),
                         c = slope(moved(p, b, 0.5 * h)), d = slope(moved(p, c, h));
            powers.push_back({p.down + h / 6. * (a.down + 2. * b.down + 2. * c.down + d.down),
                              p.up + h / 6. * (a.up + 2. * b.up + 2. * c.up + d.up)});
          }
          for (int i = 0; i <= kSteps; i += 50) {
            const auto found = spp::precise::sppPowers(w - w * i / kSteps, w, mu0, omega, T);
            const std::size_t step = static_cast<std::size_t>(i);
            EXPECT_NEAR(found.down, powers[step].down / powers.back().down, 1e-9);
            EXPECT_NEAR(found.up, powers[step].up / powers.back().down, 1e-9);
          }
        }
}

// (S2) Check that no light is lost at albedo 1: P+ - P- is the same at all depths. And a thin slab: P- = omega R w /
// mu0, with an error of second order. Errors: a few roundings; 4 (w / mu0)^2.
TEST(S2_SppPowers, ConservesEnergyAndMeetsTheThinSlab) {
  for (double T : kShares)
    for (double mu0 : kCosines)
      for (double w : kThicknesses) {
        const double through = spp::precise::sppPowers(w, w, mu0, 1., T).down;
        for (double part : {0., 1e-6, 0.3, 0.9}) {
          const auto [down, up] = spp::precise::sppPowers(part * std::min(w, 1e30), w, mu0, 1., T);
          EXPECT_NEAR(down - up, through, 1e-14) << T << " " << mu0 << " " << w;
        }
        const double thin = 1e-5 * mu0;
        EXPECT_NEAR(spp::precise::sppPowers(0., thin, mu0, 0.8, T).up, 0.8 * (1. - T) * 1e-5, 4e-10);
      }
}

// (S2) Check that nothing jumps where the series takes over, 2 k w = 1/2 and 2 k (w - z) = 1/2: across it both
// precisions move no more than they do elsewhere. Error: rounding, 10 units in the last place of 1.
TEST(S2_SppPowers, IsContinuousWhereItsSeriesBegin) {
  const double omega = 0.9, T = 0.5, mu0 = 0.8;
  const double k = std::sqrt((1. - omega * (2. * T - 1.)) * (1. - omega)) / mu0, change = 0.25 / k;
  for (double w : {change, 3.}) {
    const auto scan = [&](auto powers, double step, double rounding) {
      auto before = powers(-1);
      for (int i = 0; i < 2000; ++i) {
        const auto now = powers(i);
        // Slopes are below 2 / mu0.
        EXPECT_NEAR(double{now.down}, double{before.down}, 2.5 * (i == 0 ? 1002. : 1.) * step + rounding);
        EXPECT_NEAR(double{now.up}, double{before.up}, 2.5 * (i == 0 ? 1002. : 1.) * step + rounding);
        before = now;
      }
    };
    const auto thickness = [&](int i, double step) { return w + (w == change ? (i - 1000) * step : 0.); };
    const auto depth = [&](int i, double step) { return w == change ? 0.5 * w : w - change + (i - 1000) * step; };
    scan([&](int i) { return spp::precise::sppPowers(depth(i, 1e-15), thickness(i, 1e-15), mu0, omega, T); }, 1e-15,
         2.2e-15);
    scan(
        [&](int i) {
          return spp::sppPowers(static_cast<float>(depth(i, 1e-7)), static_cast<float>(thickness(i, 1e-7)), 0.8f, 0.9f,
                                0.5f);
        },
        1e-7, 1e-6);
  }
}

// (S9) Check u' = -v + a e^-Kz and v' = -k^2 u + b e^-Kz, b = g (K + k) - a K, for rates from 0 over equal ones to far
// apart and at the changes to the series. Error: rounding of the largest term.
TEST(S9_ModeField, SolvesItsEquationsToRounding) {
  const double a = 0.7, gain = 0.4, even = 0.3, odd = -0.2;
  for (double k : {0., 1e-12, 1e-4, 0.1, 1., 1. + 1e-9, 1.5, 40.})
    for (double K : {1., 1. + 1e-9, 1.499999, 3., 1e3, 1e7})
      for (double w : {1e-30, 1e-6, 0.5, 1., 4.999999, 5.000001, 300., 1e9, 1e30})
        for (double part : {0., 1e-6, 0.25, 0.5, 0.75, 1.}) {
          const auto at = Formulas::slabPlace(Dual(part * w, 1.), w, 1., K);
          const auto [u, v] = Formulas::modeField({.rate = k, .gain = gain, .entering = a - gain},
                                                  {.even = even, .odd = odd}, Formulas::modeShapes(k, at), at);
          const double direct = at.direct.value, b = gain * (K + k) - a * K;
          const double scale = 1. + K + k * k + std::abs(v.value) + k * k * std::abs(u.value);
          EXPECT_NEAR(u.slope, -v.value + a * direct, 4e-15 * scale) << k << " " << K << " " << w << " " << part;
          EXPECT_NEAR(v.slope, -k * k * u.value + b * direct, 4e-15 * scale)
              << k << " " << K << " " << w << " " << part;
        }
}

// (S9) Check that the shapes of a mode are even and odd about the slab's middle. Error: rounding.
TEST(S9_ModeShapes, AreMirrorImages) {
  using Precise = spp::StreamFormulas<double>;
  for (double k : {0., 1e-6, 0.3, 2., 1e3})
    for (double w : {1e-9, 0.4, 7., 1e6})
      for (double part : {0., 0.125, 0.25, 0.5}) {  // w - z is exact
        const auto here = Precise::modeShapes(k, Precise::slabPlace(part * w, w, 1., 1.));
        const auto there = Precise::modeShapes(k, Precise::slabPlace(w - part * w, w, 1., 1.));
        EXPECT_NEAR(here.even, there.even, 1e-15);
        EXPECT_NEAR(here.odd, -there.odd, 1e-15 * w);
      }
}

// (S9, S10) Check that the quotients do not jump where their series take over, by a dense scan of the rates around it.
// Error: rounding of a difference of exponentials, over the 0.4 that it is there, and twice for the quotient of three.
TEST(S10_RateQuotients, AreContinuousWhereTheirSeriesBegin) {
  const auto scan = [](auto one, double step, double rounding) {
    using Real = decltype(one);
    using F = spp::StreamFormulas<Real>;
    const auto fade = [](Real rate) { return std::exp(-rate); };
    for (double base : {0., 0.3, 2.}) {
      const Real p = static_cast<Real>(base);
      double last = 0., last_of_three = 0.;
      for (int i = -2000; i <= 2000; ++i) {
        const Real q = static_cast<Real>(base + 0.5 + i * step), r = p + Real(0.25);
        const double now = double{F::rateQuotient(p, q, one, fade(p), fade(q))};
        const double of_three = double{F::rateQuotientOfThree(p, q, r, one, fade(p), fade(q), fade(r))};
        if (i > -2000) {
          EXPECT_NEAR(now, last, step + rounding);
          EXPECT_NEAR(of_three, last_of_three, step + 5. * rounding);
        }
        last = now;
        last_of_three = of_three;
      }
    }
  };
  scan(1., 1e-15, 2e-15);
  scan(1.f, 1e-7, 6e-7);
}

}  // namespace
