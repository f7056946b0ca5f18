#pragma once

#include "pp_solver/detail/solve.hpp"

namespace sunfleck::pp::SUNFLECK_ISA {

// result = scale_j-weighted Gram matrix: sum over j of weight_j matrix_j^T matrix_j, upper part.
template <typename S>
inline void gram(Vec* result, const Vec* matrix, const S* weight, Vec* weighted, int n, int width) {
  for (int j = 0; j < n; ++j)
    for (int k = 0; k < width; ++k) weighted[j * width + k] = weight[j] * matrix[j * width + k];
  multiply<S>(result, numbers<S>(weighted), matrix, n, n, width, 1, width * perVec<S>(), true);
}

template <typename S>
inline void addIdentity(Vec* matrix, int n, int width) {
  for (int i = 0; i < n; ++i) numbers<S>(matrix + i * width)[i] += 1.;
}

// (P6) One layer between a top and a black ground: what is even and what is odd about its middle part ways. With
// u = c even(z) + d odd(z), even = 1 and odd = -+ s at the ends,
//     (1 + Y t Y^T) X c = (in_top + in_bottom) / 2,   (1 + X s X^T) Y d = (in_bottom - in_top) / 2,
// both symmetric and positive definite.
template <typename S>
inline void oneLayer(const BasisRows& basis, StackRows& stack) {
  const int n = basis.n, width = rowWidth<S>(n);
  LayerRows& layer = stack.layer[0];
  Vec* scratch = rows(stack.scratch);
  Vec *s_top = scratch, *d_top = s_top + width, *s_bottom = d_top + width, *d_bottom = s_bottom + width,
      *modes = d_bottom + width, *even = modes + 2 * width, *odd = even + width, *inverse = odd + width,
      *matrix = inverse + width, *weighted = matrix + n * width;
  particular<S>(basis, layer, modes, s_top, d_top, s_bottom, d_bottom);
  for (int k = 0; k < width; ++k) {
    const Vec top = rows(stack.top_in)[k] - s_top[k] - d_top[k];
    const Vec bottom = rows(stack.bottom_in)[k] - s_bottom[k] + d_bottom[k];
    even[k] = 0.5 * (top + bottom);
    odd[k] = 0.5 * (bottom - top);
  }
  gram<S>(matrix, rows(layer.y_hat), numbers<S>(rows(layer.t)), weighted, n, width);
  addIdentity<S>(matrix, n, width);
  factorise<S>(matrix, numbers<S>(inverse), n, width);
  solveLower<S>(matrix, numbers<S>(inverse), even, n, width);
  solveUpper<S>(matrix, numbers<S>(inverse), even, n, width);
  gram<S>(matrix, rows(layer.x_hat), numbers<S>(rows(layer.s)), weighted, n, width);
  addIdentity<S>(matrix, n, width);
  factorise<S>(matrix, numbers<S>(inverse), n, width);
  solveLower<S>(matrix, numbers<S>(inverse), odd, n, width);
  solveUpper<S>(matrix, numbers<S>(inverse), odd, n, width);
  Vec *c = modes, *d = modes + width;
  project<S>(numbers<S>(c), rows(layer.y_hat), even, n, width);
  project<S>(numbers<S>(d), rows(layer.x_hat), odd, n, width);
  for (int k = 0; k < width; ++k) {
    const Vec s = rows(layer.s)[k], t = rows(layer.t)[k];
    rows(layer.u_top)[k] = c[k] - s * d[k];
    rows(layer.u_bottom)[k] = c[k] + s * d[k];
    rows(layer.v_top)[k] = t * c[k] - d[k];
    rows(layer.v_bottom)[k] = -t * c[k] - d[k];
  }
  for (int k = 0; k < width; ++k) {
    rows(stack.s_top)[k] = s_top[k];
    rows(stack.d_top)[k] = d_top[k];
    rows(stack.s_bottom)[k] = s_bottom[k];
    rows(stack.d_bottom)[k] = d_bottom[k];
  }
  addRows<S>(rows(stack.s_top), rows(layer.x_hat), numbers<S>(rows(layer.u_top)), n, width);
  addRows<S>(rows(stack.d_top), rows(layer.y_hat), numbers<S>(rows(layer.v_top)), n, width);
  addRows<S>(rows(stack.s_bottom), rows(layer.x_hat), numbers<S>(rows(layer.u_bottom)), n, width);
  addRows<S>(rows(stack.d_bottom), rows(layer.y_hat), numbers<S>(rows(layer.v_bottom)), n, width);
}

// (P7) Any stack of layers, by elimination from the ground upward. All that lies below a level answers the light there
// by D = Z S + z (hats; Z symmetric: an admittance, 1 for black, 0 for a perfect mirror). Through a layer,
//     Z' = Yt + G - 2 G R (1 - t s + 2 R^T G R)^-1 R^T G,   Yt = Y t Y^T, G = Z + Yt, R = X s^1/2,
// which is free of cancellation for thin and for thick layers and costs the same for each.
template <typename S>
inline void throughLayer(const BasisRows& basis, const StackRows& stack, LayerRows& layer, const Vec* z_below,
                         const Vec* row_below, Vec* z_above, Vec* row_above) {
  const int n = basis.n, width = rowWidth<S>(n), square = n * width;
  const int stride = width * perVec<S>();
  Vec *s_top = rows(layer.ends), *d_top = s_top + width, *s_bottom = d_top + width, *d_bottom = s_bottom + width;
  Vec *modes = rows(stack.scratch), *work = modes + 2 * width, *weighted = work + 2 * width,
      *product = weighted + square, *transposed = product + square, *gamma = transposed + square;
  const Vec *x = rows(layer.x_hat), *y = rows(layer.y_hat);
  particular<S>(basis, layer, modes, s_top, d_top, s_bottom, d_bottom);
  if (layer.infinite) {
    // Only decaying modes: v = k u.
    gram<S>(z_above, y, numbers<S>(rows(layer.k)), weighted, n, width);
    mirror<S>(z_above, n, width);
    for (int k = 0; k < width; ++k) row_above[k] = d_top[k];
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < width; ++k) row_above[k] -= numbers<S>(s_top)[j] * z_above[j * width + k];
    return;
  }
  Vec* remainder = rows(layer.remainder);
  for (int k = 0; k < width; ++k) remainder[k] = row_below[k] - d_bottom[k];
  addRows<S>(remainder, z_below, numbers<S>(s_bottom), n, width);

