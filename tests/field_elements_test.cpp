#include <gtest/gtest.h>

#include <numeric>

#include "field/elements.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

// Check that flat small leaves stay whole, that bent and large ones come apart into triangles, and that wood is
// gathered by place and facing; and that no area is lost.
TEST(F1_FieldElements, CutsWhatIsBentOrLarge) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 0}, {.05f, 0, 0}, {0, .05f, 0}));  // flat, small
  // Bent by a right angle along an edge.
  mesh.vertices.insert(mesh.vertices.end(), {{1, 0, 0}, {1.1f, 0, 0}, {1, .1f, 0}, {1, 0, .1f}});
  mesh.leaf_triangles.push_back({4, 5, 6});
  mesh.leaf_triangles.push_back({4, 7, 5});
  addPolygon(mesh, mesh.leaf_triangles, rectangle({5, 5, 9}, {5, 0, 0}, {0, 5, 0}));             // flat, large
  addPolygon(mesh, mesh.wood_triangles, rectangle({3, 3, 3}, {.01f, 0, 0}, {0, .01f, 0}));       // upward
  addPolygon(mesh, mesh.wood_triangles, rectangle({3, 3, 2.95f}, {.01f, 0, 0}, {0, -.01f, 0}));  // downward
  finish(mesh, "leaves");
  const FieldElements elements = fieldElements(mesh);
  EXPECT_EQ(elements.leaf_elements, 1u + 2u + 2u);
  EXPECT_EQ(elements.size(), elements.leaf_elements + 2u);
  EXPECT_EQ(elements.of_leaf_triangle[0], elements.of_leaf_triangle[1]);
  EXPECT_EQ(elements.leaf[elements.of_leaf_triangle[3]], 1u);
  EXPECT_EQ(elements.leaf.back(), FieldElements::kWood);
  EXPECT_FLOAT_EQ(elements.normal[0].z, 1.f);
  // Areas in single precision: roundings of a few sums.
  const float total = std::accumulate(elements.area.begin(), elements.area.end(), 0.f);
  EXPECT_NEAR(total, .01f + .01f + 100.f + .0008f, 1e-4f);
  const std::vector<float> of_leaves = leafMeans(elements, mesh.leaf_count, elements.area);
  EXPECT_NEAR(of_leaves[1], .005f, 1e-7f);
}
