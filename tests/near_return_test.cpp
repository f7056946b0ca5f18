#include "field/near_return.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr ElementRule kWhole{.largest_extent = 100.f};

double nearReturnOf(const TreeMesh& mesh) {
  const FieldElements elements = fieldElements(mesh, kWhole);
  const LineExchange exchange = lineExchange(mesh, elements, {}, {.axes = 4096, .crossings = 8.f});
  return double{nearReturn(elements, exchange, std::vector<std::uint32_t>(elements.size(), 0), 1)[0]};
}

}  // namespace

// Check two upright squares with a common edge, where what a place sees of the other falls from one half to little,
// against pairs of rays drawn at random: of rays that meet the other square, how many more from one place do than from
// any two.
TEST(F7_NearReturn, OfSquaresWithACommonEdge) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0.5f, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}));
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 0.5f}, {0, 0, 0.5f}, {0, 0.5f, 0}));
  finish(mesh, "squares");
  Random random(7, 0);
  const auto meets = [&](double x, double y) {
    const double sine2 = double{random.uniform()}, azimuth = 2. * std::numbers::pi * double{random.uniform()};
    const double sine = std::sqrt(sine2), along = -sine * std::cos(azimuth);
    if (along <= 0.) return 0.;
    const double reach = x / along;
    const bool inside = std::abs(y + reach * sine * std::sin(azimuth)) <= 0.5 && reach * std::sqrt(1. - sine2) <= 1.;
    return inside ? 1. : 0.;
  };
  constexpr int kPlaces = 1'000'000;
  double one = 0., both = 0.;
  for (int i = 0; i < kPlaces; ++i) {
    const double x = double{random.uniform()}, y = double{random.uniform()} - 0.5;
    const double a = meets(x, y), b = meets(x, y);
    one += 0.5 * (a + b) / kPlaces;
    both += a * b / kPlaces;
  }
  EXPECT_NEAR(one, 0.2000, 0.002);  // their view factor (Howell, configuration C-14); 5 standard errors
  // Only inner sides see the other leaf: half of all pairs, and of all lines that meet.
  const double expected = (both - one * one) / one;
  EXPECT_GT(expected, 0.02);
  // Single lines per side are few in a mesh of two leaves, and a straight line over distance is not quite what the view
  // of a place falls by.
  EXPECT_NEAR(nearReturnOf(mesh), expected, 0.25 * expected + 0.01);
}

// Check that nothing returns more often than by chance where leaves are far apart, nor where each place sees the same.
TEST(F7_NearReturn, IsNoneWhereAllPlacesSeeAlike) {
  TreeMesh apart;
  for (const float x : {-20.f, 0.f, 20.f})
    addPolygon(apart, apart.leaf_triangles, rectangle({x, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}));
  finish(apart, "apart");
  EXPECT_NEAR(nearReturnOf(apart), 0., 0.01);
  // Two sheets so near to each other that a place sees nothing else.
  TreeMesh close;
  for (const float z : {0.f, 0.004f})
    addPolygon(close, close.leaf_triangles, rectangle({0, 0, z}, {0.5f, 0, 0}, {0, 0.5f, 0}));
  finish(close, "close");
  EXPECT_NEAR(nearReturnOf(close), 0., 0.02);
}
