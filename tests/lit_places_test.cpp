#include "field/lit_places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "field/leaf_field.hpp"
#include "render/reference/forward_trace.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

const Direction kDown(0.f, 0.f, -1.f);
constexpr ElementRule kWhole{.largest_extent = 100.f};

// A leaf of 2 x 2 m, the half of it at x < 0 under another 0.5 m above; and two upright ones beside it, by its lit and
// by its dark edge.
TreeMesh halfShaded() {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  addPolygon(mesh, mesh.leaf_triangles, rectangle({-0.5f, 0, 0.5f}, {0.5f, 0, 0}, {0, 1, 0}));
  for (const float x : {1.05f, -1.05f})
    addPolygon(mesh, mesh.leaf_triangles, rectangle({x, 0, 0.25f}, {0, 0.5f, 0}, {0, 0, 0.15f}));
  finish(mesh, "half shaded");
  return mesh;
}

}  // namespace

// Check that places of a leaf are lit where no other leaf is above, that they are told on the front, once for
// both ends of lines there, and that their light is all that arrives.
TEST(F6_LitPlaces, LieWhereNoShadowFalls) {
  const TreeMesh mesh = halfShaded();
  const FieldElements elements = fieldElements(mesh, kWhole);
  const LineExchange exchange = lineExchange(mesh, elements, {}, {.axes = 32, .crossings = 400.f});
  const SunPicture picture(mesh, elements, {}, kDown, {.pixels = 10'000.f});
  const DirectLight direct = directLight(picture, elements, false);
  const LitPlaces lit = litPlaces(picture, direct, exchange);
  const auto half_shaded = static_cast<std::uint32_t>(std::ranges::find(elements.leaf, 0u) - elements.leaf.begin());
  constexpr float kPixel = 0.03f;  // larger than that of the picture, and than a place's rounding
  std::size_t bright = 0, dark = 0;
  double carried = 0.;
  std::vector<int> ends(exchange.crossed_at.size());  // of lines at each crossing
  const auto look = [&](std::uint32_t side, std::uint32_t crossing) {
    EXPECT_GE(crossing, exchange.first_crossing[side / 2]);
    EXPECT_LT(crossing, exchange.first_crossing[side / 2 + 1]);
    ++ends[crossing];
    if (side / 2 != half_shaded) return;
    const LitPlaces::Lit is = lit.at[crossing];
    if (is != LitPlaces::kDark) carried += double{lit.irradiance[2 * half_shaded]};
    const glm::vec3 place = exchange.places.place(exchange.crossed_at[crossing]);
    const float x = place.x, y = place.y;
    if (std::abs(x) < kPixel || std::abs(x) > 1.f - kPixel || std::abs(y) > 1.f - kPixel) return;
    EXPECT_EQ(is, x < 0.f ? LitPlaces::kDark : LitPlaces::kFront) << x;
    ++(x > 0.f ? bright : dark);
  };
  for (std::size_t i = 0; i < exchange.sees.size(); ++i) look(exchange.sees[i], exchange.seen_at[i]);
  for (std::uint32_t side = 0; side < exchange.sides(); ++side)
    for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i)
      look(side, exchange.open_at[i]);
  for (const int count : ends) EXPECT_EQ(count, 2);  // on either side of the element
  EXPECT_GT(bright, 5000u);
  EXPECT_GT(dark, 5000u);
  // Each line has two ends here; sums of thousands of floats.
  const double all = 2. * exchange.lines[half_shaded] * double{direct.irradiance[2 * half_shaded]};
  EXPECT_NEAR(carried, all, 1e-4 * all);
  EXPECT_NEAR(direct.irradiance[2 * half_shaded], 0.5, 0.01);  // half of it, to a row of pixels
  EXPECT_NEAR(lit.irradiance[2 * half_shaded], 1., 0.02);      // the sun's where it shines, as evenly as lines fall
}

// Check the light of leaves beside the lit and the dark part of another, single elements all of them, against Monte
// Carlo: were the light scattered from all of the leaf alike, both would have the same.
TEST(F6_LitPlaces, AgreesWithMonteCarlo) {
  const auto mesh = std::make_shared<const TreeMesh>(halfShaded());
  const LeafOptics optics{.reflectance = 0.2f, .transmittance = 0.1f};
  const ForwardResult truth =
      traceForward(RayScene(*mesh, {}, true), {.sun = kDown, .leaf = optics}, {.paths = 1'000'000});
  LeafField field({.elements = kWhole, .exchange = {.axes = 256, .crossings = 100.f}, .direct = {.pixels = 10'000.f}});
  field.setStand(std::array{mesh}, {});
  FieldLighting lighting{.suns = {{.along = kDown}}, .sky = {}, .kinds = {FieldKind{}}};
  lighting.kinds[0].leaf.fill(optics);
  const FieldResult& result = field.solve(lighting);
  const auto light = [&](std::size_t leaf) {
    const SideIrradiance& scattered = result.trees[0][leaf].scattered[0];
    return double{scattered.front} + double{scattered.back};
  };
  for (const std::size_t leaf : {2u, 3u})
    // Beside 4.5 standard errors, what second scattering from evenly lit leaves may miss: a few per cent of the light.
    EXPECT_NEAR(light(leaf), truth.leaf_irradiance[leaf],
                4.5 * truth.leaf_standard_error[leaf] + 0.05 * truth.leaf_irradiance[leaf])
        << leaf;
  EXPECT_GT(light(2), 1.5 * light(3));
}
