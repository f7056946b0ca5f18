#include "spp/stream_constants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spp/detail/checked_medium.hpp"
#include "spp/forward_share.hpp"

namespace sunfleck::spp {
namespace {

constexpr double kPi = std::numbers::pi;

// One stream for each half's power: mean |cos| of the diffuse light, and the forward shares of diffuse light and beam.
StreamConstants uniformHalves(const BeamInMedium& medium, double mean_cosine, double diffuse_share, double beam_share) {
  const double omega = medium.albedo, lost = 1. - omega;
  const double netted =
      (lost + 2. * omega * (1. - diffuse_share)) / mean_cosine;  // (1 - omega (2 T - 1)) / mean cosine
  const double k = std::sqrt(netted * lost / mean_cosine);
  const double a = omega * (2. * beam_share - 1.) / mean_cosine, b = netted * omega / mean_cosine;
  StreamConstants constants{
      .medium = medium, .cosines = {mean_cosine}, .solid_angles = {2. * kPi}, .uniform_halves = true};
  const double per_steradian = 0.5 / kPi, seen = 0.25 * omega / kPi;
  constants.orders.push_back({.rate = {k},
                              .odd_source = {a},
                              .gain = {(b * medium.mu0 + a) / (1. + k * medium.mu0)},
                              .sum = {per_steradian},
                              .difference = {per_steradian / netted},
                              .seen = {seen, seen / netted}});
  return constants;
}

}  // namespace

std::vector<double> StreamConstants::viewFunctions(int order, double mu) const {
  if (uniform_halves) return {1., 2. * forwardShare(medium.asymmetry, std::clamp(mu, kLeastCosine, 1.)) - 1.};
  std::vector<double> result(static_cast<std::size_t>(2 * streams() - order));
  legendreFunctions(order, mu, result);
  return result;
}

StreamConstants sppConstants(const BeamInMedium& medium) {
  const BeamInMedium checked = detail::checkedMedium(medium);
  const double share = forwardShare(checked.asymmetry, checked.mu0);
  return uniformHalves(checked, checked.mu0, share, share);
}

StreamConstants twoStreamConstants(const BeamInMedium& medium) {
  const BeamInMedium checked = detail::checkedMedium(medium);
  return uniformHalves(checked, 0.5, meanForwardShare(checked.asymmetry), forwardShare(checked.asymmetry, checked.mu0));
}

}  // namespace sunfleck::spp
