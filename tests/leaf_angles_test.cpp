// Check that leaf angle distributions are what their sources say, are told from wrong input, and project as they must.
#include "scattering/leaf_angles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "scattering/leaf_scattering.hpp"

namespace {

using namespace sunfleck;
constexpr double kPi = std::numbers::pi, kUpright = 0.5 * kPi;
const std::vector<const char*> kNames{"spherical",   "planophile",   "erectophile",
                                      "plagiophile", "extremophile", "uniform"};

std::vector<std::pair<std::string, LeafAngles>> manyAngles() {
  std::vector<std::pair<std::string, LeafAngles>> all;
  for (const char* name : kNames) all.emplace_back(name, LeafAngles::named(name));
  for (double ratio : {1e-3, 0.05, 0.5, 1., 2.5, 80., 1e3})
    all.emplace_back("ellipsoidal " + std::to_string(ratio), LeafAngles::ellipsoidal(ratio));
  for (auto [mean, deviation] :
       {std::pair{0.8, 0.3}, {0.3, 0.1}, {0.785, 0.575}, {0.785, 0.7}, {1.5, 0.05}, {0.4, 1e-3}})
    all.emplace_back("beta " + std::to_string(mean) + " " + std::to_string(deviation),
                     LeafAngles::beta(mean, deviation));
  all.emplace_back("table", LeafAngles::table({0., 0.5, 1., kUpright}, {1., 2., 0., 1.}));
  all.emplace_back("steep table", LeafAngles::table({0.1, 0.7, 0.7000001, 1.2}, {0., 0., 3., 1.}));
  all.emplace_back("narrow table", LeafAngles::table({0.3, 0.300001}, {1., 1.}));
  return all;
}

template <typename Function>
double nodeMean(const LeafAngles& angles, const Function& value) {
  double sum = 0.;
  for (const LeafAngles::Node& node : angles.nodes()) sum += node.weight * value(node.inclination);
  return sum;
}

TEST(P20_LeafAngles, WeighTheirNodesToOne) {
  for (const auto& [name, angles] : manyAngles()) {
    double sum = 0., last = -1.;
    for (const LeafAngles::Node& node : angles.nodes()) {
      EXPECT_GT(node.weight, 0.) << name;
      EXPECT_GE(node.inclination, last) << name;  // a node per double where leaves are all upright
      EXPECT_LE(node.inclination, kUpright) << name;
      last = node.inclination;
      sum += node.weight;
    }
    EXPECT_NEAR(sum, 1., 1e-15 * 8) << name;  // roundings of a sum of 64
  }
}

// Means of the inclination by hand. Error: roundings of 64 polynomials' recurrences, measured 1e-15.
TEST(P20_LeafAngles, HaveTheMeansOfTheirFormulas) {
  const auto inclination = [](double t) { return t; };
  const double oblique = 0.25 * kPi;
  EXPECT_NEAR(nodeMean(LeafAngles::spherical(), inclination), 1., 1e-13);
  EXPECT_NEAR(nodeMean(LeafAngles::planophile(), inclination), oblique - 1. / kPi, 1e-13);
  EXPECT_NEAR(nodeMean(LeafAngles::erectophile(), inclination), oblique + 1. / kPi, 1e-13);
  for (const char* name : {"plagiophile", "extremophile", "uniform"})
    EXPECT_NEAR(nodeMean(LeafAngles::named(name), inclination), oblique, 1e-13) << name;
  const auto fourfold = [](double t) { return std::cos(4. * t); };
  EXPECT_NEAR(nodeMean(LeafAngles::plagiophile(), fourfold), -0.5, 1e-13);
  EXPECT_NEAR(nodeMean(LeafAngles::extremophile(), fourfold), 0.5, 1e-13);
  EXPECT_NEAR(nodeMean(LeafAngles::uniform(), [](double t) { return std::pow(t / kUpright, 127); }), 1. / 128., 1e-14);
}

// Campbell 1990, with the normalisation of each side of ratio 1. Error: a few roundings, of values up to 1000.
TEST(P20_LeafAngles, EllipsoidalHasCampbellsDensity) {
  for (double ratio : {0.01, 0.4, 1., 1.7, 30.}) {
    const double e = std::sqrt(std::abs(1. - (ratio < 1. ? ratio * ratio : 1. / (ratio * ratio))));
    const double normalisation = ratio == 1.  ? 2.
                                 : ratio < 1. ? ratio + std::asin(e) / e
                                              : ratio + std::log((1. + e) / (1. - e)) / (2. * e * ratio);
    for (double t : {0.01, 0.3, 0.8, 1.2, 1.56}) {
      const double square = std::pow(std::cos(t), 2) + std::pow(ratio * std::sin(t), 2);
      const double wanted = 2. * std::pow(ratio, 3) * std::sin(t) / (normalisation * square * square);
      EXPECT_NEAR(LeafAngles::ellipsoidal(ratio).density(t) / wanted, 1., 1e-11) << ratio << " " << t;
    }
  }
}

// Error: that of the fine rule near poles of strength x^-0.9, and of its truncation there.
TEST(P20_LeafAngles, BetaHasItsMeanAndDeviation) {
  for (auto [mean, deviation] :
       {std::pair{0.8, 0.3}, {0.3, 0.1}, {0.785, 0.575}, {0.785, 0.7}, {1.5, 0.05}, {0.4, 1e-3}, {0.1, 0.2}}) {
    const LeafAngles angles = LeafAngles::beta(mean, deviation);
    const double found = nodeMean(angles, [](double t) { return t; });
    EXPECT_NEAR(found, mean, 1e-12) << mean << " " << deviation;
    EXPECT_NEAR(std::sqrt(nodeMean(angles, [&](double t) { return (t - found) * (t - found); })), deviation, 1e-11);
  }
  // Exponents 1 and 1 are all inclinations alike.
  const LeafAngles flat = LeafAngles::beta(0.25 * kPi, kUpright / std::sqrt(12.));
  for (double t : {0.1, 0.5, 1.5}) EXPECT_NEAR(flat.density(t), 2. / kPi, 1e-12);
}

TEST(P20_LeafAngles, TableIsJoinedByStraightLines) {
  const LeafAngles angles = LeafAngles::table({0.2, 0.6, 1.4}, {0., 5., 0.});
  EXPECT_NEAR(angles.density(0.4), 1. / 1.2, 1e-13);  // a triangle of base 1.2 and area 1
  EXPECT_NEAR(angles.density(1.), 1. / 1.2, 1e-13);
  EXPECT_EQ(angles.density(0.1), 0.);
  EXPECT_EQ(angles.density(1.5), 0.);
  EXPECT_NEAR(nodeMean(angles, [](double t) { return t; }), (0.2 + 0.6 + 1.4) / 3., 1e-13);
}

TEST(P20_LeafAngles, TellWrongInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double ratio : {0., -1., nan, 1e4, std::numeric_limits<double>::infinity()})
    EXPECT_THROW(LeafAngles::ellipsoidal(ratio), InvalidInput) << ratio;
  for (auto [mean, deviation] : {std::pair{0., 0.1},
                                 {kUpright, 0.1},
                                 {nan, 0.1},
                                 {0.8, nan},
                                 {0.8, 0.},
                                 {0.8, 0.79},
                                 {0.785, 0.785},
                                 {0.01, 0.1},
                                 {1e-9, 1e-3}})
    EXPECT_THROW(LeafAngles::beta(mean, deviation), InvalidInput) << mean << " " << deviation;
  EXPECT_THROW(LeafAngles::table({}, {}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0.5}, {1.}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0., 1.}, {1., 1., 1.}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0., 1.}, {0., 0.}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0., 1.}, {1., -1.}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0., 1.}, {1., nan}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0., 0.}, {1., 1.}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0., nan}, {1., 1.}), InvalidInput);
  EXPECT_THROW(LeafAngles::table({0., 1.6}, {1., 1.}), InvalidInput);
  EXPECT_THROW(LeafAngles::named("sphericle"), InvalidInput);
  EXPECT_THROW(LeafAngles::named(""), InvalidInput);
  try {
    LeafAngles::table({0., 1., 0.5}, {1., 1., 1.});
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "leaf angle table: inclination 3 = 0.5: must be above the one before");
  }
}

