#include "grid/detail/block_visits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace sunfleck;

namespace {

// Listed in the order of visitors; in blocks whose x, y and z are below `span` each.
std::vector<Visit> listed(std::size_t count, const glm::ivec3& span) {
  std::mt19937_64 random(1);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<std::uint64_t>(end)); };
  std::vector<Visit> visits;
  for (std::uint32_t i = 0; i < count; ++i) {
    const int x = below(span.x), y = below(span.y), z = below(span.z);
    visits.push_back({blockKey({x, y, z}), i});
  }
  return visits;
}

void expectSorted(std::vector<Visit> visits) {
  const SortedVisits sorted(visits);
  std::stable_sort(visits.begin(), visits.end(), [](const Visit& a, const Visit& b) { return a.block < b.block; });
  std::size_t next = 0;
  for (std::size_t block = 0; block < sorted.blocks(); ++block) {
    const std::span<const Visit> of_block = sorted.ofBlock(block);
    ASSERT_FALSE(of_block.empty());
    for (const Visit& visit : of_block) {
      ASSERT_LT(next, visits.size());
      ASSERT_EQ(visit.block, of_block[0].block);
      ASSERT_EQ(visit.block, visits[next].block);
      ASSERT_EQ(visit.visitor, visits[next++].visitor);
    }
    ASSERT_TRUE(next == visits.size() || visits[next].block != of_block[0].block);
  }
  EXPECT_EQ(next, visits.size());
}

}  // namespace

// Check that visits come block after block, those of a block as they were listed: in few blocks and in the most that a
// key can tell apart, in one part and in many.
TEST(D2_BlockVisits, AreSortedByBlock) {
  constexpr int kMost = 1 << 21;
  for (const glm::ivec3& span :
       {glm::ivec3(1), glm::ivec3(1, 5, 1), glm::ivec3(60, 60, 60), glm::ivec3(kMost, 3, kMost), glm::ivec3(kMost)})
    for (const std::size_t count : {0u, 1u, 1'000u, 100'000u}) expectSorted(listed(count, span));
}
