// Check leaves that differ from place to place and from side to side: where rays meet their images, what they send in
// closed form, that paths of light and paths from the eye agree, that no light is made or lost, and that runs tell them
// apart. Monte Carlo means are held to 5 standard errors, a false alarm of 6e-7 for each of some 120.
#include "render/reference/detail/leaf_sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/light_picture.hpp"
#include "render/reference/trace_run.hpp"
#include "sky/sky_models.hpp"
#include "tests/half_sphere.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::half_sphere;
using namespace sunfleck::shapes;

namespace {

constexpr double kPi = std::numbers::pi;
// Error of the gloss's table of albedos: see glossy_leaf_test.cpp.
constexpr double kTableError = 1e-3;
constexpr double kRounding = 1e-5;  // of some ten products in single precision, relative

using Maps = std::shared_ptr<const LeafMaps>;

Maps shared(LeafMaps maps) {
  return std::make_shared<const LeafMaps>(std::move(maps));
}
LeafFace face(const glm::vec3& reflectance, const glm::vec3& gloss = glm::vec3(0.f), std::uint32_t roughness = 0) {
  return {.reflectance = reflectance, .gloss = gloss, .roughness = roughness};
}
// Of one place.
LeafMaps everywhere(const LeafFace& upper, const LeafFace& lower, const glm::vec3& transmittance,
                    std::vector<float> roughnesses = {0.3f}) {
  return {.places = {{.transmittance = transmittance, .faces = {upper, lower}}}, .roughnesses = std::move(roughnesses)};
}

// Both sides unlike, from place to place, with two roughnesses.
LeafMaps chequered(float gloss) {
  LeafMaps maps{.width = 3, .height = 2, .places = {}, .roughnesses = {0.25f, 0.6f}};
  Random random(11, 0);
  const auto drawn = [&](float most) { return most * glm::vec3(random.uniform(), random.uniform(), random.uniform()); };
  for (int i = 0; i < 6; ++i)
    maps.places.push_back(
        {drawn(0.45f), {face(drawn(0.5f), gloss * drawn(1.f), 0), face(drawn(0.5f), gloss * drawn(1.f), 1)}});
  return maps;
}

// Gives every leaf triangle a part of the images of its own, none like its neighbour's.
void addPatches(TreeMesh& mesh, std::uint64_t seed) {
  Random random(seed, 0);
  const auto drawn = [&] { return glm::vec2(2.f * random.uniform() - 0.5f, 2.f * random.uniform() - 0.5f); };
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    mesh.patch_of_triangle.push_back(static_cast<std::uint32_t>(i));
    mesh.patches.push_back({.corners = {drawn(), drawn(), drawn()}});
  }
}

// A card that shows all of its images, upper side up where half_a x half_b points there.
void addCard(TreeMesh& mesh, const glm::vec3& centre, const glm::vec3& half_a, const glm::vec3& half_b,
             const glm::vec2& low = glm::vec2(0.f), const glm::vec2& high = glm::vec2(1.f)) {
  addPolygon(mesh, mesh.leaf_triangles, rectangle(centre, half_a, half_b));
  const glm::vec2 right(high.x, low.y), up(low.x, high.y);
  for (const ImageCorners& corners : {ImageCorners{low, right, high}, ImageCorners{low, high, up}}) {
    mesh.patch_of_triangle.push_back(static_cast<std::uint32_t>(mesh.patches.size()));
    mesh.patches.push_back({.corners = corners});
  }
}
TreeMesh card(bool upper_side_up) {
  TreeMesh mesh;
  addCard(mesh, {0, 0, 3}, {5, 0, 0}, {0, upper_side_up ? 5.f : -5.f, 0});
  finish(mesh, "card");
  return mesh;
}

// The bands of the maps, on leaves that are otherwise black.
std::vector<TraceLight> lightsOn(const Maps& maps, const Direction& sun, float ground_albedo = 0.f,
                                 int band_count = kBands) {
  std::vector<TraceLight> bands;
  for (int band = 0; band < band_count; ++band)
    bands.push_back({.sun = sun,
                     .ground_albedo = ground_albedo,
                     .of_kinds = {{.leaf = {0.f, 0.f}, .maps = maps, .map_band = band}}});
  return bands;
}

// A picture of 4 x 4 places about the middle of the card, along `sight`.
PixelRays pictureOfCard(const Direction& sight) {
  const Axes axes = axesAlong(sight);
  return {.corner = glm::vec3(0.f, 0.f, 3.f) - 0.5f * (axes.right + axes.up),
          .right_step = 0.25f * axes.right,
          .down_step = 0.25f * axes.up,
          .sight = sight,
          .width = 4,
          .height = 4};
}

