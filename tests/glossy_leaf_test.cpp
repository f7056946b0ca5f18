// Check that the gloss of leaves takes no more light than there is, is the same both ways, is sampled as it says, and
// that the traces from the sun and from the eye agree with it in closed form and with one another.
#include "render/reference/detail/glossy_leaf.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "core/require.hpp"
#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/trace_run.hpp"
#include "scattering/leaf_gloss.hpp"
#include "tests/half_sphere.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::half_sphere;
using namespace sunfleck::shapes;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kRoughnesses[]{0.05f, 0.1f, 0.3f, 0.6f, 1.f};
// Error of the gloss's table of albedos, from its 64 intervals and its rule over slopes; measured: 4.7e-4.
constexpr double kTableError = 1e-3;

TraceLight lightOn(const LeafOptics& leaf) {
  return {.sun = sunlight(0.7f, 1.f), .leaf = leaf};
}

double zOf(const Estimate& a, const Estimate& b) {
  return (a.value - b.value) / std::hypot(a.standard_error, b.standard_error);
}

}  // namespace

// Check that the lobe is the same both ways, to rounding; that it is Cook and Torrance's with the paper's Beckmann
// term where nothing is masked; and that it stays below 1 where the paper's own formula, without masking, does not.
TEST(R20_GlossyLeaf, IsReciprocalAndBounded) {
  for (const float m : kRoughnesses) {
    const LeafGloss gloss(m);
    for (const double a : {0., 0.4, 1.2, 1.55})
      for (const double b : {0.1, 0.9, 1.5}) {
        const glm::vec3 eye = towards(a, 0.3), light = towards(b, 2.2);
        const double there = double{gloss.brdf(eye, light)}, back = double{gloss.brdf(light, eye)};
        EXPECT_NEAR(there, back, 1e-5 * there) << m << " " << a << " " << b;
        EXPECT_TRUE(std::isfinite(there));
      }
  }
  const LeafGloss gloss(0.1f);
  const glm::vec3 eye = towards(0.2, 0.), light = towards(0.3, 2.);
  const double alpha = std::acos(double{glm::normalize(eye + light).z}), m = 0.1;
  const double paper = std::exp(-std::pow(std::tan(alpha) / m, 2)) /
                       (std::cos(0.2) * std::cos(0.3) * std::pow(std::cos(alpha), 4) * 4. * kPi * m * m);
  EXPECT_NEAR(double{gloss.brdf(eye, light)}, paper, 1e-4 * paper);  // single precision at the exponent's tail

  const glm::vec3 grazing = towards(1.54, 0.);
  const auto unmasked = [&](const glm::vec3& to_light) {
    const double tangent = std::tan(std::acos(double{glm::normalize(grazing + to_light).z}));
    return std::exp(-std::pow(tangent / m, 2)) * std::pow(1. + tangent * tangent, 2) /
           (4. * kPi * m * m * double{grazing.z});
  };
  EXPECT_GT(integral(unmasked, mirrored(grazing), 300), 1.4);
}

// Check the albedo of the lobe: the integral of f mu' is the table's to its error and at most 1, as is the mean of the
// samples' weights; the table's mean is that over all angles.
TEST(R20_GlossyLeaf, ReflectsWhatItsTableSays) {
  for (const float m : kRoughnesses) {
    const LeafGloss gloss(m);
    for (const double cosine : {0.03, 0.1, 0.3, 0.6, 0.95}) {
      const glm::vec3 eye = towards(std::acos(cosine), 0.8);
      const double reflected =
          integral([&](const glm::vec3& to) { return double{gloss.brdf(eye, to) * to.z}; }, mirrored(eye), 250);
      EXPECT_NEAR(reflected, double{gloss.albedo(static_cast<float>(cosine))}, kTableError) << m << " " << cosine;
      EXPECT_LE(reflected, 1. + 1e-4) << m << " " << cosine;  // the sum's own error
    }
    double mean = 0.;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i)
      mean += double{gloss.albedo(std::sqrt((static_cast<float>(i) + 0.5f) / kSteps))} / kSteps;
    EXPECT_NEAR(mean, double{gloss.meanAlbedo()}, 1e-5);
  }
}