  gram<S>(z_above, y, numbers<S>(rows(layer.t)), weighted, n, width);
  mirror<S>(z_above, n, width);
  for (int i = 0; i < square; ++i) gamma[i] = z_below[i] + z_above[i];
  for (int k = 0; k < width; ++k) work[k] = root(rows(layer.s)[k]);
  for (int j = 0; j < n; ++j)
    for (int k = 0; k < width; ++k) weighted[j * width + k] = numbers<S>(work)[j] * x[j * width + k];
  for (int i = 0; i < square; ++i) transposed[i] = Vec{};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) numbers<S>(transposed + i * width)[j] = numbers<S>(weighted + j * width)[i];
  multiply<S>(product, numbers<S>(weighted), gamma, n, n, width, stride, 1);  // R^T G
  Vec* factor = rows(layer.factor);
  S* inverse = numbers<S>(rows(layer.factor_inverse));
  multiply<S>(factor, numbers<S>(product), transposed, n, n, width, stride, 1, true);
  const S *s = numbers<S>(rows(layer.s)), *t = numbers<S>(rows(layer.t));
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < width; ++k) factor[j * width + k] *= 2.;
    numbers<S>(factor + j * width)[j] += 1. - s[j] * t[j];
  }
  factorise<S>(factor, inverse, n, width);

  Vec* q = modes;
  for (int k = 0; k < width; ++k) q[k] = Vec{};
  project<S>(numbers<S>(q), weighted, remainder, n, width);
  solveLower<S>(factor, inverse, q, n, width);
  solveLowerRows<S>(factor, inverse, product, n, width, weighted);
  multiply<S>(transposed, numbers<S>(product), product, n, n, width, 1, stride, true);
  mirror<S>(transposed, n, width);
  for (int i = 0; i < square; ++i) z_above[i] += gamma[i] - 2. * transposed[i];
  for (int k = 0; k < width; ++k) row_above[k] = remainder[k] + d_top[k];
  for (int j = 0; j < n; ++j) {
    const S share = 2. * numbers<S>(q)[j], emitted = numbers<S>(s_top)[j];
    for (int k = 0; k < width; ++k) row_above[k] -= share * product[j * width + k] + emitted * z_above[j * width + k];
  }
}