TraceSums traced(const TraceJob& job, std::uint64_t units, std::uint64_t seed = 1) {
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = seed, .wanted = {0, units}}, sums);
  return sums;
}

void expectAlike(const Estimate& a, const Estimate& b, const std::string& what) {
  EXPECT_NEAR(a.value, b.value, 5. * std::hypot(a.standard_error, b.standard_error)) << what;
}

// Where the images are at a point of the mesh, by its triangles one after the other; none near their edges.
std::optional<glm::dvec2> shownAt(const TreeMesh& mesh, const glm::dvec3& at) {
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const glm::uvec3& t = mesh.leaf_triangles[i];
    const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (std::abs(glm::dot(glm::normalize(normal), at - a)) > 1e-5) continue;
    const double area = glm::length(normal);
    const double wb = glm::dot(glm::cross(at - a, c - a), normal) / (area * area),
                 wc = glm::dot(glm::cross(b - a, at - a), normal) / (area * area);
    if (std::min({wb, wc, 1. - wb - wc}) < 1e-3) continue;
    const ImageCorners& shown = patchOf(mesh, i)->corners;
    return (1. - wb - wc) * glm::dvec2(shown[0]) + wb * glm::dvec2(shown[1]) + wc * glm::dvec2(shown[2]);
  }
  return std::nullopt;
}

}  // namespace

// Check where rays meet the images of leaves, against the triangles taken one by one: of one tree and of rotated copies
// that repeat, of leaves that Embree has as pairs of triangles, some folded sharply, or as triangles, by single rays
// and by packets; and that a mask leaves them where they are. Places are as exact as positions: 1e-6 m in some 2 m,
// of leaves of 0.1 m that show up to 2 images.
TEST(LeafImages, AreMetWhereTheyLie) {
  Random random(4, 0);
  TreeMesh pairs, discs = leafBox(30, 8);
  for (int i = 0; i < 30; ++i) {
    const Axes axes = axesAlong(onSphere(random));
    const glm::vec3 centre(random.uniform(), random.uniform(), random.uniform());
    std::vector<glm::vec3> corners = rectangle(centre, 0.1f * axes.right, 0.07f * axes.up);
    if (i % 2 == 1) corners[3] += 0.2f * random.uniform() * axes.along + 0.1f * axes.right;  // folded about 0 - 2
    addPolygon(pairs, pairs.leaf_triangles, corners);
  }
  addPatches(pairs, 5);
  addPatches(discs, 6);
  TreeMesh masked = pairs;
  masked.masks.push_back(std::make_shared<const LeafMask>(LeafMask{.width = 2, .height = 1, .opaque = {1, 1}}));
  for (LeafPatch& patch : masked.patches) patch.mask = 0;
  for (TreeMesh* mesh : {&pairs, &discs, &masked}) {
    finish(*mesh, "leaves");
    for (const bool many : {false, true}) {
      Stand stand;
      if (many) {
        stand.period = glm::vec2(3.f, 2.5f);
        stand.trees = {{.position = {0.3f, 0.1f, 0.f}, .rotation = 1.f},
                       {.position = {1.8f, 1.f, 0.2f}, .rotation = 4.f}};
      }
      const RayScene scene(*mesh, stand, true);
      const RayScene::Geometry& geometry = scene.geometry();
      EXPECT_EQ(geometry.prototypes[0].leaf_quads, mesh != &masked);
      int found = 0;
      const auto check = [&](const detail::Hit& hit) {
        if (hit.surface != detail::Surface::leaf) return;
        const detail::Copy& copy = geometry.copies[hit.copy];
        const glm::dvec3 moved = glm::dvec3(hit.position) - glm::dvec3(many ? copy.translation : glm::vec3(0.f));
        const double c = double{copy.cosine}, s = double{copy.sine};
        const std::optional<glm::dvec2> expected =
            shownAt(*mesh, {c * moved.x + s * moved.y, c * moved.y - s * moved.x, moved.z});
        if (!expected) return;
        ++found;
        const std::optional<glm::vec2> shown = geometry.inImages(hit);
        ASSERT_TRUE(shown);
        EXPECT_LT(glm::length(glm::dvec2(*shown) - *expected), 2e-4);
      };
      for (int i = 0; i < 3000; ++i) {
        const glm::vec3 from = 0.5f * geometry.box.size() * onSphere(random) * 1.8f + geometry.box.centre();
        const glm::vec3 along = glm::normalize(
            geometry.box.low + geometry.box.size() * glm::vec3(random.uniform(), random.uniform(), random.uniform()) -
            from);
        const detail::Hit single = geometry.closest(from, along, detail::Coherence::incoherent);
        check(single);
        detail::Hit packed;
        const float reach = std::numeric_limits<float>::infinity();
        geometry.closest(std::span(&from, 1), std::span(&along, 1), std::span(&reach, 1), std::span(&packed, 1));
        check(packed);
      }
      EXPECT_GT(found, 150) << many;
    }
  }
}

