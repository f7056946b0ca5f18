#include "spp/stream_slab.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/require.hpp"
#include "spp/mode_numbers.hpp"

namespace sunfleck::spp {

namespace {

template <typename Real>
std::vector<Real> numbers(const std::vector<double>& values) {
  std::vector<Real> result;
  for (const double value : values) result.push_back(static_cast<Real>(value));
  return result;
}

template <typename Real>
Real atLeastZero(Real value) {
  return value > Real(0) ? value : Real(0);
}

}  // namespace

template <typename Real>
StreamSlab<Real>::StreamSlab(StreamConstants constants, Real thickness)
    : constants_(std::move(constants)),
      thickness_(thickness),
      depth_scale_(static_cast<Real>(constants_.depth_scale)),
      beam_rate_(static_cast<Real>(constants_.beam_rate)),
      mu0_(static_cast<Real>(constants_.beam.mu0)),
      beam_projection_(static_cast<Real>(constants_.beam_projection)) {
  require(thickness > Real(0), "thickness", thickness, "above 0");
  for (const StreamModes& modes : constants_.orders) addModes(modes);
  const PowerWeights weights = powerWeights(constants_);
  power_sum_ = numbers<Real>(weights.power_sum);
  power_difference_ = numbers<Real>(weights.power_difference);
  flux_sum_ = numbers<Real>(weights.flux_sum);
  met_sum_ = numbers<Real>(weights.met_sum);
  flux_difference_ = numbers<Real>(weights.flux_difference);
}

// As slabModes of stream_formulas.glsl, in double for both precisions and for any number of modes.
template <typename Real>
void StreamSlab<Real>::addModes(const StreamModes& modes) {
  using Eigen::Index;
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  using Precise = StreamFormulas<double>;
  const Index n = static_cast<Index>(modes.rate.size());
  const ModeCouplings couplings = modeCouplings(constants_, modes);
  const Matrix Q = Eigen::Map<const Matrix>(couplings.sum_of_difference.data(), n, n);
  const Matrix R = Eigen::Map<const Matrix>(couplings.difference_of_sum.data(), n, n);
  const double thickness = static_cast<double>(thickness_);
  const auto end = Precise::slabPlace(thickness, thickness, constants_.depth_scale, constants_.beam_rate);
  Vector tangent(n), squared_tangent(n), gained(n), even_source(n), odd_source(n);
  for (Index j = 0; j < n; ++j) {
    const std::size_t at = static_cast<std::size_t>(j);
    const double k = modes.rate[at], entering = modes.entering[at];
    const auto shapes = Precise::modeShapes(k, end);
    tangent[j] = shapes.half_tangent;
    squared_tangent[j] = k * (k * tangent[j]);
    gained[j] = modes.gain[at] * shapes.gained_through;
    even_source[j] = entering * (1. - end.direct_through) - k * gained[j];
    odd_source[j] = entering * (1. + end.direct_through) + k * gained[j];
  }
  const Matrix identity = Matrix::Identity(n, n);
  const Vector even = (identity + Q * squared_tangent.asDiagonal()).partialPivLu().solve(gained + Q * even_source);
  const Vector odd = (identity + R * tangent.asDiagonal()).partialPivLu().solve(odd_source - R * gained);
  for (Index j = 0; j < n; ++j) {
    const std::size_t at = static_cast<std::size_t>(j);
    modes_.push_back({.mode = {.rate = static_cast<Real>(modes.rate[at]),
                               .gain = static_cast<Real>(modes.gain[at]),
                               .entering = static_cast<Real>(modes.entering[at])},
                      .share = {.even = static_cast<Real>(-0.5 * even[j]), .odd = static_cast<Real>(0.5 * odd[j])}});
  }
}

template <typename Real>
typename StreamSlab<Real>::Formulas::SlabPlace StreamSlab<Real>::place(Real depth) const {
  return Formulas::slabPlace(depth, thickness_, depth_scale_, beam_rate_);
}

template <typename Real>
Real StreamSlab<Real>::reflectance() const {
  return light(Real(0)).flux_up / mu0_;
}

template <typename Real>
Real StreamSlab<Real>::transmittance() const {
  return light(thickness_).flux_down / mu0_;
}

template <typename Real>
SlabLight<Real> StreamSlab<Real>::light(Real depth) const {
  const auto at = place(depth);
  Real power_sum(0), power_difference(0), flux_sum(0), flux_difference(0), met_sum(0);
  for (std::size_t j = 0; j < power_sum_.size(); ++j) {
    const auto field =
        Formulas::modeField(modes_[j].mode, modes_[j].share, Formulas::modeShapes(modes_[j].mode.rate, at), at);
    power_sum += power_sum_[j] * field.sum;
    power_difference += power_difference_[j] * field.difference;
    met_sum += met_sum_[j] * field.sum;
    flux_sum += flux_sum_[j] * field.sum;
    flux_difference += flux_difference_[j] * field.difference;
  }
  // The direct light of the scaled medium holds what the forward peak added to it.
  return {.power_down = at.direct + atLeastZero(Real(0.5) * (power_sum + power_difference)),
          .power_up = atLeastZero(Real(0.5) * (power_sum - power_difference)),
          .flux_down = mu0_ * at.direct + atLeastZero(Real(0.5) * (flux_sum + flux_difference)),
          .flux_up = atLeastZero(Real(0.5) * (flux_sum - flux_difference)),
          .direct = std::exp(-beam_rate_ * (at.depth / depth_scale_)),
          .leaf_irradiance = beam_projection_ * at.direct + atLeastZero(met_sum)};
}

template <typename Real>
Real StreamSlab<Real>::refinedRadiance(Real depth, const View& view) const {
  const auto at = place(depth);
  const bool downward = view.cosine > Real(0);
  const Real fade = std::exp(-view.rate * (downward ? at.depth : at.rest));
  const Real beam =
      downward ? Formulas::beamAlongDownward(at, view.rate, fade) : Formulas::beamAlongUpward(at, view.rate, fade);
  Real radiance = view.beam_source * beam;
  assert(view.seen_sum.size() == modes_.size());
  for (std::size_t j = 0; j < modes_.size(); ++j) {
    const auto& [mode, share] = modes_[j];
    const auto shapes = Formulas::modeShapes(mode.rate, at);
    const auto mean = downward ? Formulas::modeAlongDownward(mode, share, shapes, at, view.rate, fade, beam)
                               : Formulas::modeAlongUpward(mode, share, shapes, at, view.rate, fade, beam);
    radiance += view.seen_sum[j] * mean.sum + view.seen_difference[j] * mean.difference;
  }
  return atLeastZero(radiance);
}

template <typename Real>
Real StreamSlab<Real>::streamRadiance(Real depth, int stream, bool downward, int order) const {
  const std::size_t n = constants_.cosines.size(), first = static_cast<std::size_t>(order) * n;
  const StreamModes& modes = constants_.orders[static_cast<std::size_t>(order)];
  const auto at = place(depth);
  Real sum(0), difference(0);
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t element = static_cast<std::size_t>(stream) * n + j;
    const auto& [mode, share] = modes_[first + j];
    const auto field = Formulas::modeField(mode, share, Formulas::modeShapes(mode.rate, at), at);
    sum += static_cast<Real>(modes.sum[element]) * field.sum;
    difference += static_cast<Real>(modes.difference[element]) * field.difference;
  }
  return Real(0.5) * (downward ? sum + difference : sum - difference);
}

template class StreamSlab<float>;
template class StreamSlab<double>;

}  // namespace sunfleck::spp
