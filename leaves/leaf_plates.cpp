#include "leaves/leaf_plates.hpp"

#include <algorithm>
#include <boost/math/special_functions/expint.hpp>
#include <cmath>
#include <numbers>

namespace sunfleck {
namespace {

constexpr double kOpaque = 700.;                                 // of which e^-k is next to the smallest number
constexpr double kLitHalfAngle = 40. * std::numbers::pi / 180.;  // PROSPECT's, from Jacquemoud and Baret 1990

double squared(double x) {
  return x * x;
}

}  // namespace

double plateTransmittance(double absorption) {
  if (!(absorption > 0.)) return 1.;
  if (absorption > kOpaque) return 0.;
  // Of E_n the library has a fast form of E1 alone. What cancels here at large k is small beside 1.
  const double k = absorption;
  return std::clamp((1. - k) * std::exp(-k) + k * k * boost::math::expint(1, k), 0., 1.);
}

double faceTransmittance(double refractive_index, double half_angle) {
  const double n2 = squared(refractive_index), plus = n2 + 1., minus = n2 - 1.;
  const double sine2 = squared(std::sin(half_angle));
  const double a = 0.5 * squared(refractive_index + 1.), k = -0.25 * squared(minus);
  const double from_middle = sine2 - 0.5 * plus;
  // At 90 degrees the root is 0, of which rounding would leave the square root of itself.
  const double root = half_angle < 0.5 * std::numbers::pi ? std::sqrt(std::max(squared(from_middle) + k, 0.)) : 0.;
  const double b = root - from_middle;
  const auto across = [&](double x) { return squared(k) / (6. * x * x * x) + k / x - 0.5 * x; };
  const auto pole = [&](double x) { return 2. * plus * x - squared(minus); };
  const double plus3 = plus * plus * plus;
  const double in_plane = -2. * n2 * (b - a) / squared(plus) - 2. * n2 * plus * std::log(b / a) / squared(minus) +
                          0.5 * n2 * (1. / b - 1. / a) +
                          16. * n2 * n2 * (n2 * n2 + 1.) * std::log(pole(b) / pole(a)) / (plus3 * squared(minus)) +
                          16. * n2 * n2 * n2 * (1. / pole(b) - 1. / pole(a)) / plus3;
  return (across(b) - across(a) + in_plane) / (2. * sine2);
}

PlateFaces plateFaces(double refractive_index) {
  return {.inner = refractive_index,
          .lit = faceTransmittance(refractive_index, kLitHalfAngle),
          .diffuse = faceTransmittance(refractive_index, 0.5 * std::numbers::pi)};
}

LeafSides plates(const PlateFaces& faces, double transmittance, double plates) {
  const double tau = transmittance;
  const double out = faces.diffuse / squared(faces.inner), back = 1. - out;  // of light that meets a face from within
  const double through = out * tau / (1. - squared(back * tau));
  const double t = faces.diffuse * through, r = 1. - faces.diffuse + back * tau * t;
  const double lit_t = faces.lit * through, lit_r = 1. - faces.lit + back * tau * lit_t;
  // Of N - 1 plates R = sinh(m beta) / sinh(alpha + m beta), T = sinh(alpha) / sinh(alpha + m beta), with
  // sinh(alpha) = D / 2r, sinh(beta) = D / 2t and D^2 = (1 + r + t) (1 + r - t) (1 - r + t) (1 - r - t). The last
  // factor is what one plate absorbs: formed from 1 - tau it is not a difference of close numbers.
  const double absorbed = faces.diffuse * (1. - tau) / (1. - back * tau);
  const double more = plates - 1.;
  const double d = std::sqrt(std::max((1. + r + t) * (1. + r - t) * (1. - r + t) * absorbed, 0.));
  double pile_r = 0., pile_t = 1.;
  if (more > 0. && !(d > 0.)) {
    pile_r = more * r / (more * r + t);
    pile_t = t / (more * r + t);
  } else if (more > 0.) {
    const double alpha = std::asinh(0.5 * d / r);
    const double beta = t > 0. ? std::asinh(0.5 * d / t) : 1e300;
    const double deep = more * std::min(beta, 1e300);
    const double all = -std::expm1(-2. * (alpha + deep));
    pile_r = std::exp(-alpha) * -std::expm1(-2. * deep) / all;
    pile_t = std::exp(-deep) * -std::expm1(-2. * alpha) / all;
  }
  const double between = 1. - pile_r * r;
  LeafSides leaf{.reflectance = std::clamp(lit_r + lit_t * pile_r * t / between, 0., 1.),
                 .transmittance = std::max(lit_t * pile_t / between, 0.)};
  leaf.transmittance = std::min(leaf.transmittance, 1. - leaf.reflectance);
  return leaf;
}

}  // namespace sunfleck