// Check what one place sends under glosses that differ in intensity and roughness: at every angle what the parts say,
// never more than arrives; and the same both ways, also through.
TEST(R37_LeafSides, SendNoMoreThanArrives) {
  const LeafGloss smooth(0.15f), rough(0.7f);
  for (const float upper_gloss : {0.f, 0.3f, 1.f})
    for (const float lower_gloss : {0.05f, 0.9f}) {
      detail::LeafSides<1>::Side upper{.lobe = &smooth, .gloss = {{upper_gloss}}},
          lower{.lobe = &rough, .gloss = {{lower_gloss}}};
      const detail::LeafSides<1> from_above(upper, lower, {{{0.3f}}, {{0.7f}}}),
          from_below(lower, upper, {{{0.3f}}, {{0.7f}}});
      const double in_mean = 1. - double{upper_gloss} * double{smooth.meanAlbedo()},
                   other_in_mean = 1. - double{lower_gloss} * double{rough.meanAlbedo()};
      const glm::vec3 normal(0.f, 0.f, 1.f);
      for (const double zenith : {0.1, 0.9, 1.5}) {
        const glm::vec3 eye = towards(zenith, 0.5);
        const auto sent = [&](const glm::vec3& to) { return double{from_above.sent(normal, -eye, to)[0]}; };
        const double up = integral(sent, mirrored(eye), 250),
                     down = integral([&](const glm::vec3&to) { return sent(-to); }, normal, 250);
        const double glossy = double{upper_gloss} * double{smooth.albedo(eye.z)};
        // Errors of the sums, of 250 rings: below 1e-3.
        EXPECT_NEAR(up, glossy + 0.3 * (1. - glossy), double{upper_gloss} * kTableError + 1e-3);
        EXPECT_NEAR(down, 0.7 * (1. - glossy) * std::min(1., other_in_mean / in_mean), 1e-3 + kTableError);
        EXPECT_LE(up + down, 1. + kTableError + 1e-3);
        const glm::vec3 below = -towards(0.8, 2.);
        const double there = sent(below) / -double{below.z};
        const double back = double{from_below.sent(-normal, -below, eye)[0]} / double{eye.z};
        EXPECT_NEAR(there, back, kRounding * there);
      }
    }
}

// Check that paths go where `sent` says, also through to a side of another gloss: of three functions of the direction
// the mean over paths, by their weights, is the integral over what is sent; and without weights over the density.
TEST(R37_LeafSides, PathsGoWhereTheySend) {
  const LeafGloss smooth(0.2f), rough(0.6f);
  const detail::LeafSides<2>::Side upper{.lobe = &smooth, .gloss = {{0.3f, 0.05f}}},
      lower{.lobe = &rough, .gloss = {{0.8f, 0.5f}}};
  const glm::vec3 normal(0.f, 0.f, 1.f);
  for (const bool above : {true, false}) {
    const detail::LeafSides<2> leaf(above ? upper : lower, above ? lower : upper, {{{0.4f, 0.1f}}, {{0.3f, 0.6f}}});
    const glm::vec3 eye = towards(0.8, 0.5), mirror = mirrored(eye);
    detail::BandLanes<2> start;
    start.of_band = {8.f, 4.f};  // so heavy that no path ends by chance
    const std::array<std::function<double(const glm::vec3&)>, 3> functions{
        [](const glm::vec3& to) { return to.z > 0.f ? 1. : 0.; },
        [](const glm::vec3& to) { return double{to.z * to.z}; },
        [](const glm::vec3& to) { return to.z < 0.f ? double{-to.z} : double{to.x * to.x}; }};
    std::array<std::array<double, 3>, 3> expected{}, sum{}, squares{};  // of each function: two bands, and those drawn
    for (const float side : {1.f, -1.f})
      for (std::size_t f = 0; f < 3; ++f)
        for (std::size_t figure = 0; figure < 3; ++figure)
          expected[f][figure] += integral(
              [&](const glm::vec3& to) {
                const glm::vec3 direction = side * to;
                const int band = static_cast<int>(figure);
                const double share = figure == 2
                                         ? double{leaf.density(normal, -eye, start, direction)}
                                         : double{start[band]} * double{leaf.sent(normal, -eye, direction)[band]};
                return share * functions[f](direction);
              },
              mirror, 250);
    constexpr int kPaths = 60'000;
    detail::PathRandom random(detail::Stream::light, 3, above ? 1 : 2);
    for (int i = 0; i < kPaths; ++i) {
      detail::BandLanes<2> weight = start;
      const detail::Onward onward = leaf.scatter(normal, -eye, weight, random);
      if (onward.fate == detail::Fate::absorbed) continue;
      EXPECT_EQ(onward.fate == detail::Fate::passed, onward.direction.z < 0.f);
      for (std::size_t f = 0; f < 3; ++f) {
        const double value = functions[f](onward.direction);
        const std::array<double, 3> figures{value * double{weight[0]}, value * double{weight[1]}, value};
        for (std::size_t figure = 0; figure < 3; ++figure) {
          sum[f][figure] += figures[figure];
          squares[f][figure] += figures[figure] * figures[figure];
        }
      }
    }
    for (std::size_t f = 0; f < 3; ++f)
      for (std::size_t figure = 0; figure < 3; ++figure) {
        const double mean = sum[f][figure] / kPaths;
        const double error = std::sqrt((squares[f][figure] / kPaths - mean * mean) / kPaths);
        const double known = expected[f][figure];
        EXPECT_NEAR(mean, known, 5. * error + 1e-3 * known + (figure < 2 ? 8. * kTableError : 0.))
            << f << " " << figure;
      }
  }
}