// Whatever surface closed by convexity the leaves cover, G is its shadow: constant for the sphere, the ellipsoid's
// sqrt(x^2 mu^2 + 1 - mu^2) over Campbell's normalisation. Error: roundings, of ratios up to 1000 1e-13.
TEST(P20_LeafProjection, IsTheShadowOfAnEllipsoid) {
  for (double mu : {0., 1e-9, 0.01, 0.3, 0.7, 0.999, 1.}) {
    EXPECT_NEAR(leafProjection(LeafAngles::spherical(), mu), 0.5, 1e-14) << mu;
    for (double ratio : {1e-3, 0.02, 0.5, 3., 40., 1e3}) {
      const double e = std::sqrt(std::abs(1. - (ratio < 1. ? ratio * ratio : 1. / (ratio * ratio))));
      const double normalisation = ratio < 1. ? ratio + std::asin(e) / e : ratio + std::atanh(e) / (e * ratio);
      EXPECT_NEAR(leafProjection(LeafAngles::ellipsoidal(ratio), mu),
                  std::sqrt(ratio * ratio * mu * mu + (1. - mu) * (1. + mu)) / normalisation, 1e-12)
          << ratio << " " << mu;
    }
  }
}

// Looking straight down, G is the mean cosine; along the ground, 2/pi of the mean sine: smooth, so that the nodes know
// them. 1e-11 for the steepest distributions.
TEST(P20_LeafProjection, IsKnownAtBothEnds) {
  for (const auto& [name, angles] : manyAngles()) {
    EXPECT_NEAR(leafProjection(angles, 1.), nodeMean(angles, [](double t) { return std::cos(t); }), 1e-11) << name;
    EXPECT_NEAR(leafProjection(angles, 0.), nodeMean(angles, [](double t) { return 2. / kPi * std::sin(t); }), 1e-11)
        << name;
  }
}

