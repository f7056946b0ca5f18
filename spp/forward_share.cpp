#include "spp/forward_share.hpp"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/math/special_functions/ellint_rj.hpp>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace sunfleck::spp {
namespace {

constexpr double kPi = std::numbers::pi;

// Below this |g| the closed forms lose digits to the division by g, and a few moments are enough.
constexpr double kNearlyIsotropic = 0.25;
constexpr std::size_t kFewMoments = 28;
constexpr std::size_t kSampledMoments = 512;

// Integral over the sphere of p(s . s0) sign(s . normal), for which T = (1 + it) / 2: sum over odd l of (2 l + 1) chi_l
// c_l P_l(mu0), c_l the integral of P_l over (0, 1). Where the series goes on, its last odd moment counts as a peak.
//   mean  of mu0 over (0, 1), in place of mu0: c_l^2
double forwardExcess(std::span<const double> chi, bool goes_on, double mu0, bool mean) {
  const double peak = goes_on ? chi[chi.size() - 1 - chi.size() % 2] : 0.;
  double sum = peak, now = mu0, before = 1.;
  double twice_weight = 1.5;  // (2 l + 1) c_l
  for (std::size_t l = 1; l < chi.size(); l += 2) {
    const double order = static_cast<double>(l);
    sum += (chi[l] - peak) * twice_weight * (mean ? twice_weight / (2. * order + 1.) : now);
    const double even = ((2. * order + 1.) * mu0 * now - order * before) / (order + 1.);
    now = ((2. * order + 3.) * mu0 * even - (order + 1.) * now) / (order + 2.);
    before = even;
    twice_weight *= -order / (order + 1.) * (2. * order + 5.) / (2. * order + 1.) * (order + 1.) / (order + 3.);
  }
  return std::clamp(sum, -1., 1.);
}

double forwardExcess(double asymmetry, double mu0, bool mean) {
  std::array<double, kFewMoments> chi{1.};
  for (std::size_t l = 1; l < chi.size(); ++l) chi[l] = chi[l - 1] * asymmetry;
  return forwardExcess(chi, false, mu0, mean);
}

double forwardExcess(const PhaseFunction& phase, double mu0, bool mean) {
  const bool goes_on = phase.orders() == PhaseFunction::kNoEnd;
  std::vector<double> chi(static_cast<std::size_t>(goes_on ? kSampledMoments : phase.orders()));
  phase.moments(chi);
  return forwardExcess(chi, goes_on, mu0, mean);
}

// 1 - T for g > 0 = (1 - g) / 2g ((1 + g) J - 1),  J = (mu0 / pi) integral over c in (-s, s) of
// 1 / ((1 - c^2) sqrt(s^2 - c^2) sqrt(1 + g^2 - 2 g c)), s = sin(theta0). With c = -s cos(2 x) and partial fractions
// in 1 - c and 1 + c it is two complete elliptic integrals of the third kind, one of which DLMF 19.21.12 turns into a
// form that does not cancel as mu0 -> 0.
double backwardShare(double g, double mu0) {
  using namespace boost::math::policies;
  constexpr policy<promote_double<false>> in_double;
  const double sine = std::sqrt((1. - mu0) * (1. + mu0)), rest = mu0 * mu0 / (1. + sine);  // rest = 1 - sine
  const double near = (1. - g) * (1. - g) + 2. * g * rest, far = near + 4. * g * sine;     // 1 + g^2 -+ 2 g sine
  const double y = near / far, p = rest / (1. + sine);
  const double integrals =
      2. * boost::math::ellint_rf(0., y, 1., in_double) +
      (1. - p) / 3. *
          (boost::math::ellint_rj(0., y, 1., p, in_double) + y * boost::math::ellint_rj(0., y, 1., y * p, in_double));
  const double J = mu0 / (kPi * std::sqrt(far) * (1. + sine)) * integrals;
  return std::clamp(0.5 * (1. - g) / g * ((1. + g) * J - 1.), 0., 1.);
}

double meanBackwardShare(double g) {
  return std::clamp((1. - g) * (1. + g) / (2. * kPi * g) * (2. * std::comp_ellint_1(g) - kPi / (1. + g)), 0., 1.);
}

// omega (2 T - 1) of leaves over mu / G(mu): the half that scattering leads to depends on the product of the cosines of
// both directions to the leaf alone, of which the integral over a half knows the vertical part.
double leafContrast(const LeafScattering& leaves) {
  double square = 0.;
  for (const LeafAngles::Node& node : leaves.angles.nodes()) square += node.weight * node.cosine * node.cosine;
  return (leaves.transmittance - leaves.reflectance) * square;
}

}  // namespace

double forwardShare(double asymmetry, double mu0) {
  if (std::abs(asymmetry) < kNearlyIsotropic) return 0.5 + 0.5 * forwardExcess(asymmetry, mu0, false);
  const double share = backwardShare(std::abs(asymmetry), mu0);
  return asymmetry > 0. ? 1. - share : share;
}

// The mean is 1 - (integral of Theta p sin Theta dTheta); by parts it is a complete elliptic integral, K(g).
double meanForwardShare(double asymmetry) {
  if (std::abs(asymmetry) < kNearlyIsotropic) return 0.5 + 0.5 * forwardExcess(asymmetry, 1., true);
  const double share = meanBackwardShare(std::abs(asymmetry));
  return asymmetry > 0. ? 1. - share : share;
}

double forwardShare(const Medium& medium, double mu0) {
  if (const auto* leaves = std::get_if<LeafScattering>(&medium)) {
    const double albedo = singleScatteringAlbedo(medium), projection = leafProjection(leaves->angles, mu0);
    if (albedo <= 0. || projection <= 0.) return 0.5;
    return std::clamp(0.5 + 0.5 * leafContrast(*leaves) * mu0 / (projection * albedo), 0., 1.);
  }
  const PhaseFunction& phase = std::get<Particles>(medium).phase;
  if (const auto asymmetry = phase.henyeyGreensteinAsymmetry()) return forwardShare(*asymmetry, mu0);
  return 0.5 + 0.5 * forwardExcess(phase, mu0, false);
}

double meanForwardShare(const Medium& medium) {
  if (const auto* leaves = std::get_if<LeafScattering>(&medium)) {
    const double albedo = singleScatteringAlbedo(medium);
    return albedo > 0. ? std::clamp(0.5 + 0.5 * leafContrast(*leaves) / albedo, 0., 1.) : 0.5;
  }
  const PhaseFunction& phase = std::get<Particles>(medium).phase;
  if (const auto asymmetry = phase.henyeyGreensteinAsymmetry()) return meanForwardShare(*asymmetry);
  return 0.5 + 0.5 * forwardExcess(phase, 1., true);
}

}  // namespace sunfleck::spp
