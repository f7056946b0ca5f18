#include "spp/stream_constants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scattering/double_gauss.hpp"
#include "spp/detail/checked_beam.hpp"
#include "spp/detail/stream_system.hpp"
#include "spp/forward_share.hpp"

namespace sunfleck::spp {
namespace {

constexpr double kPi = std::numbers::pi;

double projectionOf(const Medium& medium, double extinction) {
  return std::holds_alternative<LeafScattering>(medium) ? extinction : 0.5;
}

// One stream for the power of each half.
//   mean_cosine    flux over power
//   mean_extinction  power met per depth over power
//   forward_share  of the diffuse light
StreamConstants uniformHalves(const BeamInMedium& beam, double mean_cosine, double mean_extinction,
                              double forward_share) {
  const double omega = singleScatteringAlbedo(beam.medium), extinct = extinction(beam.medium, beam.mu0);
  const auto net = [omega](double share) { return std::min(omega * (2. * share - 1.), detail::kMostForward); };
  const auto alone = [](double value) { return Eigen::VectorXd::Constant(1, value); };
  const double met = 0.5 / kPi * extinct;
  StreamConstants constants{.beam = beam,
                            .beam_rate = extinct / beam.mu0,
                            .cosines = {mean_cosine},
                            .solid_angles = {2. * kPi},
                            .projections = {projectionOf(beam.medium, mean_extinction)},
                            .beam_projection = projectionOf(beam.medium, extinct),
                            .uniform_halves = true};
  constants.orders.push_back(*detail::streamModes({.cosines = alone(mean_cosine),
                                                   .weights = alone(1.),
                                                   .extinction = alone(mean_extinction),
                                                   .even = alone(mean_extinction * omega),
                                                   .odd = alone(mean_extinction * net(forward_share)),
                                                   .even_source = alone(met * omega),
                                                   .odd_source = alone(met * net(forwardShare(beam.medium, beam.mu0))),
                                                   .beam_rate = constants.beam_rate,
                                                   .albedo = omega,
                                                   .lost = 1. - omega}));
  return constants;
}

// Integral of mu / G(mu) over (0, 1), Sellers 1985. Gauss's rule is right to 1e-6 where G has a kink, else to rounding.
double meanCosineOverExtinction(const LeafAngles& angles) {
  const DoubleGauss gauss = doubleGauss(64);
  double sum = 0.;
  for (std::size_t i = 0; i < gauss.mu.size(); ++i)
    sum += gauss.weight[i] * gauss.mu[i] / leafProjection(angles, gauss.mu[i]);
  return sum;
}

}  // namespace

ViewKernel StreamConstants::viewKernel(double mu) const {
  if (uniform_halves) {
    const double half = 0.5 * singleScatteringAlbedo(beam.medium);
    return {.extinction = extinction(beam.medium, mu),
            .sum = {{half}},
            .difference = {{half * (2. * forwardShare(beam.medium, mu) - 1.)}}};
  }
  const std::size_t n = cosines.size();
  ViewKernel view;
  if (const auto* scatterers = std::get_if<LeafScattering>(&beam.medium)) {
    LeafProjections projections_of_view(scatterers->angles, std::span(&mu, 1));
    view.extinction = projections_of_view.projection(0);
    LeafKernel kernel;
    for (std::size_t m = 0; m < orders.size(); ++m) {
      std::vector<double> even(n), odd(n);
      projections_of_view.setMode(static_cast<int>(m));
      fillLeafKernel(projections_of_view, leaves[m], kernel);
      kernel.evenOdd(scatterers->reflectance, scatterers->transmittance, even, odd);
      for (std::size_t i = 0; i < n; ++i) {
        const double factor = view.extinction > 0. ? 0.25 / kPi * solid_angles[i] / view.extinction : 0.;
        even[i] *= factor;
        odd[i] *= factor;
      }
      view.sum.push_back(std::move(even));
      view.difference.push_back(std::move(odd));
    }
    return view;
  }
  std::vector<double> functions;
  for (std::size_t m = 0; m < orders.size(); ++m) {
    std::vector<double> even(n), odd(n);
    functions.resize(2 * n - m);
    legendreFunctions(static_cast<int>(m), mu, functions);
    for (std::size_t r = 0; r < functions.size(); ++r)
      for (std::size_t i = 0; i < n; ++i) (r % 2 == 0 ? even : odd)[i] += functions[r] * moments[m][r * n + i];
    view.sum.push_back(std::move(even));
    view.difference.push_back(std::move(odd));
  }
  return view;
}

StreamConstants sppConstants(const BeamInMedium& beam) {
  const BeamInMedium checked = detail::checkedBeam(beam);
  return uniformHalves(checked, checked.mu0, extinction(checked.medium, checked.mu0),
                       forwardShare(checked.medium, checked.mu0));
}

StreamConstants twoStreamConstants(const BeamInMedium& beam) {
  const BeamInMedium checked = detail::checkedBeam(beam);
  const auto* leaves = std::get_if<LeafScattering>(&checked.medium);
  const double mean_extinction = leaves ? 0.5 : 1.;  // the integral of G over (0, 1) is 1/2
  const double mean_cosine = leaves ? mean_extinction * meanCosineOverExtinction(leaves->angles) : 0.5;
  return uniformHalves(checked, mean_cosine, mean_extinction, meanForwardShare(checked.medium));
}

}  // namespace sunfleck::spp