// The mean of |n . s| over all s is 1/2, whatever n. Midpoints in mu of a function that is smooth but at mu = 0: an
// error of 1 / count^2, measured 2e-8 for 2000.
TEST(P20_LeafProjection, AveragesToOneHalf) {
  for (const char* name : kNames) {
    double sum = 0.;
    constexpr int kCount = 2000;
    for (int i = 0; i < kCount; ++i) sum += leafProjection(LeafAngles::named(name), (i + 0.5) / kCount) / kCount;
    EXPECT_NEAR(sum, 0.5, 2e-7) << name;
  }
}

// What 64 inclinations lack at the kink: 7e-6 to 9e-6 at worst, 1.3e-5 for the narrow beta distribution.
TEST(P20_LeafProjection, IsNearWhatTheNodesSay) {
  for (const auto& [name, angles] : manyAngles())
    for (int i = 0; i <= 50; ++i) {
      const double mu = i / 50.;
      std::vector<double> modes(angles.nodes().size());
      leafProjectionModes(angles, 0, mu, modes);
      double sum = 0.;
      for (std::size_t r = 0; r < modes.size(); ++r) sum += angles.nodes()[r].weight * modes[r];
      EXPECT_NEAR(sum, leafProjection(angles, mu), 1.5e-5) << name << " " << mu;
    }
  EXPECT_THROW(leafProjection(LeafAngles::spherical(), 1.1), InvalidInput);
  EXPECT_THROW(leafProjection(LeafAngles::spherical(), std::numeric_limits<double>::quiet_NaN()), InvalidInput);
}

}  // namespace