// Check the samples against their density: Pearson's chi-square over 16 x 16 patches of the hemisphere by cosine and
// azimuth, of 40,000 even draws each, and one for those that lead into the leaf; the 1e-6 quantile, and patches with
// fewer than 20 expected are put together. The density is the derivative of nothing else: it is integrated by itself.
TEST(R20_GlossyLeaf, SamplesFollowTheirDensity) {
  constexpr int kPatches = 16, kFine = 24;
  for (const float m : {0.1f, 0.3f, 1.f})
    for (const double zenith : {0.2, 1.0, 1.5}) {
      const LeafGloss gloss(m);
      const glm::vec3 eye = towards(zenith, 0.);
      std::vector<double> expected(kPatches * kPatches + 1, 0.), found(expected.size(), 0.);
      const auto patch = [&](const glm::vec3& to) {
        const int ring = std::min(static_cast<int>(to.z * kPatches), kPatches - 1);
        const double turn = std::atan2(double{to.y}, double{to.x}) / (2. * kPi) + 0.5;
        return static_cast<std::size_t>(ring * kPatches + std::min(static_cast<int>(turn * kPatches), kPatches - 1));
      };
      double above = 0.;
      for (int i = 0; i < kPatches * kFine; ++i)
        for (int j = 0; j < kPatches * kFine; ++j) {
          const double z = (i + 0.5) / (kPatches * kFine), azimuth = 2. * kPi * ((j + 0.5) / (kPatches * kFine) - 0.5);
          const glm::vec3 to = towards(std::acos(z), azimuth);
          const double share = double{gloss.density(eye, to)} * 2. * kPi / std::pow(kPatches * kFine, 2);
          expected[patch(to)] += share;
          above += share;
        }
      expected.back() = std::max(0., 1. - above);
      constexpr int kDraws = 40'000;
      detail::PathRandom random(detail::Stream::light, 7, static_cast<std::uint64_t>(1e3 * zenith));
      for (int i = 0; i < kDraws; ++i) {
        const float u = random.uniform();
        const LeafGloss::Sample sample = gloss.sample(eye, u, random.uniform());
        ++found[sample.weight > 0.f ? patch(sample.to_light) : expected.size() - 1];
      }
      double chi_square = 0., rest_found = 0., rest_expected = 0.;
      int cells = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const double count = kDraws * expected[i];
        if (count < 20.) {
          rest_found += found[i];
          rest_expected += count;
          continue;
        }
        chi_square += std::pow(found[i] - count, 2) / count;
        ++cells;
      }
      if (rest_expected >= 5.) {
        chi_square += std::pow(rest_found - rest_expected, 2) / rest_expected;
        ++cells;
      }
      // Wilson and Hilferty's normal form of chi-square.
      const double freedom = cells - 1, spread = 2. / (9. * freedom);
      const double z = (std::cbrt(chi_square / freedom) - (1. - spread)) / std::sqrt(spread);
      EXPECT_LT(z, 4.75) << m << " " << zenith << ": " << chi_square << " of " << freedom;
      EXPECT_GT(z, -4.75) << m << " " << zenith << ": " << chi_square << " of " << freedom;
    }
}

