// Check that the Sobol' points are those of the direction numbers, and that scrambling keeps them even.
#include "render/reference/detail/owen_sobol.hpp"

#include <gtest/gtest.h>

#include <set>

using namespace sunfleck::detail;

TEST(OwenSobol, SecondDimensionFollowsItsDirectionNumbers) {
  for (const std::uint32_t index : {0u, 1u, 2u, 3u, 4u, 5u, 77u, 0x80000000u, 0xdeadbeefu, 0xffffffffu}) {
    std::uint32_t expected = 0, direction = 1u << 31;
    for (std::uint32_t rest = index; rest != 0; rest >>= 1, direction ^= direction >> 1)
      if (rest & 1u) expected ^= direction;
    EXPECT_EQ(secondSobol(reversedBits(index)), expected) << index;
  }
}

// Each of the 256 rectangles of any one shape holds one of 256 points: a (0, 8, 2)-net, scrambled or not.
TEST(OwenSobol, PointsAreANet) {
  for (const std::uint32_t dimension : {0u, 1u, 2u})
    for (std::uint32_t bits = 0; bits <= 8; ++bits) {
      std::set<std::uint64_t> met;
      for (std::uint32_t index = 0; index < 256; ++index) {
        const auto [u, v] = scrambledSobol(index, {1u, 0x12345678u, 0xffffffffu}, dimension);
        met.insert((std::uint64_t{u} >> (32 - bits)) << 32 | std::uint64_t{v} >> (24 + bits));
      }
      EXPECT_EQ(met.size(), 256u) << dimension << ' ' << bits;
    }
}
