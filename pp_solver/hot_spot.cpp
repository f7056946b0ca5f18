#include "pp_solver/hot_spot.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/require.hpp"

namespace sunfleck::pp {
namespace {

constexpr double kPi = std::numbers::pi;

// Length over which shadows of leaves overlap, over the leaf's diameter: the integral of the share of its area that a
// disc keeps common with itself, moved aside. The exponential that takes this share's place has the same integral, so
// that paths that part far count as many leaves twice as with discs.
constexpr double kOverlapLength = 4. / (3. * kPi);

void requireLayer(const LeafScattering& leaves, double thickness, double mu0) {
  require(0. <= leaves.reflectance && leaves.reflectance <= 1., "leaf reflectance", leaves.reflectance,
          "within 0 .. 1");
  require(0. <= leaves.transmittance && leaves.transmittance <= 1. - leaves.reflectance, "leaf transmittance",
          leaves.transmittance, "within 0 .. 1 - reflectance");
  require(leaves.hot_spot >= 0. && std::isfinite(leaves.hot_spot), "hot_spot", leaves.hot_spot,
          "finite and not negative");
  require(thickness > 0., "thickness", thickness, "above 0");
  require(0. < mu0 && mu0 <= 1., "mu0", mu0, "within (0, 1]");
}

void requireView(const SunAndView& at) {
  require(0. < at.mu && at.mu <= 1., "mu", at.mu, "within (0, 1]");
  require(std::isfinite(at.azimuth), "azimuth", at.azimuth, "finite");
}

// Paths of sun and view through the layer, by leaf area index above a place.
struct Paths {
  double sun, view;  // extinction G / mu of each [1]
  double shared;     // their geometric mean: how many leaves both would meet if they were one path
  double parting;    // a: how fast they part, in overlap lengths per leaf area index [1]; infinite without a hot spot

