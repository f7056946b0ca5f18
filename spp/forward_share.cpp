#include "spp/forward_share.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

namespace sunfleck::spp {
namespace {

// Share of the light scattered by an angle of cosine >= c: the distribution function of Henyey & Greenstein.
double shareAbove(double g, double c) {
  if (std::abs(g) < 1e-9) return 0.5 * (1. - c);
  return (1. - g * g) / (2. * g) * (1. / (1. - g) - 1. / std::sqrt(1. + g * g - 2. * g * c));
}

}  // namespace

// Scattering by an angle of cosine c keeps all azimuths in the forward half if c >= sin(theta0), none if
// c <= -sin(theta0), and between them the share acos(-cot(theta0) c / sqrt(1 - c^2)) / pi. With c = sin(theta0) sin(t)
// that integrand is smooth up to the ends.
double forwardShare(double asymmetry, double mu0) {
  const double g = asymmetry;
  const double sine = std::sqrt(std::max(0., 1. - mu0 * mu0));
  const auto integrand = [&](double t) {
    const double c = sine * std::sin(t);
    const double density = 0.5 * (1. - g * g) / std::pow(1. + g * g - 2. * g * c, 1.5);
    const double ratio = sine > 0. ? mu0 * std::sin(t) / std::sqrt(1. - c * c) : 0.;
    return density * std::acos(std::clamp(-ratio, -1., 1.)) / std::numbers::pi * sine * std::cos(t);
  };
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  const double between = Quadrature::integrate(integrand, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi, 12, 1e-11);
  return std::clamp(shareAbove(g, sine) + between, 0., 1.);
}

// The mean is 1 - (integral of Theta p sin Theta dTheta); by parts it is a complete elliptic integral, K(g). Near g = 0
// its two terms cancel, and the series takes over, whose next term is below 1e-15.
double meanForwardShare(double asymmetry) {
  const double g = asymmetry;
  if (std::abs(g) < 0.01) return 0.5 + g * (3. / 8. + g * g * (7. / 128. + g * g * 11. / 512.));
  const double pi = std::numbers::pi;
  const double backward = (1. - g * g) / (2. * pi * g) * (2. * std::comp_ellint_1(std::abs(g)) - pi / (1. + g));
  return std::clamp(1. - backward, 0., 1.);
}

}  // namespace sunfleck::spp
