#include "adding_doubling.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

namespace sunfleck::witness {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;

// sqrt((l - m)! / (l + m)!) P_l^m at every cosine (rows), l = 0 .. count - 1 (columns): the upward recurrence in l.
MatrixXd legendre(const ArrayXd& cosines, int count, int mode) {
  MatrixXd result = MatrixXd::Zero(cosines.size(), count);
  if (mode >= count) return result;
  ArrayXd first = ArrayXd::Ones(cosines.size());
  const ArrayXd sines = (1. - cosines.square()).max(0.).sqrt();
  for (int k = 1; k <= mode; ++k) first *= sines * std::sqrt((2. * k - 1.) / (2. * k));
  result.col(mode) = first;
  for (int l = mode + 1; l < count; ++l) {
    ArrayXd next = (2. * l - 1.) * cosines * result.col(l - 1).array();
    if (l > mode + 1) next -= std::sqrt(static_cast<double>(l - 1 - mode) * (l - 1 + mode)) * result.col(l - 2).array();
    result.col(l) = next / std::sqrt(static_cast<double>(l - mode) * (l + mode));
  }
  return result;
}

LayerKernels upsideDown(const LayerKernels& k) {
  return {k.direct, k.reflection_up, k.reflection, k.transmission_up, k.transmission};
}

}  // namespace

std::vector<double> henyeyGreensteinMoments(double asymmetry, double smallest) {
  std::vector<double> moments{1.};
  while (std::abs(moments.back() * asymmetry) > smallest) moments.push_back(moments.back() * asymmetry);
  return moments;
}

AddingDoubling::AddingDoubling(int nodes, std::span<const double> extra)
    : nodes_(nodes), cosines_(nodes + static_cast<int>(extra.size())), weights_(ArrayXd::Zero(cosines_.size())) {
  int i = 0;
  for (const double zero : boost::math::legendre_p_zeros<double>(nodes))
    for (const double sign : {-1., 1.}) {
      if (zero == 0. && sign < 0.) continue;
      const double slope = boost::math::legendre_p_prime(nodes, zero);
      const double x = 0.5 * (1. + sign * zero), dx = 1. / ((1. - zero * zero) * slope * slope);
      cosines_[i] = x * x;
      weights_[i] = 2. * cosines_[i] * 2. * x * dx;
      ++i;
    }
  for (const double mu : extra) cosines_[i++] = mu;
}

MatrixXd AddingDoubling::phaseMatrix(const std::vector<double>& moments, int mode, bool back) const {
  const MatrixXd polynomials = legendre(cosines_, static_cast<int>(moments.size()), mode);
  Eigen::VectorXd factors(polynomials.cols());
  for (int l = 0; l < factors.size(); ++l)
    factors[l] = (back && (l + mode) % 2 ? -1. : 1.) * (2. * l + 1.) * moments[static_cast<std::size_t>(l)];
  return polynomials * factors.asDiagonal() * polynomials.transpose();
}

LayerKernels AddingDoubling::layer(const ScatteringLayer& layer, int mode) const {
  const int doublings = std::max(0, static_cast<int>(std::ceil(std::log2(layer.thickness))) + 50);
  double thickness = std::ldexp(layer.thickness, -doublings);
  // Both exact single-scattering kernels are this, but for the square of thickness / mu, at most 1e-20.
  const ArrayXd path = (-0.5 * thickness / cosines_).exp() / cosines_;
  const MatrixXd once = 0.25 * layer.albedo * thickness * (path.matrix() * path.matrix().transpose());
  LayerKernels k;
  k.reflection = once.cwiseProduct(phaseMatrix(layer.moments, mode, true));
  k.transmission = once.cwiseProduct(phaseMatrix(layer.moments, mode, false));
  for (int i = 0; i < doublings; ++i) {
    k.direct = (-thickness / cosines_).exp();
    k.reflection_up = k.reflection;
    k.transmission_up = k.transmission;
    std::tie(k.reflection, k.transmission) = litFromAbove(k, k);
    thickness *= 2.;
  }
  k.direct = (-thickness / cosines_).exp();
  k.reflection_up = k.reflection;
  k.transmission_up = k.transmission;
  return k;
}

LayerKernels AddingDoubling::lambertianGround(double albedo, int mode) const {
  const MatrixXd none = MatrixXd::Zero(cosines_.size(), cosines_.size());
  return {ArrayXd::Zero(cosines_.size()), mode == 0 ? MatrixXd(none.array() + albedo) : none, none, none, none};
}

