#include "stress_problems.hpp"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>

#include "core/random.hpp"

namespace sunfleck::stress {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBelowOne = 1. - 0x1p-53;

// Small sizes, where time is short and rounding acts on few numbers, more often than large ones.
constexpr std::array kStreams{2, 2, 2, 4, 4, 4, 4, 6, 6, 8, 8, 8, 10, 12, 16, 16, 24, 32, 48, 64};
static_assert(std::ranges::max(kStreams) == 64);

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniformDouble();
}
double logBetween(Random& random, double low, double high) {
  return std::exp(between(random, std::log(low), std::log(high)));
}
bool chance(Random& random, double share) {
  return random.uniformDouble() < share;
}
std::size_t pick(Random& random, std::size_t count) {
  return std::min(static_cast<std::size_t>(random.uniformDouble() * static_cast<double>(count)), count - 1);
}

// Nodes of Gauss's rule on (0, 1), the directions in a hemisphere.
const std::vector<double>& nodes(int streams) {
  static const auto all = [] {
    std::map<int, std::vector<double>> result;
    for (const int n : kStreams) {
      if (result.contains(n)) continue;
      for (const double zero : boost::math::legendre_p_zeros<double>(n / 2))
        for (const double sign : {-1., 1.}) result[n].push_back(0.5 * (1. + sign * zero));
    }
    return result;
  }();
  return all.at(streams);
}

double drawMu0(Random& random, int streams) {
  const auto& on = nodes(streams);
  const double node = on[pick(random, on.size())];
  const double kind = random.uniformDouble();
  if (kind < 0.15) return node;
  if (kind < 0.25) return std::min(node + 1e-15, 1.);
  if (kind < 0.35) return node - 1e-15;
  if (kind < 0.40) return node * (1. + (chance(random, 0.5) ? 1. : -1.) * logBetween(random, 1e-14, 1e-4) / 2.);
  if (kind < 0.50) return 1.;
  if (kind < 0.55) return kBelowOne;
  if (kind < 0.65) return logBetween(random, 1e-4, 1e-1);
  return std::max(random.uniformDouble(), 1e-4);
}

double drawAlbedo(Random& random) {
  const double kind = random.uniformDouble();
  if (kind < 0.25) return 1.;
  if (kind < 0.35) return kBelowOne;
  if (kind < 0.45) return 0.;
  if (kind < 0.60) return 1. - logBetween(random, 1e-15, 1e-2);
  if (kind < 0.65) return logBetween(random, 1e-16, 1e-2);
  return random.uniformDouble();
}

double drawAsymmetry(Random& random) {
  const double kind = random.uniformDouble();
  if (kind < 0.15) return 0.;
  if (kind < 0.25) return 0.999;
  if (kind < 0.35) return -0.999;
  if (kind < 0.45) return (chance(random, 0.5) ? 1. : -1.) * logBetween(random, 1e-16, 1e-2);
  return between(random, -0.999, 0.999);
}

double drawThickness(Random& random, bool last) {
  if (last && chance(random, 0.05)) return kInfinity;
  return chance(random, 0.5) ? logBetween(random, 1e-12, 1e12) : logBetween(random, 1e-2, 1e2);
}

PhaseFunction drawPhase(Random& random) {
  const double kind = random.uniformDouble();
  if (kind < 0.85) return PhaseFunction::henyeyGreenstein(drawAsymmetry(random));
  // 1 + 3 c x + 5 d P2(x) >= 1 - 3 |c| - 5 |d|.
  if (kind < 0.95) return PhaseFunction::fromMoments({1., between(random, -0.15, 0.15), between(random, -0.1, 0.1)});
  std::vector<double> cosines{-1.}, values{random.uniformDouble()};
  while (cosines.back() < 1.) {
    cosines.push_back(std::min(cosines.back() + between(random, 0.01, 0.3), 1.));
    values.push_back(0.01 + random.uniformDouble());
  }
  return PhaseFunction::sampled(cosines, values);
}

double totalThickness(const pp::Problem& problem) {
  double sum = 0.;
  for (const pp::Layer& layer : problem.layers) sum += layer.thickness;
  return sum;
}

}  // namespace