// Check one leaf, lit from above and, turned over, from below: its radiance to both sides in closed form, without
// noise; the shares of the light that it sends up and down; and its irradiance on the side that is lit.
TEST(R37_LeafSides, LoneLeafHasItsRadiance) {
  const std::array<float, 2> roughness{0.25f, 0.7f};
  const std::array<glm::vec3, 2> gloss{glm::vec3(0.f, 0.2f, 0.4f), glm::vec3(0.f, 0.6f, 0.1f)};
  const std::array<glm::vec3, 2> rho{glm::vec3(0.3f, 0.1f, 0.5f), glm::vec3(0.6f, 0.4f, 0.2f)};
  const glm::vec3 tau(0.2f, 0.5f, 0.4f);
  const Maps maps =
      shared(everywhere(face(rho[0], gloss[0], 0), face(rho[1], gloss[1], 1), tau, {roughness[0], roughness[1]}));
  const std::array<LeafGloss, 2> lobes{LeafGloss(roughness[0]), LeafGloss(roughness[1])};
  const float zenith = 0.9f;
  const Direction sun = sunlight(zenith, 1.f);
  const double cosine = std::cos(double{zenith});
  for (const std::size_t lit : {0u, 1u}) {  // the side
    const TreeMesh mesh = card(lit == 0);
    const RayScene scene(mesh, Stand{}, true);
    const std::vector<TraceLight> bands = lightsOn(maps, sun);
    const std::size_t dark = 1 - lit;
    const auto in = [&](std::size_t side, int band, float mu) {
      return 1. - double{gloss[side][band]} * double{lobes[side].albedo(mu)};
    };
    const auto mean = [&](std::size_t side, int band) {
      return 1. - double{gloss[side][band]} * double{lobes[side].meanAlbedo()};
    };
    for (const float view : {0.f, 0.5f, 1.2f}) {
      const float mu = std::cos(view);
      const Direction sight = sunlight(view, 1.f + std::numbers::pi_v<float>);  // from the other side: into the glint
      const Direction from_below(sight.x, sight.y, -sight.z);
      const CameraJob above(scene, bands, pictureOfCard(sight), 0.f, 16),
          below(scene, bands, pictureOfCard(from_below), 0.f, 16);
      const std::vector<CameraResult> seen_above = above.results(traced(above, above.unitsOf(16))),
                                      seen_below = below.results(traced(below, below.unitsOf(16)));
      for (int band = 0; band < kBands; ++band) {
        const auto at = static_cast<std::size_t>(band);
        const double in_sun = in(lit, band, std::cos(zenith));
        const double expected = (double{gloss[lit][band]} * double{lobes[lit].brdf(-sight, -sun)} +
                                 double{rho[lit][band]} * in_sun * in(lit, band, mu) / (kPi * mean(lit, band))) *
                                cosine;
        EXPECT_NEAR(seen_above[at].mean.value, expected, kRounding * expected) << lit << " " << view << " " << band;
        const double through = double{tau[band]} * in_sun * in(dark, band, mu) * cosine /
                               (kPi * std::max(mean(lit, band), mean(dark, band)));
        EXPECT_NEAR(seen_below[at].mean.value, through, kRounding * through) << lit << " " << view << " " << band;
      }
    }
    const std::vector<ForwardResult> forward = traceForwardBands(scene, bands, {.paths = 64'000});
    for (int band = 0; band < kBands; ++band) {
      const ForwardResult& of = forward[static_cast<std::size_t>(band)];
      const double glossy = double{gloss[lit][band]} * double{lobes[lit].albedo(std::cos(zenith))};
      // Light that misses the leaf, on the sides of a box without height, is nil; of that reflected the table's error.
      EXPECT_NEAR(of.reflected.value, glossy + double{rho[lit][band]} * (1. - glossy),
                  5. * of.reflected.standard_error + kTableError);
      EXPECT_NEAR(of.arriving_ground.value,
                  double{tau[band]} * (1. - glossy) * std::min(1., mean(dark, band) / mean(lit, band)),
                  5. * of.arriving_ground.standard_error + kTableError);
      const Estimate &on_lit = lit == 0 ? of.leaf_front[0] : of.leaf_back[0],
                     &on_dark = lit == 0 ? of.leaf_back[0] : of.leaf_front[0];
      EXPECT_NEAR(on_lit.value, cosine, 5. * on_lit.standard_error + kRounding);
      EXPECT_EQ(on_dark.value, 0.);
      // All that arrives goes somewhere.
      EXPECT_NEAR(of.reflected.value + of.absorbed_leaves.value + of.arriving_ground.value, 1., 1e-9);
    }
  }
}

// Check a leaf whose halves differ against two leaves that lie side by side: the same picture by the same rays, but for
// pixels that the border between the halves crosses; and over bright ground the same light.
TEST(R37_LeafSides, HalvesAreTwoLeaves) {
  const std::array<LeafPlace, 2> halves{
      LeafPlace{.transmittance = {0.1f, 0.5f, 0.3f}, .faces = {face({0.5f, 0.1f, 0.2f}), face({0.2f, 0.3f, 0.6f})}},
      LeafPlace{.transmittance = {0.4f, 0.2f, 0.f}, .faces = {face({0.1f, 0.6f, 0.3f}), face({0.5f, 0.f, 0.9f})}}};
  const Maps both = shared({.width = 2, .height = 1, .places = {halves[0], halves[1]}});
  for (const bool up : {true, false}) {
    TreeMesh whole, left, right;
    const glm::vec3 half_b(0.f, up ? 0.5f : -0.5f, 0.f);
    addCard(whole, {0.f, 0.f, 1.f}, {0.5f, 0.f, 0.f}, half_b);
    addCard(left, {-0.25f, 0.f, 1.f}, {0.25f, 0.f, 0.f}, half_b);
    addCard(right, {0.25f, 0.f, 1.f}, {0.25f, 0.f, 0.f}, half_b);
    for (TreeMesh* mesh : {&whole, &left, &right}) finish(*mesh, "leaf");
    const Stand stand{.trees = {{.kind = 0}}, .period = glm::vec2(1.5f)},
        of_two{.trees = {{.kind = 0}, {.kind = 1}}, .period = glm::vec2(1.5f)};
    const RayScene one(whole, stand, true), two(std::array<const TreeMesh*, 2>{&left, &right}, of_two, true);
    const std::vector<TraceLight> bands = lightsOn(both, sunlight(0.6f, 1.f), 0.7f);
    std::vector<TraceLight> of_leaves = bands;
    const std::array<Maps, 2> of_kind{shared({.places = {halves[0]}}), shared({.places = {halves[1]}})};
    for (TraceLight& light : of_leaves) {
      light.of_kinds = {light.of_kinds[0], light.of_kinds[0]};
      for (std::size_t kind = 0; kind < 2; ++kind) light.of_kinds[kind].maps = of_kind[kind];
    }
    const std::vector<ForwardResult> a = traceForwardBands(one, bands, {.paths = 40'000}),
                                     b = traceForwardBands(two, of_leaves, {.paths = 40'000, .seed = 2});
    for (std::size_t band = 0; band < bands.size(); ++band) {
      expectAlike(a[band].reflected, b[band].reflected, "reflected");
      expectAlike(a[band].absorbed_leaves, b[band].absorbed_leaves, "absorbed");
      expectAlike({a[band].leaf_irradiance[0], a[band].leaf_standard_error[0]},
                  {0.5 * (b[band].leaf_irradiance[0] + b[band].leaf_irradiance[1]),
                   0.5 * std::hypot(b[band].leaf_standard_error[0], b[band].leaf_standard_error[1])},
                  "irradiance");
    }

    const RayScene alone(whole, Stand{}, true),
        beside(std::array<const TreeMesh*, 2>{&left, &right}, Stand{.trees = {{.kind = 0}, {.kind = 1}}}, true);
    for (TraceLight& light : of_leaves) light.ground_albedo = 0.f;
    const std::vector<TraceLight> black = lightsOn(both, sunlight(0.6f, 1.f));
    for (const float side : {1.f, -1.f}) {
      const PixelRays rays{.corner = {-0.6f, 0.6f, 0.f},
                           .right_step = {0.04f, 0.f, 0.f},
                           .down_step = {0.f, -0.04f, 0.f},
                           .sight = {0.f, 0.f, -side},
                           .width = 30,
                           .height = 30};
      const CameraJob of_one(alone, black, rays, 0.f, 4), of_both(beside, of_leaves, rays, 0.f, 4);
      const std::vector<CameraResult> c = of_one.results(traced(of_one, of_one.unitsOf(4))),
                                      d = of_both.results(traced(of_both, of_both.unitsOf(4)));
      for (std::size_t band = 0; band < bands.size(); ++band) {
        EXPECT_GT(c[band].mean.value, 0.01);
        for (std::size_t i = 0; i < 900; ++i) {
          if (i % 30 == 14 || i % 30 == 15) continue;
          EXPECT_NEAR(c[band].radiance.values[2 * i], d[band].radiance.values[2 * i], 1e-6f) << i;
        }
      }
    }
  }
}

// Check that maps of one place, alike on both sides, are the leaf that they say, to the bit: of light, of pictures and
// under a sky; and that triangles whose place is not known show the leaf beside maps of many places.
TEST(R37_LeafSides, EqualSidesAreTheLeafWithoutMaps) {
  TreeMesh mesh = leafBox(60, 4);
  addPatches(mesh, 5);
  finish(mesh, "leaf box");
  const TreeMesh bare = leafBox(60, 4);
  const auto sky = std::make_shared<const SkyMap>(uniformSky(glm::dvec3(0.5)));
  for (const float gloss : {0.f, 0.25f}) {
    const LeafOptics leaf{.reflectance = 0.35f, .transmittance = 0.5f, .gloss = gloss, .gloss_roughness = 0.2f};
    const LeafFace alike = face(glm::vec3(0.35f), glm::vec3(gloss));
    const Maps maps = shared(everywhere(alike, alike, glm::vec3(0.5f), {0.2f}));
    const TraceLight plain{.sun = sunlight(1.f, 1.f), .ground_albedo = 0.5f, .of_kinds = {{.leaf = leaf}}, .sky = sky};
    TraceLight mapped = plain, unknown = plain;
    mapped.of_kinds = {{.leaf = {0.1f, 0.1f}, .maps = maps}};
    unknown.of_kinds[0].maps = shared(chequered(0.5f));
    const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true),
        unmapped(bare, {.period = glm::vec2(2.f, 1.f)}, true);
    const ForwardResult expected = traceForward(scene, plain, {.paths = 20'000});
    for (const ForwardResult& found :
         {traceForward(scene, mapped, {.paths = 20'000}), traceForward(unmapped, unknown, {.paths = 20'000})}) {
      EXPECT_EQ(found.reflected.value, expected.reflected.value) << gloss;
      EXPECT_EQ(found.absorbed_leaves.value, expected.absorbed_leaves.value) << gloss;
      EXPECT_EQ(found.leaf_irradiance, expected.leaf_irradiance) << gloss;
    }
    const Axes axes = axesAlong(glm::normalize(glm::vec3(0.3f, 0.2f, -0.9f)));
    const PixelRays rays{.corner = -axes.right - axes.up,
                         .right_step = 0.1f * axes.right,
                         .down_step = 0.1f * axes.up,
                         .sight = axes.along,
                         .width = 20,
                         .height = 20};
    const CameraResult seen = traceCamera(scene, plain, rays, -1.f, {.paths = 1600});
    EXPECT_EQ(traceCamera(scene, mapped, rays, -1.f, {.paths = 1600}).radiance.values, seen.radiance.values);
    EXPECT_EQ(traceCamera(unmapped, unknown, rays, -1.f, {.paths = 1600}).radiance.values, seen.radiance.values);
  }
}

// Check paths of light against paths from the eye on a crown of glossy leaves that differ from place to place and from
// side to side: the albedo of a stand in some haze under a sun and a sky in three bands, pictures of a lone one; that
// what each wastes would be seen (turned over, the leaves send other light); and that no light is made or lost.
TEST(R37_LeafSides, ForwardAndBackwardAgree) {
  TreeMesh mesh = leafBox(60, 12), turned = mesh;
  for (glm::uvec3& t : turned.leaf_triangles) std::swap(t.y, t.z);
  addPatches(mesh, 3);
  addPatches(turned, 3);
  for (LeafPatch& patch : turned.patches) std::swap(patch.corners[1], patch.corners[2]);
  finish(mesh, "leaf box");
  finish(turned, "leaf box");
  const TraceMedium haze{.scatterer = TraceMedium::Scatterer::particles,
                         .asymmetry = 0.5f,
                         .box = {.low = glm::vec3(-0.4f), .high = glm::vec3(0.4f)},
                         .density = 0.5f};
  const RayScene scene(std::array<const TreeMesh*, 1>{&mesh}, {.period = glm::vec2(2.f, 1.f)}, true, {haze});
  const Maps maps = shared(chequered(0.4f));
  const auto sky = std::make_shared<const SkyMap>(overcastSky({0.2, 0.3, 0.5}));
  std::vector<TraceLight> bands = lightsOn(maps, sunlight(1.1f, 1.f), 0.4f);
  for (std::size_t band = 0; band < bands.size(); ++band) {
    bands[band].sky = sky;
    bands[band].sky_band = static_cast<int>(band);
    bands[band].of_media = {{.reflectance = 0.4f, .transmittance = 0.4f}};
  }
  const BrfJob job(scene, bands, {{0., 0.}}, 256);
  const std::vector<BrfResult> backward = job.results(traced(job, job.unitsOf(60'000), 3));
  const std::vector<ForwardResult> forward = traceForwardBands(scene, bands, {.paths = 60'000, .seed = 4});
  for (std::size_t band = 0; band < bands.size(); ++band) {
    expectAlike(backward[band].albedo.whole, forward[band].reflected, "albedo");
    EXPECT_LT(backward[band].albedo.whole.standard_error, 0.02 * backward[band].albedo.whole.value) << band;
    EXPECT_NEAR(forward[band].reflected.value + forward[band].absorbed_leaves.value +
                    forward[band].absorbed_particles->value + forward[band].absorbed_ground.value,
                1., 5. * forward[band].reflected.standard_error);
  }

  const Direction sun = sunlight(1.1f, 1.f);
  const std::vector<TraceLight> black = lightsOn(maps, sun);
  const RayScene lone(mesh, Stand{}, true), lone_turned(turned, Stand{}, true);
  const Axes axes = axesAlong(glm::normalize(glm::vec3(-0.5f, 0.3f, -0.6f)));
  const PixelRays rays{.corner = -1.4f * (axes.right + axes.up),
                       .right_step = 2.8f / 16.f * axes.right,
                       .down_step = 2.8f / 16.f * axes.up,
                       .sight = axes.along,
                       .width = 16,
                       .height = 16};
  const CameraJob eye(lone, black, rays, -2.f, 16), once(lone, black, rays, -2.f, 16, Followed::once),
      over(lone_turned, black, rays, -2.f, 16);
  const LightPictureJob more(lone, black, rays, 1024);
  const std::vector<CameraResult> by_eye = eye.results(traced(eye, eye.unitsOf(256))),
                                  by_light = together(once.results(traced(once, once.unitsOf(256), 2)),
                                                      more.results(traced(more, 128, 3))),
                                  other = over.results(traced(over, over.unitsOf(256)));
  for (std::size_t band = 0; band < black.size(); ++band) {
    expectAlike(by_eye[band].mean, by_light[band].mean, "picture");
    EXPECT_LT(by_light[band].mean.standard_error, 0.02 * by_light[band].mean.value);
    EXPECT_GT(std::abs(by_eye[band].mean.value - other[band].mean.value),
              5. * std::hypot(by_eye[band].mean.standard_error, other[band].mean.standard_error));
  }
  const std::vector<ForwardResult> of_lone = traceForwardBands(lone, black, {.paths = 20'000});
  double kept = 0., arrived = 0.;
  for (const ForwardResult& of : of_lone) {
    kept += of.reflected.value + of.absorbed_leaves.value + of.arriving_ground.value;
    arrived += 1.;
  }
  // A path's three bands together: each carries its own weight, whose sums are kept to rounding.
  EXPECT_NEAR(kept, arrived, 1e-6);
}

// Check leaves that absorb nothing over white ground under a sky that is as bright everywhere: all comes back where
// both sides have one gloss, to what the table's error takes or gives in some ten reflections; where they differ no
// more.
TEST(R37_LeafSides, WhiteStandsReflectNoMoreThanArrives) {
  TreeMesh mesh = leafBox(60, 4);
  addPatches(mesh, 7);
  finish(mesh, "leaf box");
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  const auto sky = std::make_shared<const SkyMap>(uniformSky(glm::dvec3(1.)));
  for (const bool equal : {true, false}) {
    const LeafFace upper = face(glm::vec3(0.3f), glm::vec3(0.3f, 0.1f, 1.f), 0);
    const LeafFace lower = equal ? upper : face(glm::vec3(0.3f), glm::vec3(0.8f, 0.f, 0.2f), 1);
    std::vector<TraceLight> bands =
        lightsOn(shared(everywhere(upper, lower, glm::vec3(0.7f), {0.2f, 0.7f})), sunlight(0.f, 0.f), 1.f);
    for (TraceLight& light : bands) {
      light.sun_irradiance = 0.f;
      light.sky = sky;
    }
    const BrfJob job(scene, bands, {{0.3, 1.}}, 128);
    const std::vector<BrfResult> backward = job.results(traced(job, job.unitsOf(40'000), 2));
    const std::vector<ForwardResult> forward = traceForwardBands(scene, bands, {.paths = 40'000});
    for (std::size_t band = 0; band < bands.size(); ++band) {
      const double slack = 10. * double{upper.gloss[static_cast<int>(band)]} * kTableError;
      for (const Estimate& share :
           {forward[band].reflected, backward[band].albedo.whole, backward[band].views[0].whole}) {
        EXPECT_LT(share.standard_error, 0.02);
        EXPECT_LE(share.value, 1. + 5. * share.standard_error + slack) << band;
        if (equal)
          EXPECT_NEAR(share.value, 1., 5. * share.standard_error + slack) << band;
        else
          EXPECT_GT(share.value, 0.5) << band;
      }
    }
  }
}

// Check that a run knows another run's maps, patches and bands from its own, and that maps that do not fit are refused.
TEST(LeafMapsOfRuns, AreToldApartAndChecked) {
  TreeMesh mesh = leafBox(5, 4);
  addPatches(mesh, 5);
  finish(mesh, "leaf box");
  const RayScene scene(mesh, Stand{}, true);
  const auto identityOf = [](const RayScene& of, const Maps& maps, int band) {
    std::vector<TraceLight> bands = lightsOn(maps, sunlight(1.f, 1.f), 0.f, 1);
    bands[0].of_kinds[0].map_band = band;
    return ForwardJob(of, bands, 64).identity();
  };
  const LeafMaps some = chequered(0.4f);
  const TraceIdentity first = identityOf(scene, shared(some), 0);
  EXPECT_EQ(identityOf(scene, shared(some), 0), first);
  EXPECT_NE(identityOf(scene, shared(some), 1), first);
  EXPECT_NE(identityOf(scene, nullptr, 0), first);
  LeafMaps other = some;
  other.places[3].faces[1].reflectance.y += 1e-6f;
  EXPECT_NE(identityOf(scene, shared(other), 0), first);
  other = some;
  other.roughnesses[1] = 0.7f;
  EXPECT_NE(identityOf(scene, shared(other), 0), first);
  TreeMesh moved = mesh;
  moved.patches[2].corners[0].x += 1e-3f;
  EXPECT_NE(identityOf(RayScene(moved, Stand{}, true), shared(some), 0), first);

  std::vector<TraceLight> bands = lightsOn(shared(some), sunlight(1.f, 1.f));
  bands[1].of_kinds[0].maps = shared(some);  // not the same, though alike
  EXPECT_THROW(ForwardJob(scene, bands, 64), InvalidInput);
  other = some;
  other.places[0].faces[0].reflectance.x = 0.9f;
  other.places[0].transmittance.x = 0.2f;
  EXPECT_THROW(ForwardJob(scene, lightsOn(shared(other), sunlight(1.f, 1.f)), 64), InvalidInput);
  bands = lightsOn(shared(some), sunlight(1.f, 1.f));
  bands[2].of_kinds[0].map_band = 3;
  EXPECT_THROW(ForwardJob(scene, bands, 64), InvalidInput);
}