  double extinction() const { return sun + view; }
  // Leaf crossings counted twice above depth: shared (1 - e^(-parting depth)) / parting.
  double overlap(double depth) const {
    const double apart = parting * depth;
    if (!(apart > 1e-8)) return shared * depth;
    return shared * (-std::expm1(-apart) / parting);
  }
};

// Cosines below this change no digit of any result; their inverses stay finite.
double away(double mu) {
  return std::max(mu, 1e-100);
}

// Distance at which both paths are apart one unit of height up: |tan theta to_sun - tan theta_v to_eye|. The azimuths
// are of travel, and light goes opposite to `to_sun`: equal directions have azimuth pi.
double partingPerHeight(double mu0, double mu, double azimuth) {
  const double tan0 = std::sqrt(std::max(0., (1. - mu0) * (1. + mu0))) / mu0;
  const double tan = std::sqrt(std::max(0., (1. - mu) * (1. + mu))) / mu;
  return std::hypot(tan0 - tan, 2. * std::sqrt(tan0) * std::sqrt(tan) * std::cos(0.5 * azimuth));
}

struct Projected {
  double sun, view;  // G [1]
};

Paths pathsOf(const LeafScattering& leaves, double thickness, double mu0, double mu, double azimuth, Projected g) {
  Paths paths{g.sun / away(mu0), g.view / away(mu), 0., std::numeric_limits<double>::infinity()};
  paths.shared = std::sqrt(paths.sun) * std::sqrt(paths.view);
  if (leaves.hot_spot > 0.)
    paths.parting = partingPerHeight(away(mu0), away(mu), azimuth) / kOverlapLength / leaves.hot_spot / thickness;
  return paths;
}

// Integral over the layer of e^(-k L) (e^overlap(L) - 1). The integrand bends at 1 / parting and at 1 / k and falls at
// least as fast as e^(-k L / 2); panels that double from the shorter one follow it over any range.
double excessOverDepth(const Paths& paths, double thickness) {
  using Rule = boost::math::quadrature::gauss<double, 15>;
  const double k = paths.extinction();
  const auto integrand = [&](double depth) {
    const double overlap = paths.overlap(depth);
    return overlap < 1. ? std::exp(-k * depth) * std::expm1(overlap)
                        : std::exp(overlap - k * depth) - std::exp(-k * depth);
  };
  // Past 80 / k the rest is below e^-40 of the whole.
  const double last = std::min(thickness, 80. / k);
  double from = 0., to = std::min(1. / paths.parting, 1. / k), sum = 0.;
  // A part of the layer that thin adds nothing that a double could hold beside the turbid radiance.
  if (to < 1e-30 * last) to = 1e-30 * last;
  while (from < last) {
    to = std::min(to, last);
    sum += Rule::integrate(integrand, from, to);
    from = to;
    to *= 2.;
  }
  return sum;
}

ScatteredOnce excess(const LeafScattering& leaves, const SunAndView& at, Projected g) {
  const Paths paths = pathsOf(leaves, at.thickness, at.mu0, at.mu, at.azimuth, g);
  if (!(paths.shared > 0.) || !(paths.parting < 1e300)) return {0., 0.};
  const double turn = leafScattering(leaves, -at.mu, at.mu0, at.azimuth);
  const double overlap = paths.overlap(at.thickness);
  const double through = paths.extinction() * at.thickness;
  double gap = 0.;
  if (through < 1500.)  // overlap is at most half of it
    gap = overlap < 1. ? std::exp(-through) * std::expm1(overlap) : std::exp(overlap - through) - std::exp(-through);
  return {turn * (excessOverDepth(paths, at.thickness) / away(at.mu)), gap};
}

}  // namespace

// (P22)
ScatteredOnce scatteredOnceTurbid(const LeafScattering& leaves, const SunAndView& at) {
  requireLayer(leaves, at.thickness, at.mu0);
  requireView(at);
  const Projected g{leafProjection(leaves.angles, at.mu0), leafProjection(leaves.angles, at.mu)};
  const double k = g.sun / away(at.mu0) + g.view / away(at.mu);
  const double turn = leafScattering(leaves, -at.mu, at.mu0, at.azimuth);
  // Flat leaves edge-on: k = 0 only with turn = 0, in the limit.
  const double gap = k > 0. ? std::exp(-k * at.thickness) : 1.;
  return {k > 0. ? turn * (-std::expm1(-k * at.thickness) / k / away(at.mu)) : 0., gap};
}

// (P22)
ScatteredOnce hotSpotExcess(const LeafScattering& leaves, const SunAndView& at) {
  requireLayer(leaves, at.thickness, at.mu0);
  requireView(at);
  require(leaves.hot_spot == 0. || std::isfinite(at.thickness), "thickness", at.thickness, "finite with a hot spot");
  return excess(leaves, at, {leafProjection(leaves.angles, at.mu0), leafProjection(leaves.angles, at.mu)});
}

// (P22) The excess has a cusp where the view meets the sun and is widest near it: both integrals run out from there, by
// squares of their variable.
ScatteredOnce hotSpotFlux(const LeafScattering& leaves, double thickness, double mu0) {
  requireLayer(leaves, thickness, mu0);
  require(leaves.hot_spot == 0. || std::isfinite(thickness), "thickness", thickness, "finite with a hot spot");
  if (leaves.hot_spot == 0.) return {0., 0.};
  using Rule = boost::math::quadrature::gauss<double, 20>;
  const double g0 = leafProjection(leaves.angles, mu0);
  ScatteredOnce flux{0., 0.};
  const auto half = [&](double length, double sign) {
    if (length <= 0.) return;
    for (std::size_t i = 0; i < 2 * Rule::abscissa().size(); ++i) {
      const std::size_t p = i / 2;
      const double u = 0.5 + (i % 2 == 0 ? 0.5 : -0.5) * Rule::abscissa()[p];
      const double mu = mu0 + sign * length * u * u, weight = 0.5 * Rule::weights()[p] * 2. * length * u;
      const Projected g{g0, leafProjection(leaves.angles, mu)};
      for (std::size_t j = 0; j < 2 * Rule::abscissa().size(); ++j) {
        const std::size_t q = j / 2;
        const double v = 0.5 + (j % 2 == 0 ? 0.5 : -0.5) * Rule::abscissa()[q];
        const ScatteredOnce once = excess(leaves, {thickness, mu0, mu, kPi * (1. - v * v)}, g);
        const double share = weight * mu * 2. * (0.5 * Rule::weights()[q] * 2. * kPi * v);
        flux.leaves += share * once.leaves;
        flux.gap += share * mu0 / kPi * once.gap;
      }
    }
  };
  half(mu0, -1.);
  half(1. - mu0, 1.);
  return flux;
}

}  // namespace sunfleck::pp
