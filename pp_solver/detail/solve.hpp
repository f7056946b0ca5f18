#pragma once

#include "pp_solver/detail/dense.hpp"
#include "pp_solver/detail/singular_values.hpp"
#include "pp_solver/detail/stack.hpp"

namespace sunfleck::pp::SUNFLECK_ISA {

using detail::BasisRows;
using detail::LayerRows;
using detail::StackRows;

inline Vec* rows(double* p) {
  return reinterpret_cast<Vec*>(p);
}
inline const Vec* rows(const double* p) {
  return reinterpret_cast<const Vec*>(p);
}

// result += sum over j of weight[j] matrix[j]
template <typename S>
inline void addRows(Vec* result, const Vec* matrix, const S* weight, int n, int width) {
  for (int j = 0; j < n; ++j)
    for (int k = 0; k < width; ++k) result[k] += weight[j] * matrix[j * width + k];
}

// result[j] = matrix[j] . row
template <typename S>
inline void project(S* result, const Vec* matrix, const Vec* row, int n, int width) {
  for (int j = 0; j < n; ++j) result[j] = rowProduct<S>(matrix + j * width, row, n);
}

// (P4) omega chi_l sqrt(2 l + 1) Lambda_l^m(mu), carried from the true functions to the discrete ones: how much light
// of direction mu each q_l scatters, and receives.
//   even, odd  rows in the basis
template <typename S>
inline void scatterRows(const BasisRows& basis, const S* scatter, S mu, S first, Vec* even, Vec* odd) {
  const int n = basis.n, width = rowWidth<S>(n);
  const S *up = numbers<S>(rows(basis.up)), *down = numbers<S>(rows(basis.down)), *norm = numbers<S>(rows(basis.norm));
  for (int k = 0; k < width; ++k) even[k] = odd[k] = Vec{};
  S now = first, before{};
  for (int j = 0; j < 2 * n; ++j) {
    numbers<S>(j % 2 == 0 ? even : odd)[j / 2] = scatter[j] * norm[j] * now;
    const S next = up[j] * mu * now - down[j] * before;
    before = now;
    now = next;
  }
  // `rise` is upper triangular: in place, from the top
  for (int j = 0; j < n; ++j) {
    const S *er = numbers<S>(rows(basis.even_rise) + j * width), *od = numbers<S>(rows(basis.odd_rise) + j * width);
    S *e = numbers<S>(even), *o = numbers<S>(odd);
    S sum_e{}, sum_o{};
    for (int i = j; i < n; ++i) {
      sum_e += er[i] * e[i];
      sum_o += od[i] * o[i];
    }
    e[j] = sum_e;
    o[j] = sum_o;
  }
}

// (P3) Eigenmodes of a layer. Between the discrete Legendre functions the transfer equation without sources reads
//     T psi_odd' = -L_even psi_even,   T^T psi_even' = -L_odd psi_odd,
// L = 1 - omega chi_l diagonal, T bidiagonal (P2). The singular vectors V of L_even^-1/2 T L_odd^-1/2, singular values
// 1 / k_j, give y = L_odd^-1/2 V and, without a division by what is 0 in a conservative layer, x = T^-T L_odd y and
// k^2 = sum L_even x^2.
template <typename S>
inline void layerModes(const BasisRows& basis, LayerRows& layer, Vec* scratch) {
  const int n = basis.n, width = rowWidth<S>(n), stride = width * perVec<S>();
  S *d = numbers<S>(scratch), *e = numbers<S>(scratch + width), *c = numbers<S>(scratch + 2 * width),
    *s = numbers<S>(scratch + 3 * width), *even_root = numbers<S>(scratch + 4 * width),
    *odd_root = numbers<S>(scratch + 5 * width), *odd_inverse = numbers<S>(scratch + 6 * width),
    *alpha_inverse = numbers<S>(scratch + 7 * width);
  Vec* v = rows(layer.y);
  const S* loss = numbers<S>(rows(layer.loss));
  const S *alpha = numbers<S>(rows(basis.alpha)), *beta = numbers<S>(rows(basis.beta));
  for (int j = 0; j < n; ++j) {
    // A conservative layer's mode 0 stands alone; its singular value is infinite and not used.
    even_root[j] = root(S(maximum(loss[2 * j], S(S{} + 1e-300))));
    odd_root[j] = root(loss[2 * j + 1]);
    odd_inverse[j] = 1. / odd_root[j];
    alpha_inverse[j] = 1. / alpha[j];
    d[j] = alpha[j] / even_root[j] * odd_inverse[j];
  }
  const auto conservative = loss[0] == 0.;
  d[0] = select(conservative, S(S{} + 1.), d[0]);
  for (int j = 0; j + 1 < n; ++j) e[j] = beta[j] / even_root[j + 1] * odd_inverse[j];
  if (n > 1) e[0] = select(conservative, S{}, e[0]);
  for (int i = 0; i < n * width; ++i) v[i] = Vec{};
  for (int j = 0; j < n; ++j) numbers<S>(v)[j * stride + j] = S{} + 1.;
  singularValues<S>(n, d, e, v, width, c, s);

  const S* even_loss = loss;
  for (int j = 0; j < n; ++j) {
    S *x = numbers<S>(rows(layer.x)) + j * stride, *y = numbers<S>(rows(layer.y)) + j * stride;
    S next{}, square{};
    for (int i = n - 1; i >= 0; --i) {
      next = (odd_root[i] * y[i] - beta[i] * next) * alpha_inverse[i];
      x[i] = next;
      square += even_loss[2 * i] * next * next;
      y[i] = y[i] * odd_inverse[i];
    }
    numbers<S>(rows(layer.k2))[j] = square;
    numbers<S>(rows(layer.k))[j] = root(square);
  }
}

// The modes of a layer whose scattering is the same, taken over.
template <typename S>
inline bool takeModes(const BasisRows& basis, LayerRows& layer, const LayerRows& other) {
  const int n = basis.n, width = rowWidth<S>(n);
  if (layer.given_modes || other.given_modes) return false;
  const S *loss = numbers<S>(rows(layer.loss)), *other_loss = numbers<S>(rows(other.loss));
  for (int j = 0; j < 2 * n; ++j)
    if (!all(loss[j] == other_loss[j])) return false;
  const auto copy = [&](double* to, const double* from, int count) {
    for (int i = 0; i < count; ++i) rows(to)[i] = rows(from)[i];
  };
  copy(layer.x, other.x, n * width);
  copy(layer.y, other.y, n * width);
  copy(layer.x_hat, other.x_hat, n * width);
  copy(layer.y_hat, other.y_hat, n * width);
  copy(layer.k, other.k, width);
  copy(layer.k2, other.k2, width);
  copy(layer.x_flux, other.x_flux, width);
  copy(layer.y_flux, other.y_flux, width);
  return true;
}

// Node values of the modes, and what they carry.
template <typename S>
inline void modesAtNodes(const BasisRows& basis, LayerRows& layer) {
  const int n = basis.n, width = rowWidth<S>(n), stride = width * perVec<S>();
  Vec *x = rows(layer.x_hat), *y = rows(layer.y_hat);
  if (layer.given_modes) {
    for (int i = 0; i < n * width; ++i) {
      x[i] = rows(layer.x)[i];
      y[i] = rows(layer.y)[i];
    }
  } else {
    multiply<S>(x, numbers<S>(rows(layer.x)), rows(basis.even), n, n, width, stride, 1);
    multiply<S>(y, numbers<S>(rows(layer.y)), rows(basis.odd), n, n, width, stride, 1);
  }
  const Vec *mu_root = rows(basis.mu_root), *flat = rows(basis.flat);
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < width; ++k) {
      x[j * width + k] *= mu_root[k];
      y[j * width + k] *= mu_root[k];
    }
    numbers<S>(rows(layer.x_flux))[j] = rowProduct<S>(flat, x + j * width, n);
    numbers<S>(rows(layer.y_flux))[j] = rowProduct<S>(flat, y + j * width, n);
  }
}

