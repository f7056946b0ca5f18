#include "chandrasekhar_h.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace sunfleck::witness {

ChandrasekharH::ChandrasekharH(double albedo) : albedo_(albedo) {
  // mu = x^3 turns mu log(mu), which H has at 0, into a function that Gauss's rule integrates to rounding.
  using Rule = boost::math::quadrature::gauss<double, 64>;
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i)
    for (const double sign : {-1., 1.}) {
      const double x = 0.5 * (1. + sign * Rule::abscissa()[i]);
      cosines_.push_back(x * x * x);
      weights_.push_back(0.5 * Rule::weights()[i] * 3. * x * x);
    }
  values_.assign(cosines_.size(), 1.);
  // An error that is a multiple of H changes its sign and, at albedo 1, keeps its size from step to step: the mean of
  // two steps is without it, and halves all others at least.
  double change = 1.;
  for (int step = 0; step < 100 && change > 1e-15; ++step) {
    std::vector<double> next;
    change = 0.;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      next.push_back(0.5 * (values_[i] + (*this)(cosines_[i])));
      change = std::max(change, std::abs(next[i] - values_[i]));
    }
    values_ = next;
  }
}

double ChandrasekharH::operator()(double mu) const {
  double integral = 0.;
  for (std::size_t i = 0; i < cosines_.size(); ++i)
    integral += weights_[i] * cosines_[i] * values_[i] / (mu + cosines_[i]);
  return 1. / (std::sqrt(1. - albedo_) + 0.5 * albedo_ * integral);
}

double ChandrasekharH::reflectance(double mu0) const {
  return 1. - std::sqrt(1. - albedo_) * (*this)(mu0);
}

double ChandrasekharH::radiance(double mu, double mu0) const {
  return 0.25 * std::numbers::inv_pi * albedo_ * mu0 / (mu + mu0) * (*this)(mu) * (*this)(mu0);
}

}  // namespace sunfleck::witness
