#include "scattering/phase_function.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr double kSphere = 4. * std::numbers::pi;

double series(const std::vector<double>& moments, double x) {
  double sum = 0., now = 1., before = 0.;
  for (size_t l = 0; l < moments.size(); ++l) {
    const double order = static_cast<double>(l);
    sum += (2. * order + 1.) * moments[l] * now;
    const double next = ((2. * order + 1.) * x * now - order * before) / (order + 1.);
    before = now;
    now = next;
  }
  return sum / kSphere;
}

}  // namespace

PhaseFunction PhaseFunction::henyeyGreenstein(double asymmetry) {
  require(asymmetry > -1. && asymmetry < 1., "g", asymmetry, "in (-1, 1)");
  PhaseFunction phase;
  phase.asymmetry_ = asymmetry;
  return phase;
}

PhaseFunction PhaseFunction::fromMoments(std::vector<double> moments) {
  while (moments.size() > 1 && moments.back() == 0.) moments.pop_back();
  PhaseFunction phase;
  if (moments.empty()) return phase;
  require(std::abs(moments[0] - 1.) <= 1e-12, "moment 0", moments[0], "1");
  moments[0] = 1.;
  for (size_t l = 1; l < moments.size(); ++l)
    require(std::abs(moments[l]) < 1., "moment " + std::to_string(l), moments[l], "above -1 and below 1");
  // Twice as many places as the series has waves.
  const int places = 4 * static_cast<int>(moments.size()) + 8;
  for (int i = 0; i <= places; ++i) {
    const double x = std::cos(std::numbers::pi * i / places), value = series(moments, x) * kSphere;
    require(value >= -1e-3, "phase function of these moments at cosine " + std::to_string(x), value, "no less than 0");
  }
  if (moments.size() > 1) phase.moments_ = std::move(moments);
  return phase;
}

PhaseFunction PhaseFunction::sampled(std::vector<double> cosines, std::vector<double> values) {
  require(cosines.size() >= 2 && cosines.size() == values.size(), "number of phase function samples", values.size(),
          "that of the cosines, two or more");
  require(cosines.front() == -1., "first cosine", cosines.front(), "-1");
  require(cosines.back() == 1., "last cosine", cosines.back(), "1");
  double integral = 0.;
  for (size_t i = 0; i < values.size(); ++i) {
    require(std::isfinite(values[i]) && values[i] >= 0., "phase function sample", values[i],
            "finite and no less than 0");
    if (i == 0) continue;
    require(cosines[i] > cosines[i - 1], "cosine", cosines[i], "above the one before");
    integral += 0.5 * (values[i] + values[i - 1]) * (cosines[i] - cosines[i - 1]);
  }
  require(integral > 0. && std::isfinite(integral), "integral of the phase function", integral, "finite and above 0");
  for (double& value : values) value /= 2. * std::numbers::pi * integral;
  PhaseFunction phase;
  phase.cosines_ = std::move(cosines);
  phase.values_ = std::move(values);
  // Each piece is a straight line times P_l, whose waves 30 points resolve when the piece is cut as finely.
  constexpr int kOrders = 513;
  phase.moments_.assign(kOrders, 0.);
  using Gauss = boost::math::quadrature::gauss<double, 30>;
  for (size_t i = 1; i < phase.cosines_.size(); ++i) {
    const double from = phase.cosines_[i - 1], to = phase.cosines_[i];
    const int parts = 1 + static_cast<int>((std::acos(from) - std::acos(to)) * kOrders / 20.);
    for (int part = 0; part < parts; ++part) {
      // equal in angle, as the waves of P_l are
      const double angle0 = std::acos(from) + (std::acos(to) - std::acos(from)) * part / parts;
      const double angle1 = std::acos(from) + (std::acos(to) - std::acos(from)) * (part + 1) / parts;
      const double a = part == 0 ? from : std::cos(angle0), b = part + 1 == parts ? to : std::cos(angle1);
      const auto add = [&](double x, double weight) {
        double now = 1., before = 0.;
        const double p = phase(x) * weight * 2. * std::numbers::pi;
        for (int l = 0; l < kOrders; ++l) {
          phase.moments_[l] += p * now;
          const double next = ((2. * l + 1.) * x * now - l * before) / (l + 1.);
          before = now;
          now = next;
        }
      };
      for (size_t q = 0; q < Gauss::abscissa().size(); ++q) {
        const double x = Gauss::abscissa()[q], weight = 0.5 * (b - a) * Gauss::weights()[q];
        add(0.5 * (a + b) + 0.5 * (b - a) * x, weight);
        add(0.5 * (a + b) - 0.5 * (b - a) * x, weight);
      }
    }
  }
  for (int l = kOrders - 1; l >= 0; --l) phase.moments_[l] /= phase.moments_[0];
  return phase;
}

double PhaseFunction::operator()(double cosine) const {
  if (!cosines_.empty()) {
    const auto above = std::upper_bound(cosines_.begin() + 1, cosines_.end() - 1, cosine);
    const size_t i = static_cast<size_t>(above - cosines_.begin());
    const double share = (cosine - cosines_[i - 1]) / (cosines_[i] - cosines_[i - 1]);
    return values_[i - 1] + std::clamp(share, 0., 1.) * (values_[i] - values_[i - 1]);
  }
  if (!moments_.empty()) return series(moments_, cosine);
  const double g = asymmetry_, base = (1. - g) * (1. - g) + 2. * g * (1. - cosine);
  return (1. - g * g) / (kSphere * base * std::sqrt(base));
}

void PhaseFunction::moments(std::span<double> moments) const {
  double power = 1.;
  for (size_t l = 0; l < moments.size(); ++l) {
    moments[l] = moments_.empty() ? power : l < moments_.size() ? moments_[l] : 0.;
    power *= asymmetry_;
  }
}

int PhaseFunction::orders() const {
  if (!cosines_.empty()) return kNoEnd;
  if (!moments_.empty()) return static_cast<int>(moments_.size());
  return asymmetry_ == 0. ? 1 : kNoEnd;
}

std::optional<double> PhaseFunction::henyeyGreensteinAsymmetry() const {
  if (moments_.empty()) return asymmetry_;
  return std::nullopt;
}

}  // namespace sunfleck
