#include "spp/slab_arrays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.hpp"
#include "core/require.hpp"
#include "spp/stream_slab.hpp"

#define SUNFLECK_ISA lanes_test
#define SUNFLECK_VECTOR_BYTES 16
#include "spp/detail/lanes.hpp"

// Check that the closed forms over arrays are those of one place after another, whatever the size of the arrays.
namespace {

using namespace sunfleck;
using namespace sunfleck::spp;

// What slab_arrays.hpp promises.
constexpr double kTolerance = 5e-6;

struct Places {
  std::vector<float> depth, thickness;

  explicit Places(std::size_t count) {
    Random random(3, count);
    for (std::size_t i = 0; i < count; ++i) {
      thickness.push_back(std::exp(10.f * random.uniform() - 5.f));
      depth.push_back(1.1f * thickness.back() * random.uniform());  // some beyond the face
    }
    if (count > 3) thickness[3] = std::numeric_limits<float>::infinity();
    if (count > 4) thickness[4] = 0.f;
  }
};

// Check e^x of the lanes against double precision from 0 down to where the normal numbers end: 1 unit in the last place
// and half a one for rounding; and its corners.
TEST(Lanes, HaveAnExponentialToOneUlp) {
  using lanes_test::Lanes;
  for (float x = 0.f; x > -87.33f; x -= 0.000913f) {
    const double expected = std::exp(double{x});
    const float rounded = static_cast<float>(expected);
    const double ulp = double{std::nextafter(rounded, 2.f)} - double{rounded};
    ASSERT_NEAR(double{exp(Lanes(x)).of[0]}, expected, 1.5 * ulp) << x;
  }
  for (const float x : {0.f, -0.f, -std::numeric_limits<float>::denorm_min(), -1e-30f})
    EXPECT_EQ(exp(Lanes(x)).of[1], 1.f);
  for (const float x : {-88.f, -1e30f, -std::numeric_limits<float>::infinity()}) EXPECT_EQ(exp(Lanes(x)).of[2], 0.f);
}

// Check that a call fills its outputs and nothing beyond, for sizes around those of a vector.
TEST(S2_SppArrays, AreThePowersOfEachPlace) {
  for (std::size_t count : {0, 1, 3, 4, 5, 7, 8, 9, 15, 16, 17, 33, 1000}) {
    const Places places(count);
    std::vector<float> down(count + 1, -7.f), up(count + 1, -7.f);
    sppPowers(places.depth, places.thickness, 0.7f, 0.9f, 0.6f, std::span(down).first(count),
              std::span(up).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const auto exact = precise::sppPowers(double{places.depth[i]}, double{places.thickness[i]}, double{0.7f},
                                            double{0.9f}, double{0.6f});
      EXPECT_NEAR(double{down[i]}, exact.down, kTolerance);
      EXPECT_NEAR(double{up[i]}, exact.up, kTolerance);
    }
    EXPECT_EQ(down.back(), -7.f);
    EXPECT_EQ(up.back(), -7.f);
  }
}

// Check the radiance of each half, also at places beyond the face, where the direct light is that at the face.
TEST(S3_SppArrays, AreTheRadianceOfEachPlace) {
  const Places places(77);
  std::vector<float> down(77), up(77);
  sppRadiance(places.depth, places.thickness, 0.3f, 0.9f, 0.6f, down, up);
  for (std::size_t i = 0; i < down.size(); ++i) {
    const double thickness = double{places.thickness[i]}, depth = std::min(double{places.depth[i]}, thickness);
    const auto powers = precise::sppPowers(depth, thickness, double{0.3f}, double{0.9f}, double{0.6f});
    const auto exact = precise::sppDiffuseRadiance(powers, precise::directPower(depth, double{0.3f}));
    EXPECT_NEAR(double{down[i]}, exact.down, kTolerance);
    EXPECT_NEAR(double{up[i]}, exact.up, kTolerance);
  }
}

// Check powers and radiance of all numbers of streams and of several orders against StreamSlab in double, whose systems
// of equations are solved in another way.
TEST(S9_StreamArrays, AreTheSlabsOfEachPlace) {
  for (int n : StreamArrays::kStreams)
    for (const BeamInMedium& medium : {BeamInMedium{0., 0.95, 1.}, {0.7, 1., 0.3}, {-0.4, 0.6, 0.01}}) {
      const StreamConstants constants = nStreamConstants(medium, n, n == 1 ? 2 : 3);
      const StreamArrays arrays(constants);
      for (std::size_t count : {1, 16, 77}) {
        const Places places(count);
        std::vector<float> down(count + 1, -7.f), up(count + 1, -7.f), radiance(count + 1, -7.f);
        arrays.powers(places.depth, places.thickness, std::span(down).first(count), std::span(up).first(count));
        for (double mu : {-1., -0.3, 0.05, 0.8}) {
          const auto view = streamView<float>(constants, mu, 1.);
          arrays.refinedRadiance(places.depth, places.thickness, view, std::span(radiance).first(count));
          for (std::size_t i = 0; i < count; ++i) {
            if (places.thickness[i] == 0.f) continue;  // no slab: StreamSlab refuses it
            const StreamSlab<double> slab(constants, double{places.thickness[i]});
            const double depth = double{places.depth[i]};
            EXPECT_NEAR(double{down[i]}, slab.light(depth).power_down, kTolerance) << n;
            EXPECT_NEAR(double{up[i]}, slab.light(depth).power_up, kTolerance) << n;
            EXPECT_NEAR(double{radiance[i]}, slab.refinedRadiance(depth, slab.view(mu, 1.)), kTolerance) << n;
          }
          EXPECT_EQ(radiance.back(), -7.f);
        }
        EXPECT_EQ(down.back(), -7.f);
        EXPECT_EQ(up.back(), -7.f);
      }
    }
}

// Check a slab of no thickness: the direct light and nothing else.
TEST(S9_StreamArrays, KnowTheSlabOfNoThickness) {
  const std::vector<float> zero(5, 0.f);
  std::vector<float> down(5), up(5), radiance(5);
  const StreamConstants constants = nStreamConstants({0.3, 1., 0.5}, 2, 1);
  const StreamArrays arrays(constants);
  arrays.powers(zero, zero, down, up);
  arrays.refinedRadiance(zero, zero, streamView<float>(constants, -0.5, 0.), radiance);
  for (std::size_t i = 0; i < zero.size(); ++i) {
    EXPECT_NEAR(down[i], 1.f, 1e-6f);  // a few roundings
    EXPECT_NEAR(up[i], 0.f, 1e-6f);
    EXPECT_NEAR(radiance[i], 0.f, 1e-6f);
  }
}

TEST(S9_StreamArrays, RefuseNumbersOfStreamsTheyAreNotBuiltFor) {
  EXPECT_THROW(StreamArrays(nStreamConstants({0., 0.5, 1.}, 5, 1)), InvalidInput);
}

}  // namespace
