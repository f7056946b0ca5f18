#include "field/sun_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "core/random.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr ElementRule kWhole{.least_flatness = 0.f, .largest_extent = 1e9f};
constexpr int kFiner = 64;  // parts of a picture's pixel along its row

// Squares turned every way, so close that many pass through each other.
TreeMesh tangle() {
  Random random(5, 0);
  TreeMesh mesh;
  for (int leaf = 0; leaf < 300; ++leaf) {
    const Axes axes = axesAlong(onSphere(random));
    const glm::vec3 centre(random.uniform(), random.uniform(), random.uniform());
    addPolygon(mesh, mesh.leaf_triangles, rectangle(centre, 0.08f * axes.right, 0.08f * axes.up));
  }
  addPolygon(mesh, mesh.wood_triangles, rectangle({0.5f, 0.5f, 0.6f}, {0.6f, 0, 0.1f}, {0, 0.03f, 0}));
  finish(mesh, "tangle");
  return mesh;
}

// How many parts of pixels each side is the first on, found part by part.
std::vector<double> countedParts(const detail::LineGrid& grid, std::size_t sides) {
  std::vector<detail::Crossing64> nearest(grid.lines(), std::numeric_limits<detail::Crossing64>::max());
  std::vector<detail::Span> work;
  grid.cross(0, grid.triangles(), work,
             [&](std::size_t part, detail::Crossing64 crossing) { nearest[part] = std::min(nearest[part], crossing); });
  std::vector<double> parts(sides);
  for (const detail::Crossing64 crossing : nearest)
    if (crossing != std::numeric_limits<detail::Crossing64>::max()) parts[detail::sideMet(crossing)] += 1.;
  return parts;
}

}  // namespace

// Check what rows show of leaves that pass through each other, with a period that they reach beyond and without,
// against the same parts of pixels looked at one by one. Where two leaves meet a place may be rounded to the next part:
// some hundred meet in each row or so of 100,000 parts.
TEST(F3_SunPicture, ShowsWhatIsFirst) {
  const TreeMesh mesh = tangle();
  const FieldElements elements = fieldElements(mesh, kWhole);
  constexpr float kPixels = 40.f;
  const double area = std::accumulate(elements.area.begin(), elements.area.begin() + 300, 0.) / 300. / double{kPixels};
  for (const bool periodic : {false, true})
    for (const float zenith : {0.f, 0.6f, 1.3f}) {
      const std::optional<glm::vec2> period = periodic ? std::optional(glm::vec2(0.9f, 0.7f)) : std::nullopt;
      const Direction along = sunlight(zenith, 0.4f);
      const SunPicture picture(mesh, elements, period, along, {.pixels = kPixels});
      const detail::LineGrid grid({&mesh, &elements, period}, along, area, {0.5, 0.5}, kFiner);
      const std::vector<double> expected = countedParts(grid, 2 * elements.size());
      double all = picture.free() / grid.lineArea(), different = 0.;
      for (std::size_t side = 0; side < expected.size(); ++side) {
        const double found = picture.shown()[side] / grid.lineArea();
        all += found;
        different += std::abs(found - expected[side]);
      }
      EXPECT_NEAR(all, static_cast<double>(grid.lines()), 1e-9 * all);
      EXPECT_LE(different, 2e-4 * all) << zenith << (periodic ? " periodic" : "");
    }
}

// Check two squares that cross each other along a line of their own, each of which shows the half that is nearer to the
// sun. Rows are h = 1/32 apart. Along them it is exact; an edge that moves by up to cot(0.3) = 3.2 along rows with each
// across is taken for straight from row to row, which cuts off up to 3.2 h^2 / 8 = 4e-4 at each of four corners.
TEST(F3_SunPicture, DividesLeavesThatCross) {
  for (const float turn : {0.3f, 1.9f}) {
    const glm::vec3 a(std::cos(turn), std::sin(turn), 0.f), b(-a.y, a.x, 0.f), up(0.f, 0.f, 1.f);
    TreeMesh mesh;
    for (const float tilt : {1.f, -1.f})
      addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 1}, 0.5f * glm::normalize(a + tilt * up), 0.5f * b));
    finish(mesh, "crossing");
    const FieldElements elements = fieldElements(mesh, kWhole);
    const SunPicture picture(mesh, elements, {}, {0.f, 0.f, -1.f}, {.pixels = 1024.f});
    for (std::size_t element = 0; element < 2; ++element)
      EXPECT_NEAR(picture.shown()[2 * element] + picture.shown()[2 * element + 1], std::sqrt(0.125), 0.0016);
  }
}
