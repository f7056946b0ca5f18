// Check that a ground by the model of Rahman, Pinty and Verstraete and one by a texture reflect what they say, as seen
// by the eye and as lit by the sun.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "core/ground_texture.hpp"
#include "core/require.hpp"
#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/trace_run.hpp"
#include "scattering/rpv_ground.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr RpvGround kSoil{.rho0 = 0.12f, .k = 0.75f, .theta = -0.15f, .rho_c = 0.2f};

glm::vec3 towards(double zenith, double azimuth) {
  return glm::vec3(
      glm::dvec3(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)));
}

double zOf(const Estimate& a, const Estimate& b) {
  return (a.value - b.value) / std::hypot(a.standard_error, b.standard_error);
}

// A leaf so small, 1e-4 m in a period of 1 m, that the ground is as good as bare: 1e-8 of the light meets it.
TreeMesh speck() {
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, rectangle({0.2f, 0.3f, 0.f}, {5e-5f, 0, 0}, {0, 5e-5f, 0}));
  finish(mesh, "speck");
  return mesh;
}

std::vector<BrfResult> brf(const RayScene& scene, const std::vector<TraceLight>& bands,
                           const std::vector<ViewDirection>& views, std::uint64_t paths) {
  const BrfJob job(scene, bands, views, 128);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = 5, .wanted = {0, job.unitsOf(paths)}}, sums);
  return job.results(sums);
}

}  // namespace

// Check the limits: k = 1, theta = 0 and rho_c = 1 is Lambert's ground of rho0 everywhere, to rounding; that the model
// is the same both ways; and that it is the published formula, written with angles.
TEST(R21_RpvGround, IsThePublishedFormula) {
  for (const double a : {0., 0.5, 1.3})
    for (const double b : {0.2, 0.9, 1.4})
      for (const double azimuth : {0., 1., 3.1}) {
        const glm::vec3 eye = towards(a, 0.4), light = towards(b, 0.4 + azimuth);
        EXPECT_NEAR(double{rpvReflectance({.rho0 = 0.3f}, eye, light)}, 0.3, 1e-6);
        const double k = double{kSoil.k}, theta = double{kSoil.theta};
        const double phase = std::cos(a) * std::cos(b) + std::sin(a) * std::sin(b) * std::cos(azimuth);
        const double bowl = std::pow(std::cos(a) * std::cos(b), k - 1.) / std::pow(std::cos(a) + std::cos(b), 1. - k);
        const double lobe = (1. - theta * theta) / std::pow(1. + theta * theta + 2. * theta * phase, 1.5);
        const double apart = std::sqrt(std::pow(std::tan(a), 2) + std::pow(std::tan(b), 2) -
                                       2. * std::tan(a) * std::tan(b) * std::cos(azimuth));
        const double expected = double{kSoil.rho0} * bowl * lobe * (1. + (1. - double{kSoil.rho_c}) / (1. + apart));
        const double found = double{rpvReflectance(kSoil, eye, light)};
        EXPECT_NEAR(found, expected, 2e-5 * expected) << a << " " << b << " " << azimuth;  // of tan in single precision
        EXPECT_NEAR(double{rpvReflectance(kSoil, light, eye)}, found, 1e-6 * found);
      }
}

// Check that a ground that would reflect more than all light at some angle is refused, and so are parameters out of
// range; soils are taken, and white Lambertian ground, whose albedo is 1 to rounding.
TEST(R21_RpvGround, ReflectsNoMoreThanArrives) {
  EXPECT_NO_THROW(validate(kSoil));
  EXPECT_NO_THROW(validate(RpvGround{.rho0 = 1.f}));
  EXPECT_NEAR(largestRpvAlbedo({.rho0 = 0.4f}), 0.4, 1e-6);
  // Grazing light on a deep bowl: rho0 0.3 alone would not tell.
  EXPECT_THROW(validate(RpvGround{.rho0 = 0.3f, .k = 0.4f}), InvalidInput);
  EXPECT_THROW(validate(RpvGround{.rho0 = 0.6f, .theta = -0.8f}), InvalidInput);
  const float nan = std::nanf("");
  for (const RpvGround& wrong : {RpvGround{.rho0 = -0.1f}, RpvGround{.k = 0.1f}, RpvGround{.theta = 1.f},
                                 RpvGround{.rho_c = 2.1f}, RpvGround{.rho0 = nan}, RpvGround{.theta = nan}})
    EXPECT_THROW(validate(wrong), InvalidInput);
  for (const double zenith : {0., 1., 1.5, 1.5707})  // no weight is without bound
    EXPECT_LT(double{rpvReflectance(kSoil, towards(zenith, 0.), towards(zenith, 3.))}, 2.);
}

