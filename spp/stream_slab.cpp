#include "spp/stream_slab.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/require.hpp"

namespace sunfleck::spp {

// The formulas in both precisions, told apart by their arguments.
using precise::beamAlongDownward;
using precise::beamAlongUpward;
using precise::halfTangent;
using precise::modeAlongDownward;
using precise::modeAlongUpward;
using precise::modeField;
using precise::rateQuotient;

namespace {

// As good as infinite: squared it still is a number of single precision.
constexpr double kInfiniteThickness = 1e15;

template <typename Real>
Real atLeastZero(Real value) {
  return value > Real(0) ? value : Real(0);
}

}  // namespace

template <typename Real>
StreamSlab<Real>::StreamSlab(StreamConstants constants, Real thickness)
    : constants_(std::move(constants)),
      depth_scale_(static_cast<Real>(constants_.depth_scale)),
      beam_rate_(static_cast<Real>(constants_.beam_rate)),
      mu0_(static_cast<Real>(constants_.beam.mu0)),
      beam_projection_(static_cast<Real>(constants_.beam_projection)) {
  require(thickness > Real(0), "thickness", thickness, "above 0");
  thickness_ = std::min(thickness * depth_scale_, static_cast<Real>(kInfiniteThickness));
  for (const StreamModes& modes : constants_.orders) addModes(modes);

  const StreamModes& mean = constants_.orders.front();
  const std::size_t n = mean.rate.size();
  for (std::size_t j = 0; j < n; ++j) {
    double power_sum = 0., power_difference = 0., flux_sum = 0., flux_difference = 0., met_sum = 0.;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = constants_.solid_angles[i], cosine = constants_.cosines[i];
      power_sum += angle * mean.sum[i * n + j];
      power_difference += angle * mean.difference[i * n + j];
      met_sum += angle * constants_.projections[i] * mean.sum[i * n + j];
      flux_sum += angle * cosine * mean.sum[i * n + j];
      flux_difference += angle * cosine * mean.difference[i * n + j];
    }
    power_sum_.push_back(static_cast<Real>(power_sum));
    power_difference_.push_back(static_cast<Real>(power_difference));
    met_sum_.push_back(static_cast<Real>(met_sum));
    flux_sum_.push_back(static_cast<Real>(flux_sum));
    flux_difference_.push_back(static_cast<Real>(flux_difference));
  }
}

// No diffuse light enters: sum + difference = 0 at the lit face, sum - difference = 0 at the other, for each stream.
// Adding and subtracting the two parts what is symmetric about the middle from what is antisymmetric.
template <typename Real>
void StreamSlab<Real>::addModes(const StreamModes& modes) {
  using Eigen::Index;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Index n = static_cast<Index>(modes.rate.size());
  const Matrix X = Eigen::Map<const Rows>(modes.sum.data(), n, n).template cast<Real>();
  const Matrix Y = Eigen::Map<const Rows>(modes.difference.data(), n, n).template cast<Real>();
  const Real direct = std::exp(-beam_rate_ * thickness_);
  Vector tangent(n), squared_tangent(n), gained(n), first(n), last(n);
  for (Index j = 0; j < n; ++j) {
    const std::size_t at = static_cast<std::size_t>(j);
    const Real k = static_cast<Real>(modes.rate[at]), gain = static_cast<Real>(modes.gain[at]);
    tangent[j] = halfTangent(k, thickness_);
    squared_tangent[j] = k * (k * tangent[j]);
    gained[j] = gain * rateQuotient(k, beam_rate_, thickness_);
    first[j] = static_cast<Real>(modes.odd_source[at]) - gain;
    last[j] = first[j] * direct + k * gained[j];
  }
  const Vector at_lit_face = Y * first, at_other_face = X * gained - Y * last;
  const Vector even =
      (X + Y * squared_tangent.asDiagonal()).partialPivLu().solve(Real(-0.5) * (at_lit_face + at_other_face));
  const Vector odd = (X * tangent.asDiagonal() + Y).partialPivLu().solve(Real(0.5) * (at_lit_face - at_other_face));
  for (Index j = 0; j < n; ++j) {
    const std::size_t at = static_cast<std::size_t>(j);
    modes_.push_back({.mode = {.rate = static_cast<Real>(modes.rate[at]),
                               .odd_source = static_cast<Real>(modes.odd_source[at]),
                               .gain = static_cast<Real>(modes.gain[at])},
                      .even = even[j],
                      .odd = odd[j]});
  }
}

template <typename Real>
Real StreamSlab<Real>::scaledDepth(Real depth) const {
  return depth > Real(0) ? std::min(depth * depth_scale_, thickness_) : Real(0);
}

template <typename Real>
Real StreamSlab<Real>::reflectance() const {
  return light(Real(0)).flux_up / mu0_;
}