// The way down: S (hat) at the layer's top gives its modes at both ends and S at its bottom. `s_hat` is replaced.
template <typename S>
inline void downLayer(const BasisRows& basis, const StackRows& stack, LayerRows& layer, const Vec* z_top,
                      const Vec* row_top, const Vec* z_bottom, const Vec* row_bottom, Vec* s_hat) {
  const int n = basis.n, width = rowWidth<S>(n);
  const Vec *s_top = rows(layer.ends), *d_top = s_top + width, *s_bottom = d_top + width, *d_bottom = s_bottom + width;
  Vec *modes = rows(stack.scratch), *d_hat = modes + width, *v = d_hat + width, *homogeneous = v + width;
  const Vec *x = rows(layer.x_hat), *y = rows(layer.y_hat);
  for (int k = 0; k < width; ++k) {
    d_hat[k] = row_top[k] - d_top[k];
    homogeneous[k] = s_hat[k] - s_top[k];
  }
  addRows<S>(d_hat, z_top, numbers<S>(s_hat), n, width);
  project<S>(numbers<S>(rows(layer.u_top)), y, homogeneous, n, width);
  project<S>(numbers<S>(rows(layer.v_top)), x, d_hat, n, width);
  if (layer.infinite) {
    for (int k = 0; k < width; ++k) {
      rows(layer.v_top)[k] = rows(layer.k)[k] * rows(layer.u_top)[k];
      rows(layer.u_bottom)[k] = rows(layer.v_bottom)[k] = Vec{};
    }
    return;
  }
  for (int k = 0; k < width; ++k) v[k] = Vec{};
  project<S>(numbers<S>(v), x, rows(layer.remainder), n, width);
  for (int k = 0; k < width; ++k) {
    // 1 - t s = 1 / cosh^2(k w / 2)
    const Vec through = rows(layer.through)[k], s_root = root(rows(layer.s)[k]), twice = 1. + through;
    v[k] = 4. * through / (twice * twice) * rows(layer.u_top)[k] / s_root - 2. * s_root * v[k];
    modes[k] = s_root;
  }
  const S* inverse = numbers<S>(rows(layer.factor_inverse));
  solveLower<S>(rows(layer.factor), inverse, v, n, width);
  solveUpper<S>(rows(layer.factor), inverse, v, n, width);
  for (int k = 0; k < width; ++k) {
    rows(layer.u_bottom)[k] = modes[k] * v[k];
    s_hat[k] = s_bottom[k];
    d_hat[k] = row_bottom[k] - d_bottom[k];
  }
  addRows<S>(s_hat, x, numbers<S>(rows(layer.u_bottom)), n, width);
  addRows<S>(d_hat, z_bottom, numbers<S>(s_hat), n, width);
  project<S>(numbers<S>(rows(layer.v_bottom)), x, d_hat, n, width);
}

// `prepare` makes a layer's modes: just before they are used, so that they are still in the cache.
template <typename S, typename Prepare>
inline void layerStack(const BasisRows& basis, StackRows& stack, Prepare prepare) {
  const int n = basis.n, width = rowWidth<S>(n), square = n * width, count = stack.layers;
  Vec *z = rows(stack.admittance), *offset = rows(stack.offset);
  Vec *z_ground = z + count * square, *offset_ground = offset + count * width;
  for (int i = 0; i < square; ++i) z_ground[i] = stack.black ? Vec{} : rows(stack.ground_matrix)[i];
  for (int k = 0; k < width; ++k)
    offset_ground[k] = stack.black ? -rows(stack.bottom_in)[k] : rows(stack.ground_row)[k];
  if (stack.black) addIdentity<S>(z_ground, n, width);
  for (int p = count - 1; p >= 0; --p) {
    prepare(stack.layer[p]);
    throughLayer<S>(basis, stack, stack.layer[p], z + (p + 1) * square, offset + (p + 1) * width, z + p * square,
                    offset + p * width);
  }

  // At the top S + D = 2 I+ is given: (1 + Z) S = 2 I+ - z.
  Vec *matrix = rows(stack.scratch), *inverse = matrix + square, *s_hat = rows(stack.s_top);
  for (int i = 0; i < square; ++i) matrix[i] = z[i];
  addIdentity<S>(matrix, n, width);
  for (int k = 0; k < width; ++k) s_hat[k] = rows(stack.top_in)[k] - offset[k];
  factorise<S>(matrix, numbers<S>(inverse), n, width);
  solveLower<S>(matrix, numbers<S>(inverse), s_hat, n, width);
  solveUpper<S>(matrix, numbers<S>(inverse), s_hat, n, width);
  for (int k = 0; k < width; ++k) {
    rows(stack.d_top)[k] = rows(stack.top_in)[k] - s_hat[k];
    rows(stack.s_bottom)[k] = s_hat[k];
  }
  Vec* s = rows(stack.s_bottom);
  for (int p = 0; p < count; ++p)
    downLayer<S>(basis, stack, stack.layer[p], z + p * square, offset + p * width, z + (p + 1) * square,
                 offset + (p + 1) * width, s);
  for (int k = 0; k < width; ++k) rows(stack.d_bottom)[k] = offset_ground[k];
  addRows<S>(rows(stack.d_bottom), z_ground, numbers<S>(s), n, width);
}

}  // namespace sunfleck::pp::SUNFLECK_ISA