// Check bare ground: reflectance factors are the model's, without noise, and the light that comes back under a low sun
// is the integral of it, whose rule is good to 1e-3.
TEST(R21_RpvGround, BareGroundHasItsReflectance) {
  const TreeMesh mesh = speck();
  const RayScene scene(mesh, {.period = glm::vec2(1.f)}, true);
  const float zenith = 1.1f;
  const TraceLight light{.sun = sunlight(zenith, 0.5f), .leaf = {0.f, 0.f}, .ground_rpv = kSoil};
  const std::vector<ViewDirection> views{{0., 0.}, {0.6, 0.5}, {1.1, 0.5}, {1.2, 3.}};
  const BrfResult seen = brf(scene, {light}, views, 1024).front();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double expected = double{rpvReflectance(kSoil, towards(views[i].zenith, views[i].azimuth), -light.sun)};
    EXPECT_NEAR(seen.views[i].whole.value, expected, 1e-5 * expected) << i;
  }
  const ForwardResult lit = traceForward(scene, light, {.paths = 100'000});
  const double albedo = rpvAlbedo(kSoil, std::cos(double{zenith}));
  EXPECT_NEAR(lit.reflected.value, albedo, 5. * lit.reflected.standard_error + 1e-3 * albedo);
  EXPECT_NEAR(lit.reflected.value + lit.absorbed_ground.value, 1., 1e-6);
}

// Check the trace from the eye against that from the sun, in two bands with leaves above: albedos within five of the
// errors of both; and that each such ground is another run to a checkpoint.
TEST(R21_RpvGround, ForwardAndBackwardAgree) {
  const TreeMesh mesh = leafBox(40, 12);
  const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
  const std::vector<TraceLight> bands{
      {.sun = sunlight(0.9f, 1.f), .leaf = {0.45f, 0.5f}, .ground_rpv = RpvGround{0.4f, 0.8f, -0.1f, 0.5f}},
      {.sun = sunlight(0.9f, 1.f), .leaf = {0.05f, 0.02f}, .ground_rpv = kSoil}};
  const std::vector<BrfResult> backward = brf(scene, bands, {{0., 0.}}, 60'000);
  const std::vector<ForwardResult> forward = traceForwardBands(scene, bands, {.paths = 60'000, .seed = 4});
  for (std::size_t band = 0; band < bands.size(); ++band) {
    EXPECT_LE(std::abs(zOf(backward[band].albedo.whole, forward[band].reflected)), 5.) << band;
    EXPECT_LT(backward[band].albedo.whole.standard_error, 0.02 * backward[band].albedo.whole.value) << band;
  }
  const std::string one = ForwardJob(scene, bands, 64).identity().at("optics");
  std::vector<TraceLight> other = bands;
  other[1].ground_rpv->theta = -0.1f;
  EXPECT_NE(ForwardJob(scene, other, 64).identity().at("optics"), one);
  other[1].ground_rpv.reset();
  EXPECT_THROW(ForwardJob(scene, other, 64), InvalidInput);
}

// Check a texture: values at the centres of its pixels, the lower left one at x = y = 0, again one period further; its
// mean; that it is refused where it is wrong.
TEST(GroundTexture, RepeatsItsPixels) {
  const GroundTexture texture{.width = 2, .height = 2, .size = 4.f, .albedo = {0.1f, 0.2f, 0.3f, 0.8f}};
  EXPECT_FLOAT_EQ(texture.at(1., 1.), 0.3f);
  EXPECT_FLOAT_EQ(texture.at(3., 1.), 0.8f);
  EXPECT_FLOAT_EQ(texture.at(1., 3.), 0.1f);
  EXPECT_FLOAT_EQ(texture.at(-1. + 4e5, 3. - 8.), 0.2f);
  EXPECT_FLOAT_EQ(texture.at(2., 2.), 0.35f);
  double sum = 0.;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) sum += double{texture.at((i + 0.5) / 16., (j + 0.5) / 16.)};
  EXPECT_NEAR(sum / 4096., 0.35, 1e-6);
  for (const GroundTexture& wrong :
       {GroundTexture{}, GroundTexture{.width = 1, .height = 1, .size = 1.f, .albedo = {1.5f}},
        GroundTexture{.width = 1, .height = 1, .size = 0.f, .albedo = {0.5f}},
        GroundTexture{.width = 2, .height = 1, .size = 1.f, .albedo = {0.5f}}})
    EXPECT_THROW(validate(wrong), InvalidInput);
}

// Check a textured ground: the light that comes back is its mean albedo, from the sun and to the eye, within five
// standard errors, and each place has its own radiance in a picture, without noise.
TEST(GroundTexture, LooksAndReflectsAsItSays) {
  const TreeMesh mesh = speck();
  const RayScene scene(mesh, {.period = glm::vec2(1.f)}, true);
  const auto texture = std::make_shared<const GroundTexture>(
      GroundTexture{.width = 2, .height = 2, .size = 0.5f, .albedo = {0.1f, 0.2f, 0.3f, 0.8f}});
  const TraceLight light{.sun = sunlight(0.6f, 0.5f), .leaf = {0.f, 0.f}, .ground_texture = texture};
  const ForwardResult lit = traceForward(scene, light, {.paths = 50'000});
  EXPECT_NEAR(lit.reflected.value, 0.35, 5. * lit.reflected.standard_error);
  const BrfResult seen = brf(scene, {light}, {{0.7, 2.}}, 50'000).front();
  EXPECT_NEAR(seen.views[0].whole.value, 0.35, 5. * seen.views[0].whole.standard_error);
  EXPECT_NEAR(seen.albedo.whole.value, 0.35, 5. * seen.albedo.whole.standard_error);

  // One picture of 50 x 50 pixels of a square metre without period, elsewhere in the world.
  TreeMesh far = mesh;
  for (glm::vec3& v : far.vertices) v += glm::vec3(100.f, 50.f, 1.f);
  const RayScene open(far, Stand{}, true);
  const PixelRays rays{.corner = {120.f, 81.f, 5.f},
                       .right_step = {0.02f, 0.f, 0.f},
                       .down_step = {0.f, -0.02f, 0.f},
                       .sight = {0.f, 0.f, -1.f},
                       .width = 50,
                       .height = 50};
  const CameraResult picture = traceCamera(open, light, rays, 0.f, {.paths = 2500 * 16});
  double worst = 0.;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 50; ++x) {
      const double expected =
          double{texture->at(120. + 0.02 * (x + 0.5), 81. - 0.02 * (y + 0.5))} * std::cos(0.6) / kPi;
      const double found = double{picture.radiance.values[picture.radiance.at(x, y, 0)]};
      worst = std::max(worst, std::abs(found - expected));
    }
  // Between centres of its pixels the albedo rises or falls by at most 0.5 in 0.25 m. Where that turns within a pixel
  // of the picture, of 0.02 m, the mean is off the middle's by up to a quarter of that, 0.01 along each axis.
  EXPECT_LT(worst, 0.02 * std::cos(0.6) / kPi);
  std::vector<TraceLight> others(2, light);
  others[1].ground_texture.reset();
  EXPECT_THROW(ForwardJob(scene, others, 64), InvalidInput);
  GroundTexture changed = *texture;
  changed.albedo[3] = 0.7f;
  others[1].ground_texture = std::make_shared<const GroundTexture>(changed);
  EXPECT_NE(ForwardJob(scene, {others[0]}, 64).identity().at("optics"),
            ForwardJob(scene, {others[1]}, 64).identity().at("optics"));
}
