// Check light in media, traced from the sun and from the eye, against discrete ordinates, which share no code with it,
// against published values, against each other and against what holds exactly. Some 150 z-tests at fixed seeds: |z| <=
// 5 in each makes a false alarm less likely than 1e-4 in all.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "core/require.hpp"
#include "pp_solver/solver.hpp"
#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/slab_trace.hpp"
#include "render/reference/trace_run.hpp"
#include "tests/leaf_shapes.hpp"
#include "tests/medium_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;
namespace fs = std::filesystem;
using Scatterer = TraceMedium::Scatterer;

namespace {

constexpr double kPi = std::numbers::pi;
const fs::path kShared = fs::path(SUNFLECK_SOURCE_DIR) / "../shared";

// Within five standard errors, and `known`, of what is right but to rounding of single precision.
testing::AssertionResult agrees(const Estimate& found, double expected, double noise = 0., double known = 2e-6) {
  const double allowed = 5. * std::hypot(found.standard_error, noise) + known;
  if (std::abs(found.value - expected) <= allowed) return testing::AssertionSuccess();
  return testing::AssertionFailure() << found.value << " against " << expected << ", allowed " << allowed;
}
testing::AssertionResult agree(const Estimate& a, const Estimate& b) {
  return agrees(a, b.value, b.standard_error);
}

std::vector<BrfResult> traceBrf(const RayScene& scene, const std::vector<TraceLight>& bands,
                                const std::vector<ViewDirection>& views, std::uint64_t paths) {
  const BrfJob job(scene, bands, views, 256);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = 1, .wanted = {0, job.unitsOf(paths)}}, sums);
  return job.results(sums);
}

TraceLight lightOn(std::vector<LeafOptics> media, double zenith, float ground = 0.f) {
  return {.sun = sunlight(static_cast<float>(zenith), 0.7f), .ground_albedo = ground, .of_media = std::move(media)};
}

const std::vector<ViewDirection> kViews{{0., 0.}, {0.5, 0.7}, {0.9, 2.7}, {1.2, 4.1}};

// One layer of a medium over Lambertian ground by discrete ordinates.
struct SolvedLayer {
  SolvedLayer(const Medium& medium, double thickness, double zenith, double ground)
      : solver({.streams = 64}), mu0(std::cos(zenith)), depth(thickness), albedo(ground) {
    solver.solve({.layers = {{.thickness = thickness, .medium = medium}},
                  .beam = pp::Beam{.mu0 = mu0, .azimuth = 0.7 + kPi},
                  .ground = {.albedo = ground}});
  }
  double arriving() const {
    const pp::Fluxes below = solver.fluxes(depth);
    return (below.down + below.direct) / mu0;
  }
  double brf(const ViewDirection& view) {
    return kPi * solver.radiance(0., -std::cos(view.zenith), view.azimuth) / mu0;
  }

  mutable pp::Solver solver;
  double mu0, depth, albedo;
};

void expectAgree(const ForwardResult& found, const SolvedLayer& solved, const Estimate& absorbed,
                 const std::string& what) {
  EXPECT_TRUE(agrees(found.reflected, solved.solver.reflectance())) << what;
  EXPECT_TRUE(agrees(absorbed, solved.solver.absorptance())) << what;
  EXPECT_TRUE(agrees(found.arriving_ground, solved.arriving())) << what;
  EXPECT_TRUE(agrees(found.arriving_ground_direct, solved.solver.direct())) << what;
  EXPECT_TRUE(agrees(found.absorbed_ground, (1. - solved.albedo) * solved.arriving())) << what;
}

// A crown of leaves as voxels, 1 m across, that are turned in their own way in each cell; about 2 m2 of them.
TraceMedium crown() {
  Random filling(21, 0), turning(22, 0);
  MediumVoxels cells = voxels({-0.5f, -0.5f, 0.2f}, 0.1f, glm::ivec3(10), [&](const glm::ivec3& cell) {
    const float from_middle = glm::length(glm::vec3(cell) - 4.5f);
    return from_middle < 5.f && filling.uniform() < 0.7f ? 12.f * filling.uniform() : 0.f;
  });
  for (std::size_t i = 0; i < cells.density.size(); ++i) cells.leaves.push_back(randomArea(turning));
  return {.voxels = std::move(cells)};
}

}  // namespace