// Check the whole leaf: what it sends to both sides is what its parts say at every angle, never more than arrives; of a
// leaf of rho + tau = 1 all of it, to the table's error. It sends the same both ways, also through.
TEST(R20_GlossyLeaf, SendsNoMoreThanArrives) {
  const glm::vec3 normal(0.f, 0.f, 1.f);
  for (const float m : {0.05f, 0.3f, 1.f})
    for (const float gloss : {0.04f, 1.f}) {
      const LeafOptics optics{.reflectance = 0.4f, .transmittance = 0.6f, .gloss = gloss, .gloss_roughness = m};
      const detail::GlossyLeaf<1> leaf({lightOn(optics)}, 0);
      const LeafGloss lobe(m);
      const auto sent = [&](const glm::vec3& eye, const glm::vec3& light) {
        return double{leaf.sent(normal, -eye, light)[0]};
      };
      for (const double zenith : {0.1, 0.9, 1.54}) {
        const glm::vec3 eye = towards(zenith, 0.5);
        const auto reflected = [&](const glm::vec3& to) { return sent(eye, to); };
        const auto passed = [&](const glm::vec3& to) { return sent(eye, -to); };
        const double up = integral(reflected, mirrored(eye), 250), down = integral(passed, normal, 250);
        const double beneath = 1. - double{gloss} * double{lobe.albedo(eye.z)};
        // The sums have errors of their own, of 250 rings: below 1e-3.
        EXPECT_NEAR(up, double{gloss} * double{lobe.albedo(eye.z)} + 0.4 * beneath, double{gloss} * kTableError + 1e-3)
            << m << " " << gloss << " " << zenith;
        EXPECT_NEAR(down, 0.6 * beneath, 1e-3) << m << " " << gloss << " " << zenith;
        EXPECT_NEAR(up + down, 1., double{gloss} * kTableError + 2e-3) << m << " " << gloss << " " << zenith;
        const glm::vec3 light = towards(0.6, 2.), below = -towards(0.9, 1.);
        EXPECT_NEAR(sent(eye, light) / double{light.z}, sent(light, eye) / double{eye.z}, 1e-5 * sent(eye, light));
        // Seen from the other side the normal is turned over.
        const double through = double{leaf.sent(-normal, -below, eye)[0]};
        EXPECT_NEAR(sent(eye, below) / std::abs(double{below.z}), through / double{eye.z}, 1e-5 * through);
      }
    }
}

// Check that paths go where `sent` says: in two bands of unlike gloss, the mean weight of paths that go into a patch
// about the mirror's direction, into the rest of that side and to the other side is the integral there, within 4.9
// standard errors (36 figures); and so is the share of paths that are drawn there, by `density`, where none ends early.
TEST(R20_GlossyLeaf, PathsGoWhereItSends) {
  const LeafOptics red{.reflectance = 0.5f, .transmittance = 0.2f, .gloss = 0.3f, .gloss_roughness = 0.2f};
  const LeafOptics green{.reflectance = 0.1f, .transmittance = 0.6f, .gloss = 0.05f, .gloss_roughness = 0.2f};
  const detail::GlossyLeaf<2> leaf({lightOn(red), lightOn(green)}, 0);
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));
  const Axes axes = axesAlong(normal);
  const auto local = [&](const glm::vec3& v) {
    return glm::vec3(glm::dot(v, axes.right), glm::dot(v, axes.up), glm::dot(v, normal));
  };
  const auto world = [&](const glm::vec3& v) { return v.x * axes.right + v.y * axes.up + v.z * axes.along; };
  for (const double zenith : {0.3, 1.1, 1.5}) {
    const glm::vec3 eye = towards(zenith, 0.5), arriving = -world(eye), mirror = mirrored(eye);
    // Region 0: about the mirror, 1: the rest of its side, 2: the other side.
    const auto region = [&](const glm::vec3& to) { return to.z < 0.f ? 2 : glm::dot(to, mirror) > 0.95f ? 0 : 1; };
    detail::BandLanes<2> start;
    start.of_band = {8.f, 4.f};                       // so heavy that no path ends by chance
    std::array<std::array<double, 3>, 3> expected{};  // of each region: two bands, and the share drawn
    for (const float side : {1.f, -1.f}) {
      for (int figure = 0; figure < 3; ++figure)
        for (int where = 0; where < 3; ++where)
          expected[static_cast<std::size_t>(where)][static_cast<std::size_t>(figure)] += integral(
              [&](const glm::vec3& to) {
                const glm::vec3 direction = side * to;
                if (region(direction) != where) return 0.;
                if (figure == 2) return double{leaf.density(normal, arriving, start, world(direction))};
                return double{start[figure]} * double{leaf.sent(normal, arriving, world(direction))[figure]};
              },
              mirror, 300);
    }
    constexpr int kPaths = 60'000;
    std::array<std::array<double, 3>, 3> sum{}, squares{};
    detail::PathRandom random(detail::Stream::light, 3, static_cast<std::uint64_t>(1e3 * zenith));
    for (int i = 0; i < kPaths; ++i) {
      detail::BandLanes<2> weight = start;
      const detail::Onward onward = leaf.scatter(normal, arriving, weight, random);
      if (onward.fate == detail::Fate::absorbed) continue;
      const auto where = static_cast<std::size_t>(region(local(onward.direction)));
      EXPECT_EQ(onward.fate == detail::Fate::passed, where == 2);
      EXPECT_NEAR(double{glm::length(onward.direction)}, 1., 1e-6);
      const std::array<double, 3> figures{double{weight[0]}, double{weight[1]}, 1.};
      for (std::size_t f = 0; f < 3; ++f) {
        sum[where][f] += figures[f];
        squares[where][f] += figures[f] * figures[f];
      }
    }
    for (std::size_t where = 0; where < 3; ++where)
      for (std::size_t f = 0; f < 3; ++f) {
        const double mean = sum[where][f] / kPaths;
        const double error = std::sqrt((squares[where][f] / kPaths - mean * mean) / kPaths);
        // The table's error goes with the gloss, the rule's with all of it.
        const double known = expected[where][f], slack = 1e-3 * known + (f < 2 ? kTableError * 0.3 * 8. : 0.);
        EXPECT_NEAR(mean, known, 4.9 * error + slack) << zenith << " region " << where << " figure " << f;
      }
  }
}