StressProblem drawProblem(std::uint64_t seed, std::uint64_t index) {
  Random random(seed, index);
  StressProblem drawn;
  drawn.settings.streams = kStreams[pick(random, kStreams.size())];
  drawn.settings.delta_m = chance(random, 0.8);
  drawn.settings.corrections = chance(random, 0.8);
  drawn.isothermal = chance(random, 0.05);
  pp::Problem& problem = drawn.problem;

  const double kind = random.uniformDouble();
  const std::size_t layers = kind < 0.5 ? 1 : kind < 0.8 ? 2 + pick(random, 4) : 6 + pick(random, 45);
  for (std::size_t i = 0; i < layers; ++i)
    problem.layers.push_back({.thickness = drawThickness(random, i + 1 == layers),
                              .medium = Particles{drawAlbedo(random), drawPhase(random)}});
  const bool infinite = std::isinf(problem.layers.back().thickness);
  if (chance(random, 0.5)) problem.ground.albedo = chance(random, 0.3) ? 1. : random.uniformDouble();

  if (drawn.isothermal) {
    problem.above = problem.ground.emission = 1.;
    for (pp::Layer& layer : problem.layers) layer.emission_top = layer.emission_bottom = 1.;
  } else {
    if (chance(random, 0.85))
      problem.beam = pp::Beam{.mu0 = drawMu0(random, drawn.settings.streams),
                              .azimuth = between(random, 0., 2. * std::numbers::pi)};
    if (!problem.beam || chance(random, 0.1)) problem.above = random.uniformDouble() + 0.01;
    if (!infinite && chance(random, 0.05)) problem.below = random.uniformDouble();
  }

  if (chance(random, 0.1)) {
    const double deepest = infinite ? 100. : totalThickness(problem);
    drawn.depths = {0., deepest * random.uniformDouble(), deepest};
    const auto& on = nodes(drawn.settings.streams);
    drawn.mus = {-1., 1., -1e-4, 1e-4, on[pick(random, on.size())], -on[pick(random, on.size())]};
    if (problem.beam) drawn.mus.push_back(problem.beam->mu0);
    drawn.phis = {0., between(random, 0., 6.)};
  }
  return drawn;
}

int batchStreams(std::uint64_t seed, std::uint64_t batch) {
  Random random(seed, ~batch);  // no problem has so high an index
  return kStreams[pick(random, kStreams.size())];
}

pp::SlabCase drawCase(std::uint64_t seed, std::uint64_t index, int streams) {
  Random random(seed, index);
  pp::SlabCase slab;
  slab.asymmetry = drawAsymmetry(random);
  slab.albedo = drawAlbedo(random);
  slab.thickness = drawThickness(random, true);
  slab.mu0 = drawMu0(random, streams);
  return slab;
}

std::string describe(const StressProblem& drawn) {
  std::ostringstream text;
  text.precision(17);
  const pp::Problem& problem = drawn.problem;
  text << "N " << drawn.settings.streams << (drawn.settings.delta_m ? "" : ", no delta-M")
       << (drawn.settings.corrections ? "" : ", no corrections") << (drawn.isothermal ? ", isothermal" : "");
  if (problem.beam) text << ", mu0 " << problem.beam->mu0 << ", azimuth " << problem.beam->azimuth;
  text << ", above " << std::get<double>(problem.above) << ", below " << std::get<double>(problem.below) << ", ground "
       << problem.ground.albedo << ", layers (thickness omega chi_1 chi_2)";
  for (const pp::Layer& layer : problem.layers) {
    const auto& particles = std::get<Particles>(layer.medium);
    std::array<double, 3> moments;
    particles.phase.moments(moments);
    text << " (" << layer.thickness << ' ' << particles.albedo << ' ' << moments[1] << ' ' << moments[2] << ')';
  }
  return text.str();
}

std::string describe(const pp::SlabCase& slab, int streams) {
  std::ostringstream text;
  text.precision(17);
  text << "batch, N " << streams << ", g " << slab.asymmetry << ", omega " << slab.albedo << ", tau " << slab.thickness
       << ", mu0 " << slab.mu0;
  return text.str();
}

}  // namespace sunfleck::stress
