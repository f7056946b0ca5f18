#include "grid/cell_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "leaf_shapes.hpp"
#include "plants/random_leaves.hpp"

namespace {

using namespace sunfleck;

// Check the grid of a box of leaves worked out by hand: cubic cells, centred, as many as are asked for along the
// longest side, no more than needed along the others.
TEST(CellGrid, CoversTheLeaves) {
  TreeMesh mesh;
  shapes::addPolygon(mesh, mesh.leaf_triangles, {{0.f, 0.f, 0.f}, {4.f, 0.f, 0.f}, {4.f, 2.5f, 1.f}});
  finish(mesh, "leaf");
  const CellGrid cells = cellGrid(mesh, 4);
  EXPECT_EQ(cells.size, glm::ivec3(4, 3, 1));
  EXPECT_EQ(cells.cell_size, 1.f);
  EXPECT_EQ(cells.low, glm::vec3(0.f, -0.25f, 0.f));
  EXPECT_EQ(cells.count(), 12u);
  EXPECT_EQ(cells.active.size(), 12u);  // the triangle's box touches all
  for (int resolution : {1, 2, 3, 16, 37}) EXPECT_EQ(cellGrid(mesh, resolution).size.x, resolution);
}

// Check that places and numbers of cells agree.
TEST(CellGrid, NumbersItsCells) {
  const CellGrid cells = cellGrid(randomCrown({.leaves = 50}, 1), 7);
  for (std::size_t number = 0; number < cells.count(); ++number) {
    EXPECT_EQ(cells.number(cells.cell(number)), number);
    const glm::vec3 at = (cells.centre(number) - cells.low) / cells.cell_size;
    EXPECT_EQ(glm::ivec3(at), cells.cell(number));
  }
}

// Check that the active cells are those that hold a leaf's box, and those next to them, numbered in order: for few
// leaves, by another way: a cell is active exactly if its box, made a cell larger on all sides, meets a leaf's box.
TEST(CellGrid, IsActiveAboutLeaves) {
  const TreeMesh mesh = randomCrown({.leaf_side = 0.1f, .leaves = 30}, 2);
  const CellGrid cells = cellGrid(mesh, 12);
  EXPECT_LT(cells.active.size(), cells.count());
  EXPECT_TRUE(std::is_sorted(cells.active.begin(), cells.active.end()));
  for (std::uint32_t number = 0; number < cells.count(); ++number) {
    const glm::vec3 reach(1.5f * cells.cell_size), centre = cells.centre(number);
    bool wanted = false, surely = false;  // within and beyond the rounding of a cell's face
    for (const glm::uvec3& t : mesh.leaf_triangles) {
      Bounds leaf;
      for (int corner = 0; corner < 3; ++corner) leaf.include(mesh.vertices[t[corner]]);
      const auto meets = [&](float slack) {
        const glm::vec3 low = centre - reach - slack, high = centre + reach + slack;
        for (int axis = 0; axis < 3; ++axis)
          if (leaf.low[axis] > high[axis] || leaf.high[axis] < low[axis]) return false;
        return true;
      };
      wanted |= meets(1e-5f);
      surely |= meets(-1e-5f);
    }
    const bool active = cells.slot[number] != CellGrid::kInactive;
    EXPECT_TRUE(active ? wanted : !surely) << number;
    if (active) {
      EXPECT_EQ(cells.active[cells.slot[number]], number);
    }
  }
}

// Check interpolation: exact for a linear function between cell centres, and clamped outside. Error: float rounding.
TEST(CellGrid, InterpolatesLinearly) {
  TreeMesh mesh;
  shapes::addPolygon(mesh, mesh.leaf_triangles, {{0.f, 0.f, 0.f}, {1.f, 0.f, 0.2f}, {1.f, 1.f, 1.f}});
  finish(mesh, "leaf");
  const CellGrid cells = cellGrid(mesh, 5);
  std::vector<float> values;
  for (std::size_t cell = 0; cell < cells.count(); ++cell) {
    const glm::vec3 centre = cells.centre(cell);
    values.push_back(1.f + 2.f * centre.x - centre.y + 3.f * centre.z);
  }
  EXPECT_NEAR(interpolate(cells, values, {0.41f, 0.37f, 0.77f}), 1.f + 0.82f - 0.37f + 2.31f, 1e-5f);
  EXPECT_NEAR(interpolate(cells, values, {-9.f, -9.f, -9.f}), interpolate(cells, values, {0.1f, 0.1f, 0.1f}), 1e-5f);
}

// Check that values of active cells go to their places, and that the others are 0.
TEST(CellGrid, SpreadsValuesOfActiveCells) {
  const CellGrid cells = cellGrid(randomCrown({.leaf_side = 0.1f, .leaves = 30}, 2), 12);
  std::vector<float> of_active(cells.active.size());
  std::iota(of_active.begin(), of_active.end(), 1.f);
  const std::vector<float> all = spread<float>(cells, of_active);
  ASSERT_EQ(all.size(), cells.count());
  for (std::size_t number = 0; number < all.size(); ++number)
    EXPECT_EQ(all[number],
              cells.slot[number] == CellGrid::kInactive ? 0.f : static_cast<float>(cells.slot[number] + 1));
}

}  // namespace