// Check slabs of particles over ground, by fluxes and by reflectance factors, for peaked, backward and isotropic
// scattering.
TEST(R16_MediumTrace, SlabsOfParticlesAgreeWithDiscreteOrdinates) {
  for (const auto& [g, albedo, thickness, zenith, ground] :
       {std::tuple{0., 0.9, 1., 0.3, 0.}, {0.7, 0.99, 3., 1., 0.3}, {-0.5, 0.6, 0.4, 0.6, 0.9}}) {
    TraceMedium medium = layer(Scatterer::particles, static_cast<float>(thickness));
    medium.asymmetry = static_cast<float>(g);
    const RayScene scene({medium}, glm::vec2(0.7f, 1.3f));
    const TraceLight light = lightOn({{static_cast<float>(albedo), 0.f}}, zenith, static_cast<float>(ground));
    SolvedLayer solved(Particles{albedo, PhaseFunction::henyeyGreenstein(g)}, thickness, zenith, ground);
    const ForwardResult found = traceForward(scene, light, {.paths = 60'000});
    ASSERT_TRUE(found.absorbed_particles);
    expectAgree(found, solved, *found.absorbed_particles, "g " + std::to_string(g));
    EXPECT_EQ(found.absorbed_leaves.value, 0.);
    const BrfResult brf = traceBrf(scene, {light}, kViews, 20'000).front();
    for (std::size_t i = 0; i < kViews.size(); ++i)
      EXPECT_TRUE(agrees(brf.views[i].whole, solved.brf(kViews[i]))) << g << " view " << i;
    EXPECT_TRUE(agree(brf.albedo.whole, found.reflected));
  }
}

// Check that the same slab is told alike by the tool for slabs.
TEST(R16_MediumTrace, SceneIsTheSlabOfTheSlabTrace) {
  TraceMedium medium = layer(Scatterer::particles, 2.f);
  medium.asymmetry = 0.6f;
  const ForwardResult scene =
      traceForward(RayScene({medium}, glm::vec2(1.f)), lightOn({{0.9f, 0.f}}, kPi / 3.), {.paths = 60'000});
  const SlabTraceResult slab =
      traceSlab({.asymmetry = 0.6, .albedo = 0.9, .thickness = 2., .mu0 = 0.5}, {}, {.paths = 60'000, .seed = 2});
  EXPECT_TRUE(agree(scene.reflected, slab.reflectance));
  EXPECT_TRUE(agree(scene.arriving_ground, slab.transmittance));
  EXPECT_TRUE(agree(*scene.absorbed_particles, slab.absorptance));
}

// Check slabs of leaves of every class of inclinations, brighter above than below, over ground: fluxes and reflectance
// factors. The 64 inclinations that stand for all are right to 1e-4.
TEST(R15_MediumTrace, SlabsOfLeavesAgreeWithDiscreteOrdinates) {
  for (const char* name : {"spherical", "planophile", "erectophile", "plagiophile", "extremophile", "uniform"}) {
    const LeafAngles angles = LeafAngles::named(name);
    TraceMedium medium = layer(Scatterer::leaves, 2.f);
    if (name != std::string("spherical")) medium.rings = ringsOf(angles);
    const RayScene scene({medium}, glm::vec2(1.f));
    const LeafOptics leaf{.reflectance = 0.5f, .transmittance = 0.3f};
    const double zenith = 0.8, ground = 0.2;
    SolvedLayer solved(LeafScattering{.angles = angles, .reflectance = 0.5, .transmittance = 0.3}, 2., zenith, ground);
    const TraceLight light = lightOn({leaf}, zenith, 0.2f);
    const ForwardResult found = traceForward(scene, light, {.paths = 40'000});
    expectAgree(found, solved, found.absorbed_leaves, name);
    EXPECT_FALSE(found.absorbed_particles);
    const BrfResult brf = traceBrf(scene, {light}, kViews, 15'000).front();
    for (std::size_t i = 0; i < kViews.size(); ++i)
      EXPECT_TRUE(agrees(brf.views[i].whole, solved.brf(kViews[i]), 0., 1e-4)) << name << " view " << i;
    EXPECT_NEAR(brf.views[0].leaf_once.value + brf.views[0].ground_once.value + brf.views[0].more.value,
                brf.views[0].whole.value, 1e-9);
  }
}

// Check that other leaves follow from the orders of scattering by leaves of a medium, against a run with these leaves.
TEST(R15_MediumTrace, OrdersTellOfOtherLeaves) {
  const RayScene scene({layer(Scatterer::leaves, 3.f)}, glm::vec2(1.f));
  const LeafOptics bright{.reflectance = 0.5f, .transmittance = 0.4f}, dark{.reflectance = 0.3f, .transmittance = 0.3f};
  const ForwardResult traced = traceForward(scene, lightOn({bright}, 0.5), {.paths = 50'000});
  const ForwardResult other = traceForward(scene, lightOn({dark}, 0.5), {.paths = 50'000, .seed = 2});
  EXPECT_TRUE(agree(traced.reflected_by_order.reweighted(bright, dark), other.reflected));
  EXPECT_TRUE(agree(traced.arriving_ground_by_order.reweighted(bright, dark), other.arriving_ground));
}

// Check against slabs on which independent programs agree, where their values are at hand.
TEST(R16_MediumTrace, MeetsPublishedSlabs) {
  std::ifstream file(kShared / "reference/slab_reference.csv");
  if (!file) GTEST_SKIP() << "no slab_reference.csv";
  struct Slab {
    double g, albedo, thickness, mu0;
    auto operator<=>(const Slab&) const = default;
  };
  std::map<Slab, std::map<std::string, double>> slabs;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    std::vector<std::string> fields;
    std::stringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    if (fields[2] == "inf") continue;
    slabs[{std::stod(fields[0]), std::stod(fields[1]), std::stod(fields[2]), std::stod(fields[3])}][fields[4]] =
        std::stod(fields[5]);
  }
  ASSERT_GT(slabs.size(), 100u);
  int number = 0, compared = 0;
  for (const auto& [slab, known] : slabs) {
    if (++number % 6 != 0 || !known.contains("R") || !known.contains("T") || slab.thickness > 30.) continue;
    TraceMedium medium = layer(Scatterer::particles, static_cast<float>(slab.thickness));
    medium.asymmetry = static_cast<float>(slab.g);
    const RayScene scene({medium}, glm::vec2(1.f));
    const TraceLight light = lightOn({{static_cast<float>(slab.albedo), 0.f}}, std::acos(slab.mu0));
    const ForwardResult found = traceForward(scene, light, {.paths = 6'400});
    // The albedo of single precision is off by 3e-8, some hundreds of scatterings make that 1e-5 of the light.
    // Shares that some hundred paths alone would tell are not spread as a z-test has it.
    for (const auto& [share, value] :
         {std::pair{found.reflected, known.at("R")}, {found.arriving_ground, known.at("T")}}) {
      if (value < 0.02) continue;
      EXPECT_TRUE(agrees(share, value, 0., 1e-5)) << number;
      ++compared;
    }
  }
  EXPECT_GT(compared, 15);
}

// Check the energy budget of a turbid canopy of leaf area index 3 over soil, where another program's is at hand.
TEST(R15_MediumTrace, MeetsThePublishedTurbidCanopy) {
  std::ifstream file(kShared / "reference/canopy_flux.csv");
  if (!file) GTEST_SKIP() << "no canopy_flux.csv";
  const RayScene scene({layer(Scatterer::leaves, 3.f)}, glm::vec2(25.f));
  std::map<std::string, ForwardResult> found;  // by the leaves' optics
  int compared = 0;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    std::vector<std::string> fields;
    std::stringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    if (fields[0] != "turbid") continue;
    const auto number = [&](std::size_t field) { return std::stof(fields[field]); };
    if (!found.contains(fields[2])) {
      const TraceLight light = lightOn({{number(2), number(3)}}, double{number(5)} * kPi / 180., number(4));
      found[fields[2]] = traceForward(scene, light, {.paths = 100'000});
    }
    const ForwardResult& result = found[fields[2]];
    const Estimate estimate = fields[6] == "reflected"            ? result.reflected
                              : fields[6] == "absorbed_by_leaves" ? result.absorbed_leaves
                              : fields[6] == "arriving_at_soil"   ? result.arriving_ground
                                                                  : result.arriving_ground_direct;
    EXPECT_TRUE(agree(estimate, {std::stod(fields[7]), std::stod(fields[8])})) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 8);
}

// Check that no light is made or lost in crowns that absorb nothing and in those that do, alone or in a stand, with
// wood and ground, and particles among the leaves.
TEST(R14_MediumTrace, ConservesEnergy) {
  TraceMedium fog{.scatterer = Scatterer::particles,
                  .asymmetry = 0.8f,
                  .box = {.low = {-0.5f, -0.4f, 0.f}, .high = {0.5f, 0.4f, 0.7f}},
                  .density = 2.f};
  TreeMesh mesh;
  addPolygon(mesh, mesh.leaf_triangles, disc({0.f, 0.f, 0.9f}, {0.f, 0.f, 1.f}, 0.2));
  addPolygon(mesh, mesh.wood_triangles, rectangle({0.f, 0.f, 0.6f}, {0.05f, 0.f, 0.f}, {0.f, 0.f, 0.5f}));
  finish(mesh, "leaf and wood");
  for (const float albedo : {0.f, 0.6f, 1.f})
    for (const bool periodic : {false, true}) {
      const Stand stand{.period = periodic ? std::optional(glm::vec2(1.2f, 1.1f)) : std::nullopt};
      const RayScene scene(std::array<const TreeMesh*, 1>{&mesh}, stand, true, {crown(), fog});
      const LeafOptics leaf{.reflectance = 0.6f * albedo, .transmittance = 0.4f * albedo};
      TraceLight light = lightOn({leaf, {albedo, 0.f}}, 0.6, periodic ? albedo : 0.f);
      light.leaf = leaf;
      light.wood_reflectance = albedo;
      const ForwardResult r = traceForward(scene, light, {.paths = 12'800});
      EXPECT_NEAR(r.reflected.value + r.absorbed_leaves.value + r.absorbed_wood.value + r.absorbed_ground.value +
                      r.absorbed_particles->value,
                  1., 1e-12);
      EXPECT_GT(r.arriving_ground.value, 0.1);
      if (albedo == 1.f) {
        // Rounding of weights in single precision.
        EXPECT_NEAR(r.absorbed_leaves.value + r.absorbed_wood.value + r.absorbed_particles->value, 0., 1e-5);
        EXPECT_NEAR(r.reflected.value + (periodic ? 0. : r.arriving_ground.value), 1., 1e-5);
      } else {
        EXPECT_GT(r.absorbed_leaves.value, 0.05);
        EXPECT_GT(r.absorbed_wood.value, 0.);
        EXPECT_GT(r.absorbed_particles->value, 0.05);
      }
    }
}

// Check that one layer is the same however it is told: without end, as a box as wide as the period, as cells that the
// period cuts through, as cells that a box cuts too, as cells of leaves that are each turned to all directions, and as
// two layers of half its density in the same place.
TEST(R14_MediumTrace, ALayerIsTheSameHoweverItIsTold) {
  const glm::vec2 period(1.05f, 0.9f);
  const TraceMedium whole = layer(Scatterer::leaves, 2.5f);
  TraceMedium box = whole;
  box.box = {.low = {0.3f, -4.f, 0.f}, .high = {0.3f + period.x, -4.f + period.y, 1.f}};
  const auto constant = [](const glm::ivec3& cell) {
    return cell.x == 10 ? 1.25f : 2.5f;  // of the last cells one half is in the period
  };
  const TraceMedium cells{.voxels = voxels({3.f, 2.f, 0.f}, 0.1f, {11, 9, 10}, constant)};
  TraceMedium cut{.voxels = voxels({3.f, 2.f, -0.03f}, 0.1f, {11, 9, 11}, [&](const glm::ivec3& cell) {
                    return constant(cell) * (cell.z == 0 ? 0.7f : cell.z == 10 ? 0.3f : 1.f);
                  })};
  cut.box = whole.box;
  TraceMedium turned = cells;
  turned.voxels->leaves.assign(turned.voxels->density.size(), ProjectedArea{});
  TraceMedium half = whole;
  half.density *= 0.5f;
  const LeafOptics leaf{.reflectance = 0.5f, .transmittance = 0.4f};
  const std::vector<std::vector<TraceMedium>> all{{whole}, {box}, {cells}, {cut}, {turned}, {half, half}};
  std::vector<ForwardResult> forward;
  std::vector<BrfResult> brf;
  for (const std::vector<TraceMedium>& media : all) {
    const RayScene scene(media, period);
    const TraceLight light = lightOn(std::vector<LeafOptics>(media.size(), leaf), 0.9, 0.3f);
    forward.push_back(traceForward(scene, light, {.paths = 30'000, .seed = 1 + forward.size()}));
    brf.push_back(traceBrf(scene, {light}, {kViews[2]}, 10'000).front());
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_TRUE(agree(forward[i].reflected, forward[0].reflected)) << i;
    EXPECT_TRUE(agree(forward[i].absorbed_leaves, forward[0].absorbed_leaves)) << i;
    EXPECT_TRUE(agree(forward[i].arriving_ground, forward[0].arriving_ground)) << i;
    EXPECT_TRUE(agree(forward[i].arriving_ground_direct, forward[0].arriving_ground_direct)) << i;
    EXPECT_TRUE(agree(brf[i].views[0].whole, brf[0].views[0].whole)) << i;
    EXPECT_TRUE(agree(brf[i].views[0].leaf_once, brf[0].views[0].leaf_once)) << i;
  }
}

// Check that the eye's paths see what the sun's paths say of a stand of crowns of voxels with fog, leaves and wood
// among them over ground, in two bands on the same paths.
TEST(R14_MediumTrace, EyeSeesTheLightThatLeaves) {
  TreeMesh mesh = leafBox(20, 4);
  addPolygon(mesh, mesh.wood_triangles, rectangle({0.f, 0.f, 0.3f}, {0.05f, 0.f, 0.f}, {0.f, 0.f, 0.5f}));
  finish(mesh, "leaves and wood");
  TraceMedium fog{.scatterer = Scatterer::particles,
                  .asymmetry = 0.5f,
                  .box = {.low = {-0.5f, -0.4f, 0.f}, .high = {0.5f, 0.4f, 0.7f}},
                  .density = 1.f};
  const RayScene scene(std::array<const TreeMesh*, 1>{&mesh}, {.period = glm::vec2(1.3f, 1.2f)}, true, {crown(), fog});
  std::vector<TraceLight> bands{lightOn({{0.5f, 0.4f}, {0.95f, 0.f}}, 0.7, 0.5f),
                                lightOn({{0.1f, 0.05f}, {0.5f, 0.f}}, 0.7, 0.2f)};
  bands[1].leaf = {.reflectance = 0.1f, .transmittance = 0.05f};
  const std::vector<ForwardResult> forward = traceForwardBands(scene, bands, {.paths = 60'000, .seed = 2});
  const std::vector<BrfResult> brf = traceBrf(scene, bands, {{0., 0.}}, 60'000);
  for (std::size_t band = 0; band < bands.size(); ++band) {
    EXPECT_TRUE(agree(brf[band].albedo.whole, forward[band].reflected)) << band;
    const ForwardResult alone = traceForward(scene, bands[band], {.paths = 60'000, .seed = 3});
    EXPECT_TRUE(agree(alone.reflected, forward[band].reflected)) << band;
    EXPECT_TRUE(agree(alone.absorbed_leaves, forward[band].absorbed_leaves)) << band;
    EXPECT_TRUE(agree(*alone.absorbed_particles, *forward[band].absorbed_particles)) << band;
  }
}

// Check a picture of a lone box of turbid leaves against what one scattering says, exactly: leaves that send so little
// on that the second scattering is below 1e-5 of the first. Seen from above under a sun overhead, with the depth t of
// the box, all directions alike:  L = (rho / pi) <|n.s|^2> / <|n.s|> (1 - e^-2t) / 2, the means being 1/3 and 1/2.
TEST(R15_MediumTrace, PictureOfABoxIsSingleScattering) {
  const TraceMedium box{.box = {.low = {1.f, 2.f, 3.f}, .high = {2.f, 3.f, 4.f}}, .density = 3.f};
  const RayScene scene({box}, {});
  const TraceLight light{.sun = {0.f, 0.f, -1.f}, .of_media = {{.reflectance = 1e-5f, .transmittance = 0.f}}};
  const PixelRays rays{.corner = {0.5f, 3.5f, 9.f},
                       .right_step = {0.5f, 0.f, 0.f},
                       .down_step = {0.f, -0.5f, 0.f},
                       .sight = {0.f, 0.f, -1.f},
                       .width = 4,
                       .height = 4};
  const CameraResult found = traceCamera(scene, light, rays, 0.f, {.paths = 16 * 4'000});
  const double t = 1.5, expected = 1e-5 / kPi * (1. / 3.) / (1. / 2.) * (1. - std::exp(-2. * t)) / 2.;
  double sum = 0., squares = 0.;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      const auto at = static_cast<std::size_t>(4 * y + x);
      const bool inside = x >= 1 && x <= 2 && y >= 1 && y <= 2;
      if (!inside) {
        EXPECT_EQ(found.radiance.values[2 * at], 0.f) << x << " " << y;
      } else {
        sum += double{found.radiance.values[2 * at]} / 4.;
        squares += std::pow(double{found.standard_error.values[at]} / 4., 2);
      }
    }
  EXPECT_NEAR(sum, expected, 5. * std::sqrt(squares) + 1e-5 * expected);
}

// Check that leaves ever smaller become the turbid medium. A layer of leaf area index 2 of square leaves reflects some
// per cent more than turbid leaves, by the hot spot's share and others, in proportion to their side: what sides of 6
// and of 3 cm tell extrapolates to the turbid value. Its error is from the scatter of twelve draws of leaves and
// paths; 7.5 standard errors of twelve are a false alarm of 1.2e-5.
TEST(R15_MediumTrace, TinyLeavesBecomeTurbid) {
  const LeafOptics leaf{.reflectance = 0.5f, .transmittance = 0.4f};
  constexpr float kSide = 2.f;  // of the period [m]
  const auto reflected = [&](float side, std::uint64_t seed) {
    Random random(seed, 0);
    TreeMesh mesh;
    for (int i = 0; i < static_cast<int>(2.f * kSide * kSide / (side * side)); ++i) {
      const glm::vec3 centre(kSide * random.uniform(), kSide * random.uniform(), random.uniform());
      const Axes axes = axesAlong(onSphere(random));
      addPolygon(mesh, mesh.leaf_triangles, rectangle(centre, 0.5f * side * axes.right, 0.5f * side * axes.up));
    }
    finish(mesh, "layer");
    TraceLight light = lightOn({}, 0.5);
    light.leaf = leaf;
    const RayScene scene(mesh, {.period = glm::vec2(kSide)}, false);
    return traceForward(scene, light, {.paths = 32'000, .seed = seed}).reflected.value;
  };
  constexpr int draws = 12;
  double mean = 0., squares = 0.;
  for (std::uint64_t draw = 1; draw <= draws; ++draw) {
    const double large = reflected(0.06f, 100 + draw), limit = 2. * reflected(0.03f, 200 + draw) - large;
    mean += limit / draws;
    squares += limit * limit / draws;
  }
  const double error = std::sqrt((squares - mean * mean) / (draws - 1));
  const ForwardResult turbid =
      traceForward(RayScene({layer(Scatterer::leaves, 2.f)}, glm::vec2(1.f)), lightOn({leaf}, 0.5), {.paths = 100'000});
  EXPECT_NEAR(mean, turbid.reflected.value, 7.5 * error);
  EXPECT_LT(error, 0.004);
}

// Check that the bits do not depend on the number of threads, that what is in a medium tells runs apart, and that light
// must know of each medium.
TEST(R14_MediumTrace, IdentityAndDeterminism) {
  const glm::vec2 period(1.2f, 1.1f);
  const RayScene scene({crown()}, period);
  const TraceLight light = lightOn({{0.4f, 0.4f}}, 0.4, 0.2f);
  const ForwardResult one = traceForward(scene, light, {.paths = 6'400, .threads = 1});
  const ForwardResult many = traceForward(scene, light, {.paths = 6'400, .threads = 4});
  EXPECT_EQ(one.reflected.value, many.reflected.value);
  EXPECT_EQ(one.absorbed_leaves.standard_error, many.absorbed_leaves.standard_error);

  const auto identity = [&](const TraceMedium& medium, const TraceLight& of_light) {
    return ForwardJob(RayScene({medium}, period), {of_light}, 64).identity();
  };
  const TraceIdentity of_crown = identity(crown(), light);
  EXPECT_EQ(of_crown, identity(crown(), light));
  TraceMedium other = crown();
  other.voxels->density[300] += 1e-6f;
  EXPECT_NE(of_crown, identity(other, light));
  other = crown();
  other.voxels->leaves[300].xy += 1e-6f;
  EXPECT_NE(of_crown, identity(other, light));
  other = crown();
  other.scatterer = Scatterer::particles;
  EXPECT_NE(of_crown, identity(other, light));
  EXPECT_NE(of_crown, identity(crown(), lightOn({{0.4f, 0.3f}}, 0.4, 0.2f)));

  EXPECT_THROW(traceForward(scene, lightOn({}, 0.4), {}), InvalidInput);
  EXPECT_THROW(traceForward(scene, lightOn({{0.6f, 0.6f}}, 0.4), {}), InvalidInput);
}