template <typename Real>
Real StreamSlab<Real>::transmittance() const {
  return light(thickness_ / depth_scale_).flux_down / mu0_;
}

template <typename Real>
SlabLight<Real> StreamSlab<Real>::light(Real depth) const {
  const Real z = scaledDepth(depth);
  Real power_sum(0), power_difference(0), flux_sum(0), flux_difference(0), met_sum(0);
  for (std::size_t j = 0; j < power_sum_.size(); ++j) {
    const auto field = modeField(modes_[j], z, thickness_, beam_rate_);
    power_sum += power_sum_[j] * field.sum;
    power_difference += power_difference_[j] * field.difference;
    met_sum += met_sum_[j] * field.sum;
    flux_sum += flux_sum_[j] * field.sum;
    flux_difference += flux_difference_[j] * field.difference;
  }
  const Real direct = std::exp(-beam_rate_ * z);  // with what the forward peak added to it
  return {.power_down = direct + atLeastZero(Real(0.5) * (power_sum + power_difference)),
          .power_up = atLeastZero(Real(0.5) * (power_sum - power_difference)),
          .flux_down = mu0_ * direct + atLeastZero(Real(0.5) * (flux_sum + flux_difference)),
          .flux_up = atLeastZero(Real(0.5) * (flux_sum - flux_difference)),
          .direct = std::exp(-beam_rate_ * (z / depth_scale_)),
          .leaf_irradiance = beam_projection_ * direct + atLeastZero(met_sum)};
}

template <typename Real>
typename StreamSlab<Real>::View StreamSlab<Real>::view(double mu, double azimuth) const {
  const BeamInMedium& beam = constants_.beam;
  const double cosine = std::clamp(std::abs(mu), kLeastCosine, 1.);
  const ViewKernel kernel = constants_.viewKernel(cosine);
  const double per_extinction = kernel.extinction > 0. ? 1. / kernel.extinction : 0.;
  const double source = per_extinction * scatteredInto(beam.medium, mu, beam.mu0, azimuth);
  View result{.cosine = static_cast<Real>(mu),
              .rate = static_cast<Real>(kernel.extinction / (constants_.depth_scale * cosine)),
              .beam_source = static_cast<Real>(source)};
  for (std::size_t m = 0; m < constants_.orders.size(); ++m) {
    const StreamModes& modes = constants_.orders[m];
    const double wave = std::cos(static_cast<double>(m) * azimuth), side = mu > 0. ? wave : -wave;
    for (std::size_t j = 0, n = modes.rate.size(); j < n; ++j) {
      double sum = 0., difference = 0.;
      for (std::size_t i = 0; i < n; ++i) {
        sum += kernel.sum[m][i] * modes.sum[i * n + j];
        difference += kernel.difference[m][i] * modes.difference[i * n + j];
      }
      result.seen_sum.push_back(static_cast<Real>(wave * sum));
      result.seen_difference.push_back(static_cast<Real>(side * difference));
    }
  }
  return result;
}

template <typename Real>
Real StreamSlab<Real>::refinedRadiance(Real depth, const View& view) const {
  const Real z = scaledDepth(depth), rate = view.rate;
  const bool downward = view.cosine > Real(0);
  Real radiance = view.beam_source * (downward ? beamAlongDownward(z, beam_rate_, rate)
                                               : beamAlongUpward(z, thickness_, beam_rate_, rate));
  assert(view.seen_sum.size() == modes_.size());
  for (std::size_t j = 0; j < modes_.size(); ++j) {
    const auto mean = downward ? modeAlongDownward(modes_[j], z, thickness_, beam_rate_, rate)
                               : modeAlongUpward(modes_[j], z, thickness_, beam_rate_, rate);
    radiance += view.seen_sum[j] * mean.sum + view.seen_difference[j] * mean.difference;
  }
  return atLeastZero(radiance);
}

template <typename Real>
Real StreamSlab<Real>::streamRadiance(Real depth, int stream, bool downward, int order) const {
  const std::size_t n = constants_.cosines.size(), first = static_cast<std::size_t>(order) * n;
  const StreamModes& modes = constants_.orders[static_cast<std::size_t>(order)];
  const Real z = scaledDepth(depth);
  Real sum(0), difference(0);
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t at = static_cast<std::size_t>(stream) * n + j;
    const auto field = modeField(modes_[first + j], z, thickness_, beam_rate_);
    sum += static_cast<Real>(modes.sum[at]) * field.sum;
    difference += static_cast<Real>(modes.difference[at]) * field.difference;
  }
  return Real(0.5) * (downward ? sum + difference : sum - difference);
}

template class StreamSlab<float>;
template class StreamSlab<double>;

}  // namespace sunfleck::spp