Interface AddingDoubling::between(const LayerKernels& above, const LayerKernels& below) const {
  const auto W = weights_.matrix().asDiagonal();
  const auto E = above.direct.matrix().asDiagonal();
  // Light that goes up and down again between the layers, once: S; any number of times: Q = S + S W S + ...
  const MatrixXd S = above.reflection_up * W * below.reflection;
  const MatrixXd Q = (MatrixXd::Identity(S.rows(), S.cols()) - S * W).partialPivLu().solve(S);
  Interface result;
  result.down = above.transmission + Q * E + Q * W * above.transmission;
  result.up = below.reflection * E + below.reflection * W * result.down;
  return result;
}

std::pair<MatrixXd, MatrixXd> AddingDoubling::litFromAbove(const LayerKernels& above, const LayerKernels& below) const {
  const auto W = weights_.matrix().asDiagonal();
  const Interface light = between(above, below);
  MatrixXd reflection = above.reflection + above.direct.matrix().asDiagonal() * light.up;
  reflection += above.transmission_up * W * light.up;
  MatrixXd transmission = below.direct.matrix().asDiagonal() * light.down;
  transmission += below.transmission * above.direct.matrix().asDiagonal();
  transmission += below.transmission * W * light.down;
  return {reflection, transmission};
}

LayerKernels AddingDoubling::add(const LayerKernels& above, const LayerKernels& below) const {
  LayerKernels both;
  both.direct = above.direct * below.direct;
  std::tie(both.reflection, both.transmission) = litFromAbove(above, below);
  std::tie(both.reflection_up, both.transmission_up) = litFromAbove(upsideDown(below), upsideDown(above));
  return both;
}

double AddingDoubling::flux(const MatrixXd& kernel, int column) const {
  return kernel.col(column).dot(weights_.matrix());
}

double AddingDoubling::flux(const MatrixXd& kernel) const {
  return weights_.matrix().dot(kernel * weights_.matrix());
}

namespace {

LayerKernels stackKernels(const AddingDoubling& method, const Stack& stack, int mode) {
  LayerKernels all = method.layer(stack.layers.front(), mode);
  for (std::size_t i = 1; i < stack.layers.size(); ++i) all = method.add(all, method.layer(stack.layers[i], mode));
  return all;
}

}  // namespace

StackFluxes stackFluxes(const Stack& stack, double mu0, int nodes) {
  const AddingDoubling method(nodes, {&mu0, 1});
  const LayerKernels layers = stackKernels(method, stack, 0), ground = method.lambertianGround(stack.ground_albedo, 0);
  const int beam = method.extraNode(0);
  return {.reflectance = method.flux(method.add(layers, ground).reflection, beam),
          .transmittance = method.flux(method.between(layers, ground).down, beam) + layers.direct[beam]};
}

StackRadiances stackRadiances(const Stack& stack, double mu0, std::span<const double> mus, std::span<const double> phis,
                              int nodes) {
  std::vector<double> extra{mu0};
  extra.insert(extra.end(), mus.begin(), mus.end());
  const AddingDoubling method(nodes, extra);
  std::size_t modes = 1;
  for (const ScatteringLayer& layer : stack.layers) modes = std::max(modes, layer.moments.size());
  StackRadiances result{std::vector<double>(mus.size() * phis.size()), std::vector<double>(mus.size() * phis.size())};
  for (int mode = 0; mode < static_cast<int>(modes); ++mode) {
    const LayerKernels layers = stackKernels(method, stack, mode);
    const LayerKernels ground = method.lambertianGround(stack.ground_albedo, mode);
    const MatrixXd up = method.add(layers, ground).reflection, down = method.between(layers, ground).down;
    for (std::size_t i = 0; i < mus.size(); ++i)
      for (std::size_t j = 0; j < phis.size(); ++j) {
        const int row = method.extraNode(1 + static_cast<int>(i)), beam = method.extraNode(0);
        const double factor = (mode == 0 ? 1. : 2.) * std::cos(mode * phis[j]) * mu0 * std::numbers::inv_pi;
        result.up_at_top[i * phis.size() + j] += factor * up(row, beam);
        result.down_at_bottom[i * phis.size() + j] += factor * down(row, beam);
      }
  }
  return result;
}

}  // namespace sunfleck::witness