// Check the traces on one leaf: seen from above and from below it has the radiance that its formula says, without
// noise; and light from the sun is reflected and passed in the shares of the formula.
TEST(R20_GlossyLeaf, LoneLeafHasItsRadiance) {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0, 0, 3}, {5, 0, 0}, {0, 5, 0}));
  finish(mesh, "leaf");
  const RayScene scene(mesh, Stand{}, true);
  const LeafOptics optics{.reflectance = 0.3f, .transmittance = 0.5f, .gloss = 0.2f, .gloss_roughness = 0.25f};
  const float zenith = 0.9f;
  const TraceLight light{.sun = sunlight(zenith, 1.f), .leaf = optics};
  const LeafGloss lobe(0.25f);
  const double in_sun = 1. - 0.2 * double{lobe.albedo(std::cos(zenith))},
               in_mean = 1. - 0.2 * double{lobe.meanAlbedo()};
  const glm::vec3 to_sun = -light.sun;
  for (const float view : {0.f, 0.5f, 1.2f}) {
    const Direction sight = sunlight(view, 1.f + std::numbers::pi_v<float>);  // from the other side: into the glint
    const double in_eye = 1. - 0.2 * double{lobe.albedo(std::cos(view))};
    const double diffuse = in_sun * in_eye / (kPi * in_mean) * std::cos(double{zenith});
    const double glossy = 0.2 * double{lobe.brdf(-sight, to_sun)} * std::cos(double{zenith});
    const auto seen = [&](const Direction& along) {
      const Axes axes = axesAlong(along);
      const PixelRays rays{.corner = glm::vec3(0.f, 0.f, 3.f) - 0.5f * (axes.right + axes.up),
                           .right_step = 0.25f * axes.right,
                           .down_step = 0.25f * axes.up,
                           .sight = along,
                           .width = 4,
                           .height = 4};
      return traceCamera(scene, light, rays, 0.f, {.paths = 256}).mean.value;
    };
    EXPECT_NEAR(seen(sight), 0.3 * diffuse + glossy, 1e-5 * (diffuse + glossy)) << view;
    const Direction from_below(sight.x, sight.y, -sight.z);
    EXPECT_NEAR(seen(from_below), 0.5 * diffuse, 1e-5 * diffuse) << view;
  }
  const ForwardResult forward = traceForward(scene, light, {.paths = 64'000});
  const double gloss = 0.2 * double{lobe.albedo(std::cos(zenith))};
  // Light that misses the leaf, on the sides of a box without height, is nil; of that reflected the table's error.
  EXPECT_NEAR(forward.reflected.value, gloss + 0.3 * in_sun, 5. * forward.reflected.standard_error + 0.2 * kTableError);
  EXPECT_NEAR(forward.arriving_ground.value, 0.5 * in_sun, 5. * forward.arriving_ground.standard_error + 1e-4);
}

// Check that glossy leaves of rho + tau = 1 over white ground lose no light, from the sun and from the eye: albedo 1
// within five standard errors and what the table's error takes or gives in some ten reflections.
TEST(R20_GlossyLeaf, WhiteStandsReflectAllLight) {
  const TreeMesh mesh = leafBox(60, 4);
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  const LeafOptics white{.reflectance = 0.3f, .transmittance = 0.7f, .gloss = 0.3f, .gloss_roughness = 0.2f};
  const TraceLight light{.sun = sunlight(1.f, 1.f), .leaf = white, .ground_albedo = 1.f};
  const double slack = 10. * 0.3 * kTableError;
  const ForwardResult forward = traceForward(scene, light, {.paths = 60'000});
  EXPECT_NEAR(forward.reflected.value, 1., 5. * forward.reflected.standard_error + slack);
  EXPECT_NEAR(forward.absorbed_leaves.value, 0., 5. * forward.absorbed_leaves.standard_error + slack);
  EXPECT_LT(forward.reflected.standard_error, 0.01);
  const BrfJob job(scene, {light}, {{0.3, 1.}}, 128);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = 2, .wanted = {0, job.unitsOf(60'000)}}, sums);
  const Estimate albedo = job.results(sums).front().albedo.whole;
  EXPECT_NEAR(albedo.value, 1., 5. * albedo.standard_error + slack);
  EXPECT_LT(albedo.standard_error, 0.02);
}

// Check the trace from the eye against that from the sun, in two bands of unlike leaves and gloss: the albedo of a
// stand within five of the errors of both, and that its gloss matters.
TEST(R20_GlossyLeaf, ForwardAndBackwardAgree) {
  const TreeMesh mesh = leafBox(60, 12);
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  std::vector<TraceLight> bands{
      {.sun = sunlight(1.1f, 1.f),
       .leaf = {.reflectance = 0.45f, .transmittance = 0.4f, .gloss = 0.1f, .gloss_roughness = 0.3f},
       .ground_albedo = 0.4f},
      {.sun = sunlight(1.1f, 1.f),
       .leaf = {.reflectance = 0.05f, .transmittance = 0.02f, .gloss = 0.3f, .gloss_roughness = 0.3f},
       .ground_albedo = 0.1f}};
  const BrfJob job(scene, bands, {{0., 0.}}, 256);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = 3, .wanted = {0, job.unitsOf(60'000)}}, sums);
  const std::vector<BrfResult> backward = job.results(sums);
  const std::vector<ForwardResult> forward = traceForwardBands(scene, bands, {.paths = 60'000, .seed = 4});
  for (std::size_t band = 0; band < bands.size(); ++band) {
    EXPECT_LE(std::abs(zOf(backward[band].albedo.whole, forward[band].reflected)), 5.) << band;
    EXPECT_LT(backward[band].albedo.whole.standard_error, 0.02 * backward[band].albedo.whole.value) << band;
  }
  const std::string with = ForwardJob(scene, bands, 64).identity().at("optics");
  for (TraceLight& light : bands) light.leaf.gloss = 0.f;
  EXPECT_NE(ForwardJob(scene, bands, 64).identity().at("optics"), with);
  const ForwardResult dull = traceForwardBands(scene, bands, {.paths = 60'000, .seed = 4}).back();
  EXPECT_GT(zOf(forward.back().reflected, dull.reflected), 20.);
  bands.back().leaf.gloss_roughness = 0.2f;
  EXPECT_THROW(ForwardJob(scene, bands, 64), InvalidInput);
}
