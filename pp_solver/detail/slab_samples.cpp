#include "pp_solver/detail/slab_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pp_solver/detail/slab_table_data.hpp"

namespace sunfleck::pp::detail {
namespace {

constexpr double kPi = std::numbers::pi;

// Gauss's rule on 0 .. 1 for the root of the cosine.
DoubleGauss gradedRule(int nodes) {
  DoubleGauss rule = doubleGauss(2 * nodes);
  for (std::size_t i = 0; i < rule.mu.size(); ++i) {
    rule.weight[i] *= 2. * rule.mu[i];
    rule.mu[i] *= rule.mu[i];
  }
  return rule;
}

}  // namespace

std::vector<double> azimuthsFor(int count) {
  std::vector<double> azimuths(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) azimuths[static_cast<std::size_t>(k)] = kPi * (k + 0.5) / count;
  return azimuths;
}

Views viewsOf(const Medium& medium, double mu0, std::vector<double> cosines, std::vector<double> azimuths) {
  Views views{mu0, std::move(cosines), std::move(azimuths), {}, {}};
  for (const double mu : views.cosines) views.rates.push_back(extinction(medium, mu) / mu);
  for (const double sign : {1., -1.})
    for (const double mu : views.cosines)
      for (const double azimuth : views.azimuths)
        views.turned.push_back(scatteredInto(medium, sign * mu, mu0, azimuth));
  return views;
}

PowerViews powerViewsOf(const Medium& medium, double mu0, int once_nodes, int rest_nodes, int azimuths) {
  PowerViews views{gradedRule(once_nodes), gradedRule(rest_nodes), {}, {}, {}};
  const std::vector<double>& cosines = views.once_rule.mu;
  if (const auto* leaves = std::get_if<LeafScattering>(&medium)) {
    const LeafProjections out(leaves->angles, cosines), in(leaves->angles, {&mu0, 1});
    LeafKernel kernel;  // (P21), mode 0
    fillLeafKernel(out, in, kernel);
    std::vector<double> even(cosines.size()), odd(cosines.size());
    kernel.evenOdd(leaves->reflectance, leaves->transmittance, even, odd);
    for (std::size_t i = 0; i < cosines.size(); ++i) views.once_rates.push_back(out.projection(i) / cosines[i]);
    for (const double sign : {1., -1.})
      for (std::size_t i = 0; i < cosines.size(); ++i) views.turned.push_back((even[i] + sign * odd[i]) / (4. * kPi));
  } else {
    // As many azimuths as a series that the nodes resolve has modes.
    const Views once = viewsOf(medium, mu0, cosines, azimuthsFor(2 * once_nodes));
    views.once_rates = once.rates;
    for (std::size_t i = 0; i < 2 * cosines.size(); ++i) {
      double sum = 0.;
      for (std::size_t k = 0; k < once.azimuths.size(); ++k) sum += once.turned[i * once.azimuths.size() + k];
      views.turned.push_back(sum / static_cast<double>(once.azimuths.size()));
    }
  }
  views.rest = viewsOf(medium, mu0, views.rest_rule.mu, azimuthsFor(azimuths));
  return views;
}

SlabSampler::SlabSampler(const Medium& medium, int streams, double azimuth_tolerance)
    : medium_(medium), solver_({.streams = streams, .azimuth_tolerance = azimuth_tolerance}) {}

void SlabSampler::solve(double thickness, double mu0) {
  Problem problem;
  problem.layers.push_back({.thickness = thickness, .medium = medium_});
  problem.beam = Beam{.mu0 = mu0};
  solver_.solve(problem);
  thickness_ = thickness;
  rate0_ = extinction(medium_, mu0) / mu0;
}

void SlabSampler::radiances(const Views& views, std::span<const double> depths, std::vector<double>& result) {
  const std::size_t n = views.cosines.size(), azimuths = views.azimuths.size();
  signed_.clear();
  for (const double sign : {1., -1.})
    for (const double mu : views.cosines) signed_.push_back(sign * mu);
  radiances_.resize(depths.size() * 2 * n * azimuths);
  solver_.radiances(depths, signed_, views.azimuths, radiances_);
  result.resize(radiances_.size());
  for (std::size_t half = 0; half < 2; ++half)
    for (std::size_t d = 0; d < depths.size(); ++d)
      std::copy_n(radiances_.begin() + static_cast<std::ptrdiff_t>((d * 2 + half) * n * azimuths), n * azimuths,
                  result.begin() + static_cast<std::ptrdiff_t>((half * depths.size() + d) * n * azimuths));
}

void SlabSampler::sources(const Views& views, std::span<const double> depths, std::vector<double>& result) {
  const std::size_t n = views.cosines.size(), modes = views.azimuths.size();
  inner_.clear();
  for (const double depth : depths)
    inner_.push_back(std::clamp(depth, kLeastShare * thickness_, (1. - kLeastShare) * thickness_));
  radiances(views, inner_, sources_);
  result.assign(sources_.size(), 0.);
  for (std::size_t half = 0, at = 0; half < 2; ++half)
    for (const double depth : inner_)
      for (std::size_t i = 0; i < n; ++i, at += modes) {
        const double m = views.rates[i], path = half ? thickness_ - depth : depth;
        const double once =
            (half ? onceUp(rate0_, m, depth, thickness_) : onceDown(rate0_, m, depth)) / views.cosines[i];
        const double share = -std::expm1(-m * path);
        if (!(share > 0.)) continue;  // nothing lies in the way, not even edge-on
        for (std::size_t k = 0; k < modes; ++k) {
          const double turned = views.turned[(half * n + i) * modes + k];
          const double rest = (sources_[at + k] - turned * once) / share / static_cast<double>(modes);
          for (std::size_t m_ = 0; m_ < modes; ++m_)
            result[at + m_] += (m_ ? 2. : 1.) * rest * std::cos(static_cast<double>(m_) * views.azimuths[k]);
        }
      }
}

void SlabSampler::powers(const PowerViews& views, std::span<const double> depths, std::vector<double>& result) {
  std::vector<double> rest;
  sources(views.rest, depths, rest);
  result.assign(2 * depths.size(), 0.);
  const std::size_t n = views.rest.cosines.size(), modes = views.rest.azimuths.size(), peak = views.once_rates.size();
  for (std::size_t half = 0; half < 2; ++half)
    for (std::size_t d = 0; d < depths.size(); ++d) {
      const double path = half ? thickness_ - depths[d] : depths[d];
      double sum = 0.;
      for (std::size_t i = 0; i < n; ++i)
        sum -= views.rest_rule.weight[i] * std::expm1(-views.rest.rates[i] * path) *
               rest[((half * depths.size() + d) * n + i) * modes];
      for (std::size_t i = 0; i < peak; ++i) {
        const double m = views.once_rates[i];
        const double once = half ? onceUp(rate0_, m, depths[d], thickness_) : onceDown(rate0_, m, depths[d]);
        sum += views.once_rule.weight[i] / views.once_rule.mu[i] * once * views.turned[half * peak + i];
      }
      result[2 * d + half] = 2. * kPi * sum;
    }
}

}  // namespace sunfleck::pp::detail
