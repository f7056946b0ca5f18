#include "grid/stand_index.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "core/random.hpp"
#include "leaf_shapes.hpp"

namespace {

using namespace sunfleck;

// Whether the line through the origin along `axis` meets the box moved by `by`, in double precision; `slack` widens it.
bool meets(const Bounds& box, const glm::vec3& by, const Direction& axis, double slack) {
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
  for (int i = 0; i < 3; ++i) {
    const double low = double{box.low[i]} + double{by[i]} - slack, high = double{box.high[i]} + double{by[i]} + slack;
    if (axis[i] == 0.f) {
      if (low > 0. || high < 0.) return false;
      continue;
    }
    const double a = low / double{axis[i]}, b = high / double{axis[i]};
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

using Key = std::tuple<std::uint32_t, float, float, float>;

std::map<Key, int> visited(const StandIndex& index, const glm::vec3& from, const Bounds& box, const Direction& axis) {
  std::map<Key, int> times;
  index.along(from, box, axis, [&](std::uint32_t tree, const glm::vec3& d) { ++times[Key{tree, d.x, d.y, d.z}]; });
  return times;
}

// How many trees and copies there are, are met, and are visited.
struct Numbers {
  std::size_t there = 0, met = 0, visited = 0;
};

// Checks that all trees met from one place along one axis are visited, none twice.
Numbers expectAllMet(std::span<const glm::vec3> positions, float reach, std::optional<glm::vec2> period,
                     glm::ivec2 around, const glm::vec3& from, const Bounds& box, const Direction& axis) {
  const StandIndex index(positions, reach, period, around);
  const std::map<Key, int> times = visited(index, from, box, axis);
  Numbers numbers{.visited = times.size()};
  for (const auto& [key, count] : times) EXPECT_EQ(count, 1);
  const glm::vec2 sides = period.value_or(glm::vec2(0.f));
  for (std::uint32_t tree = 0; tree < positions.size(); ++tree)
    for (int row = -around.y; row <= around.y; ++row)
      for (int column = -around.x; column <= around.x; ++column) {
        if (std::isnan(positions[tree].x)) continue;
        ++numbers.there;
        const glm::vec3 shift(static_cast<float>(column) * sides.x, static_cast<float>(row) * sides.y, 0.f);
        const glm::vec3 d = (positions[tree] - from) + shift;
        if (!meets(box, d, axis, 0.)) continue;
        ++numbers.met;
        EXPECT_EQ(times.count(Key{tree, d.x, d.y, d.z}), 1u)
            << "tree " << tree << " at " << d.x << ", " << d.y << ", " << d.z << " along " << axis.x << ", " << axis.y
            << ", " << axis.z;
      }
  return numbers;
}

Bounds box(glm::vec3 low, glm::vec3 high) {
  Bounds box;
  box.include(low);
  box.include(high);
  return box;
}

Direction someAxis(Random& random) {
  const std::vector<Direction> straight{{1.f, 0.f, 0.f},   {0.f, -1.f, 0.f},  {0.f, 0.f, 1.f},  {0.f, 0.6f, 0.8f},
                                        {0.6f, 0.8f, 0.f}, {1e-7f, 0.f, 1.f}, {1.f, 1e-5f, 0.f}};
  const std::size_t which = random.bits() % (2 * straight.size());
  return which < straight.size() ? straight[which] : shapes::onSphere(random);
}

// Check that no tree that the line meets is passed over, for any direction, in stands on a slope, of one tree, of trees
// in a line and far apart; and for trees that stand nowhere.
TEST(StandIndex, FindsAllTreesThatALineMeets) {
  Random random(3, 0);
  const auto between = [&](float low, float high) { return low + (high - low) * random.uniform(); };
  std::size_t met = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const float spread_x = trial % 5 == 0 ? 0.f : std::exp(between(0.f, 8.f));
    const float spread_y = trial % 7 == 0 ? 0.f : std::exp(between(0.f, 8.f));
    const float slope = between(-1.f, 1.f);
    std::vector<glm::vec3> positions(1 + random.bits() % 60);
    for (glm::vec3& position : positions) {
      position = {between(-spread_x, spread_x), between(-spread_y, spread_y), 0.f};
      position.z = trial % 2 == 0 ? 0.f : slope * position.x + between(0.f, 1.f);
      if (random.bits() % 10 == 0) position = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    }
    const bool periodic = trial % 3 == 0;
    const auto period = periodic ? std::optional(glm::vec2(spread_x + 1.f, spread_y + 1.f)) : std::nullopt;
    const glm::vec3 from(between(-spread_x, spread_x), between(-spread_y, spread_y), between(-3.f, 3.f));
    const Bounds reached = box({between(-5.f, -1.f), between(-5.f, -1.f), between(-9.f, 0.f)},
                               {between(1.f, 5.f), between(1.f, 5.f), between(0.1f, 9.f)});
    met += expectAllMet(positions, between(0.5f, 20.f), period, periodic ? glm::ivec2(2, 3) : glm::ivec2(0), from,
                        reached, someAxis(random))
               .met;
  }
  EXPECT_GT(met, 5000u);
}

// Check that of many trees a line visits few: in a plot of 60 x 60, those along the line as wide as a tree is, twice:
// trees meet from as far as both are wide.
TEST(StandIndex, VisitsFewTrees) {
  std::vector<glm::vec3> positions;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) positions.emplace_back(4.f * static_cast<float>(x), 4.f * static_cast<float>(y), 0.f);
  const Bounds reached = box(glm::vec3(-4.f), glm::vec3(4.f));
  const glm::vec3 from = positions[30 * 60 + 30];
  const auto along = [&](const Direction& axis) {
    return expectAllMet(positions, 4.f, std::nullopt, glm::ivec2(0), from, reached, axis);
  };
  const Numbers down = along({0.f, 0.f, -1.f});  // 3 x 3 touch it; rounding may reach for one square more on each side
  EXPECT_EQ(down.met, 9u);
  EXPECT_LE(down.visited, 25u);
  const Numbers level = along({1.f, 0.f, 0.f});
  EXPECT_EQ(level.met, 3u * 60u);
  EXPECT_LE(level.visited, 5u * 60u);
  const Numbers slanted = along(glm::normalize(glm::vec3(1.f, 1.f, 1.f)));
  EXPECT_LE(slanted.visited, 50u);
  const Numbers diagonal = along(glm::normalize(glm::vec3(1.f, 1.f, 0.f)));
  EXPECT_LE(diagonal.visited, 7u * 60u);
}

// Check that what one tree sees of another is the exact opposite of what that one sees of it, so that sums can be taken
// back: in a periodic stand, whose copies' places are rounded.
TEST(StandIndex, SeesBothWaysAlike) {
  Random random(5, 0);
  std::vector<glm::vec3> positions;
  for (int i = 0; i < 6; ++i) positions.emplace_back(7.f * random.uniform(), 9.f * random.uniform(), random.uniform());
  const StandIndex index(positions, 2.f, glm::vec2(7.1f, 9.3f), {3, 3});
  const Bounds reached = box(glm::vec3(-3.f), glm::vec3(3.f));
  const Direction axis = glm::normalize(glm::vec3(0.9f, 0.3f, 0.05f));
  std::map<Key, int> there, back;
  for (std::uint32_t i = 0; i < positions.size(); ++i)
    for (const auto& [key, times] : visited(index, positions[i], reached, axis)) {
      const auto [j, x, y, z] = key;
      if (!meets(reached, {x, y, z}, axis, 0.)) continue;
      there[Key{100 * i + j, x, y, z}] = 1;
      back[Key{100 * j + i, 0.f - x, 0.f - y, 0.f - z}] = 1;
    }
  EXPECT_GT(there.size(), 40u);
  EXPECT_EQ(there, back);
}

// Check that an index without trees visits none.
TEST(StandIndex, OfNothingIsEmpty) {
  const std::vector<glm::vec3> nowhere(3, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_TRUE(visited(StandIndex(), {}, box(glm::vec3(-1.f), glm::vec3(1.f)), {0.f, 0.f, 1.f}).empty());
  EXPECT_TRUE(
      visited(StandIndex(nowhere, 1.f, std::nullopt, {}), {}, box(glm::vec3(-1.f), glm::vec3(1.f)), {0.f, 0.f, 1.f})
          .empty());
}

}  // namespace
