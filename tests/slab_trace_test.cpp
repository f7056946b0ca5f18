#include "render/reference/slab_trace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/require.hpp"
#include "spp/stream_slab.hpp"

// Monte Carlo of a slab, against published values, against discrete ordinates (which share no code with it), and
// against what holds exactly. Some 60 z-tests at fixed seeds: |z| <= 5 in each makes a false alarm less likely than
// 1e-4 in all, the tails of 64 batches included.
namespace {

using namespace sunfleck;
constexpr double kPi = std::numbers::pi;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// `precision`: largest standard error that lets the check say something, over the value.
void expectAgrees(const Estimate& found, double expected, double precision, const std::string& what) {
  EXPECT_LE(std::abs(found.value - expected), 5. * found.standard_error)
      << what << ": " << found.value << " +- " << found.standard_error << " against " << expected;
  EXPECT_LE(found.standard_error, precision * expected) << what;
}

struct KnownRadiance {
  SlabView view;
  double value;  // for beam irradiance pi
};
struct KnownSlab {
  TracedSlab slab;
  double reflectance, transmittance;
  std::vector<KnownRadiance> radiances;
};

// Values on which an adding-doubling code and discrete ordinate codes of 128 streams agree to 1e-6 and better.
const std::vector<KnownSlab> kKnownSlabs{{{0.0, 0.9, 1.0, 1.0},
                                          0.267410335069157,
                                          0.591625089581466,
                                          {{{0.0, -0.5}, 0.298151261299038},
                                           {{0.5, -1.0}, 0.108052178985994},
                                           {{0.5, 0.1}, 0.347039920814568},
                                           {{0.5, 1.0}, 0.143158795868861},
                                           {{1.0, 0.5}, 0.246678974336868}}},
                                         {{0.85, 0.9, 1.0, 1.0},
                                          0.0296764621308033,
                                          0.862148179442932,
                                          {{{0.0, -0.5}, 0.0380322985982229},
                                           {{0.5, -1.0}, 0.00642272947607773},
                                           {{0.5, 0.1}, 0.0938508616946266},
                                           {{0.5, 1.0}, 5.98736731965669},
                                           {{1.0, 0.5}, 0.131280385949649}}},
                                         {{0.5, 0.99, 1.0, 0.5},
                                          0.351620272347464,
                                          0.625706473390419,
                                          {{{0.0, -0.5}, 0.34269846346155},
                                           {{0.5, -1.0}, 0.0415930573495998},
                                           {{0.5, 0.1}, 0.768596606804364},
                                           {{0.5, 1.0}, 0.127685459906365},
                                           {{1.0, 0.5}, 0.668590408653722}}},
                                         {{-0.5, 0.99, 0.1, 0.1},
                                          0.34759007988319,
                                          0.644584535611016,
                                          {{{0.0, -0.5}, 0.0193622775649634},
                                           {{0.05, -1.0}, 0.00480427017413062},
                                           {{0.05, 0.1}, 0.0569631180369835},
                                           {{0.05, 1.0}, 0.00597017093462171},
                                           {{0.1, 0.5}, 0.0182992987917438}}},
                                         {{0.0, 1.0, 10.0, 0.5},
                                          0.898249748630191,
                                          0.101750251369679,
                                          {{{0.0, -0.5}, 0.462069124844848},
                                           {{5.0, -1.0}, 0.17981547364817},
                                           {{5.0, 0.1}, 0.221805483169239},
                                           {{5.0, 1.0}, 0.254852343699844},
                                           {{10.0, 0.5}, 0.0443410076151961}}}};

// Check reflectance, transmittance and radiance within and outside against those slabs.
TEST(R8_SlabTrace, MeetsKnownSlabs) {
  for (const KnownSlab& known : kKnownSlabs) {
    SlabMeasures measures;
    for (const KnownRadiance& radiance : known.radiances) measures.views.push_back(radiance.view);
    const SlabTraceResult result = traceSlab(known.slab, measures, {.paths = 1'000'000, .seed = 3});
    const std::string name = "g " + std::to_string(known.slab.asymmetry) + " w " + std::to_string(known.slab.thickness);
    expectAgrees(result.reflectance, known.reflectance, 0.01, name + " reflectance");
    expectAgrees(result.transmittance, known.transmittance, 0.01, name + " transmittance");
    for (std::size_t i = 0; i < known.radiances.size(); ++i)
      expectAgrees(result.radiance[i], known.radiances[i].value / kPi, 0.03, name + " view " + std::to_string(i));
  }
}

// Check an infinite slab against Chandrasekhar's R = 1 - sqrt(1 - omega) H(mu0), values by his H function.
TEST(R8_SlabTrace, MeetsTheInfiniteSlab) {
  expectAgrees(traceSlab({0., 0.9, kInfinite, 0.5}, {}, {.paths = 200'000}).reflectance, 0.507938906940091, 0.01, ".9");
  const SlabTraceResult result = traceSlab({0., 0.99, kInfinite, 0.1}, {}, {.paths = 200'000});
  expectAgrees(result.reflectance, 0.877512470958283, 0.01, ".99");
  EXPECT_EQ(result.transmittance.value, 0.);
}

// Check fluxes, and radiance out of the beam's plane, against 24 streams (their own error is below 1e-7).
TEST(R8_SlabTrace, MeetsDiscreteOrdinates) {
  const TracedSlab slab{0.6, 0.95, 4., 0.7};
  const SlabMeasures measures{.depths = {0., 0.5, 2., 4.},
                              .views = {{0., -0.8, 2.}, {1., 0.3, 1.}, {4., 0.9, -1.5}, {2., -0.2, 3.}}};
  const SlabTraceResult result = traceSlab(slab, measures, {.paths = 400'000, .seed = 5});
  const spp::StreamSlab<double> exact(spp::nStreamConstants({slab.asymmetry, slab.albedo, slab.mu0}, 24, 48),
                                      slab.thickness);
  for (std::size_t i = 0; i < measures.depths.size(); ++i) {
    const auto light = exact.light(measures.depths[i]);
    const std::string name = "depth " + std::to_string(measures.depths[i]);
    if (i > 0) expectAgrees(result.flux_down[i], light.flux_down, 0.01, name);
    if (i + 1 < measures.depths.size()) expectAgrees(result.flux_up[i], light.flux_up, 0.01, name);
  }
  for (std::size_t i = 0; i < measures.views.size(); ++i) {
    const SlabView& view = measures.views[i];
    expectAgrees(result.radiance[i], exact.refinedRadiance(view.depth, exact.view(view.mu, view.azimuth)), 0.02,
                 "view " + std::to_string(i));
  }
  EXPECT_EQ(result.flux_down[0].value, slab.mu0);
  EXPECT_EQ(result.flux_up[3].value, 0.);
  EXPECT_NEAR(result.flux_up[0].value, slab.mu0 * result.reflectance.value, 1e-12);
}

// Check that all light is accounted for, to rounding of 100,000 sums, and the direct light by Beer and Lambert's law.
TEST(R8_SlabTrace, LosesNoLight) {
  for (double omega : {0., 0.3, 0.9, 1.})
    for (double w : {1e-8, 1., 30.}) {
      const SlabTraceResult result = traceSlab({-0.3, omega, w, 0.4}, {}, {.paths = 20'000});
      EXPECT_NEAR(result.reflectance.value + result.transmittance.value + result.absorptance.value, 1., 1e-11);
      EXPECT_EQ(result.direct, std::exp(-w / 0.4));
      if (omega == 0.) {
        EXPECT_NEAR(result.absorptance.value, 1. - result.direct, 1e-11);
      } else if (omega == 1.) {
        EXPECT_EQ(result.absorptance.value, 0.);
      }
    }
}

// Check the sampled angles by thin slabs under normal light, where R = omega w (1 - T) with the forward share's closed
// form; scattered twice is 1e-4 of that. Sampling without a division by g has no gap at g = 0.
TEST(R8_SlabTrace, SamplesHenyeyGreenstein) {
  for (double g : {-0.95, -0.5, -1e-9, 0., 1e-9, 0.5, 0.9}) {
    const double w = 1e-5;
    const double forward =
        std::abs(g) < 1e-6 ? 0.5 : (1. - g * g) / (2. * g) * (1. / (1. - g) - 1. / std::sqrt(1. + g * g));
    const SlabTraceResult result = traceSlab({g, 1., w, 1.}, {}, {.paths = 200'000, .seed = 11});
    expectAgrees(result.reflectance, w * (1. - forward), 0.02, "g " + std::to_string(g));
  }
}

// Check that the result depends on the seed and not on the threads.
TEST(R8_SlabTrace, IsTheSameForAnyThreads) {
  const SlabMeasures measures{.depths = {0.5}, .views = {{0.5, 0.5, 0.}}};
  const auto run = [&](std::uint64_t seed, int threads) {
    return traceSlab({0.5, 0.9, 1., 0.5}, measures, {.paths = 20'000, .seed = seed, .threads = threads});
  };
  const SlabTraceResult one = run(1, 1), two = run(1, 2), other = run(2, 2);
  EXPECT_EQ(one.reflectance.value, two.reflectance.value);
  EXPECT_EQ(one.radiance[0].value, two.radiance[0].value);
  EXPECT_EQ(one.flux_down[0].standard_error, two.flux_down[0].standard_error);
  EXPECT_NE(one.reflectance.value, other.reflectance.value);
}

// Check that what is out of range is refused.
TEST(R8_SlabTrace, RefusesBadInput) {
  const TraceEffort effort{.paths = 64};
  EXPECT_THROW(traceSlab({-1., 0.5, 1., 1.}, {}, effort), InvalidInput);
  EXPECT_THROW(traceSlab({0., std::nan(""), 1., 1.}, {}, effort), InvalidInput);
  EXPECT_THROW(traceSlab({0., 0.5, 0., 1.}, {}, effort), InvalidInput);
  EXPECT_THROW(traceSlab({0., 0.5, 1., 0.}, {}, effort), InvalidInput);
  EXPECT_THROW(traceSlab({0., 0.5, 1., 1.}, {.depths = {1.5}}, effort), InvalidInput);
  EXPECT_THROW(traceSlab({0., 0.5, kInfinite, 1.}, {.depths = {kInfinite}}, effort), InvalidInput);
  EXPECT_THROW(traceSlab({0., 0.5, 1., 1.}, {.views = {{0., 0., 0.}}}, effort), InvalidInput);
  EXPECT_THROW(traceSlab({0., 0.5, 1., 1.}, {}, {.paths = 1}), InvalidInput);
}

}  // namespace