// (P5) The beam's particular solution in the modes and each mode's way through the layer.
template <typename S>
inline void layerPassage(const BasisRows& basis, LayerRows& layer) {
  const int n = basis.n, width = rowWidth<S>(n);
  S *a = numbers<S>(rows(layer.a)), *b = numbers<S>(rows(layer.g));
  project<S>(a, rows(layer.y), rows(layer.odd_source), n, width);
  project<S>(b, rows(layer.x), rows(layer.even_source), n, width);
  const S rate = numbers<S>(rows(layer.rate))[0], thickness = numbers<S>(rows(layer.thickness))[0];
  for (int k = 0; k < width; ++k) {
    const Vec kj = rows(layer.k)[k];
    rows(layer.g)[k] = (rows(layer.g)[k] + rows(layer.a)[k] * rate) / (rate + kj);
    if (layer.infinite) {
      rows(layer.through)[k] = Vec{};
      continue;
    }
    const Vec x = kj * thickness, through = decay(x);
    rows(layer.through)[k] = through;
    rows(layer.s)[k] = thickness * relax(x, through) / (1. + through);
    rows(layer.t)[k] = rows(layer.k2)[k] * rows(layer.s)[k];
  }
}

// Particular solution at the layer's ends: S at the bottom, D at the top and at the bottom, as hats over the nodes; and
// S at the top, which only emission has.
template <typename S>
inline void particular(const BasisRows& basis, const LayerRows& layer, Vec* modes, Vec* s_top, Vec* d_top,
                       Vec* s_bottom, Vec* d_bottom) {
  const int n = basis.n, width = rowWidth<S>(n);
  const S rate = numbers<S>(rows(layer.rate))[0], thickness = numbers<S>(rows(layer.thickness))[0];
  const S planck_top = numbers<S>(rows(layer.planck_top))[0], planck_bottom = numbers<S>(rows(layer.planck_bottom))[0];
  for (int k = 0; k < width; ++k) {
    s_top[k] = 2. * planck_top * rows(basis.flat)[k];
    s_bottom[k] = 2. * planck_bottom * rows(basis.flat)[k];
    d_top[k] = d_bottom[k] = 2. * rows(layer.drift)[k];
  }
  Vec* work = modes;
  for (int k = 0; k < width; ++k) work[k] = rows(layer.a)[k] - rows(layer.g)[k];
  addRows<S>(d_top, rows(layer.y_hat), numbers<S>(work), n, width);
  if (layer.infinite) return;
  const Vec beam = decay(Vec(Vec{} + rate * thickness)), depth = Vec{} + thickness, kappa = Vec{} + rate;
  Vec* bottom = modes + width;
  for (int k = 0; k < width; ++k) {
    const Vec kj = rows(layer.k)[k], gd = rows(layer.g)[k] * difference(kj, kappa, depth, rows(layer.through)[k], beam);
    bottom[k] = gd;
    work[k] = work[k] * beam + gd * kj;
  }
  addRows<S>(s_bottom, rows(layer.x_hat), numbers<S>(bottom), n, width);
  addRows<S>(d_bottom, rows(layer.y_hat), numbers<S>(work), n, width);
}

}  // namespace sunfleck::pp::SUNFLECK_ISA
