// Check that the lists of trees that may stand in the light of a place hold all that do, and few others.
#include "render/gl/light_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace {

using namespace sunfleck;

std::vector<std::uint32_t> listAt(const gl::LightGrid& grid, const glm::vec2& at) {
  const glm::ivec2 cell(glm::floor((at - grid.low) / grid.cell_size));
  if (cell.x < 0 || cell.y < 0 || cell.x >= grid.size.x || cell.y >= grid.size.y) return {};
  const auto number = static_cast<std::size_t>(cell.y * grid.size.x + cell.x);
  return {grid.casters.begin() + grid.first[number], grid.casters.begin() + grid.first[number + 1]};
}

bool holds(const gl::LightBox& box, const glm::vec2& at) {
  return at.x > box.low.x && at.y > box.low.y && at.x < box.high.x && at.y < box.high.y;
}

// (R4) Check random rectangles against asking each of them, at random places, and that lists are not much longer than
// what they must hold: cells are a quarter of a rectangle, so that they meet at most 1.25^2 + ... times as many.
TEST(R4_LightGrid, ListsWhatMayStandInTheLight) {
  Random random(4, 0);
  std::vector<gl::LightBox> boxes;
  for (int i = 0; i < 500; ++i) {
    const glm::vec2 low(100.f * random.uniform(), 60.f * random.uniform());
    boxes.push_back({low, low + 3.f + 2.f * glm::vec2(random.uniform(), random.uniform())});
  }
  const gl::LightGrid grid = gl::lightGrid(boxes, {glm::vec2(0.f), glm::vec2(104.f, 64.f)});
  std::size_t needed = 0, listed = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec2 at(104.f * random.uniform(), 64.f * random.uniform());
    const std::vector<std::uint32_t> list = listAt(grid, at);
    listed += list.size();
    for (std::uint32_t box = 0; box < boxes.size(); ++box)
      if (holds(boxes[box], at)) {
        ++needed;
        EXPECT_TRUE(std::ranges::binary_search(list, box));
      }
  }
  EXPECT_GT(needed, 2000u);
  // A cell a quarter as wide as a rectangle meets (1 + 1/4)^2 = 1.6 times as many; sides differ by a fifth.
  EXPECT_LT(static_cast<double>(listed), 1.8 * static_cast<double>(needed));
}

// (R4) Check that what lies beside the lit places is in no list, and that there may be nothing at all.
TEST(R4_LightGrid, LeavesOutWhatLightsNothing) {
  const std::vector<gl::LightBox> far{{glm::vec2(10.f), glm::vec2(11.f)}};
  EXPECT_TRUE(gl::lightGrid(far, {glm::vec2(0.f), glm::vec2(1.f)}).casters.empty());
  EXPECT_TRUE(gl::lightGrid({}, {glm::vec2(0.f), glm::vec2(1.f)}).casters.empty());
}

}  // namespace
