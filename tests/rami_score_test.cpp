// Check that the score of RAMI-IV passes, fails and doubts where its definition says so.
#include "render/compare/rami_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace sunfleck;

TEST(R13_RamiScore, IsTheDifferenceByWhatIsAllowed) {
  // Numbers of which all roots are whole: 3 % of 1 and an error of 0.04 allow 0.05; errors of 0.03 and 0.04 make 0.05.
  const RamiScore score = ramiScore({1.1, 0.03}, {1., 0.04});
  EXPECT_NEAR(score.percent, 10., 1e-12);
  EXPECT_NEAR(score.z, 2., 1e-12);
  EXPECT_NEAR(score.z_prime, 2., 1e-12);
  EXPECT_NEAR(ramiScore({0.9, 0.03}, {1., 0.04}).z, -2., 1e-12);
  EXPECT_NEAR(ramiScore({0.9, 0.03}, {1., 0.04}).z_prime, 2., 1e-12);
}

TEST(R13_RamiScore, PassesUnderTwoAndFailsOverThree) {
  const auto verdict = [](double value, double u) { return ramiScore({value, 0.}, {1., u}).verdict; };
  EXPECT_EQ(verdict(1.059, 0.), RamiVerdict::pass);
  EXPECT_EQ(verdict(0.941, 0.), RamiVerdict::pass);
  EXPECT_EQ(verdict(1.061, 0.), RamiVerdict::unclear);
  EXPECT_EQ(verdict(0.911, 0.), RamiVerdict::unclear);
  EXPECT_EQ(verdict(1.091, 0.), RamiVerdict::fail);
  EXPECT_EQ(verdict(0.909, 0.), RamiVerdict::fail);
  // A reference of larger error than 3 % lets nobody pass, however near, but what fails in spite of it fails.
  EXPECT_EQ(verdict(1.07, 0.0299), RamiVerdict::pass);
  EXPECT_EQ(verdict(1., 0.0301), RamiVerdict::uncertain);
  EXPECT_EQ(verdict(1.11, 0.04), RamiVerdict::uncertain);
  EXPECT_EQ(verdict(1.16, 0.04), RamiVerdict::fail);
}

TEST(R13_RamiScore, HasNoNanWhereNothingIsAllowed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const RamiScore same = ramiScore({0., 0.}, {0., 0.}), off = ramiScore({-0.1, 0.}, {0., 0.});
  EXPECT_EQ(same.percent, 0.);
  EXPECT_EQ(same.z, 0.);
  EXPECT_EQ(same.verdict, RamiVerdict::pass);
  EXPECT_EQ(off.percent, -kInfinity);
  EXPECT_EQ(off.z, -kInfinity);
  EXPECT_EQ(off.z_prime, kInfinity);
  EXPECT_EQ(off.verdict, RamiVerdict::fail);
}
