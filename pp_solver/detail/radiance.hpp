#pragma once

#include "pp_solver/detail/kernel.hpp"
#include "pp_solver/detail/solve.hpp"

namespace sunfleck::pp::SUNFLECK_ISA {

using detail::View;

template <typename S>
inline S sumOfRow(Vec sum) {
  if constexpr (kWide<S>) {
    return sum;
  } else {
    double total = 0.;
    for (int i = 0; i < kLanes; ++i) total += sum[i];
    return total;
  }
}

// sinh(k (z - w / 2)) / (k cosh(k w / 2)), y = w - z; what is odd about the layer's middle.
inline Vec oddShape(Vec k, Vec z, Vec y, Vec ez, Vec ey, Vec through) {
  const Vec gap = magnitude(Vec(z - y)), near = maximum(ez, ey), x = k * gap;
  const Vec ratio = minimum(ez, ey) / select(near > 0., near, Vec(Vec{} + 1.));
  const Vec size = near * gap * relax(x, ratio) / (1. + through);
  return select(z < y, Vec(-size), size);
}

// The homogeneous part between the ends of a layer, without growth and without cancellation: of thick modes (k w > 1)
// as e^-kz and e^-k(w-z), of thin ones as even and odd about the middle.
struct Shape {
  Vec thick;  // 1 or 0
  Vec p, q;   // thick: u = p e^-kz + q e^-ky, v = k (p e^-kz - q e^-ky)
  Vec c, d;   // thin: u = c even + d odd, v = -c k^2 odd - flow even; flow = d but for rounding
  Vec flow;
};
inline Shape shapeOf(const LayerRows& layer, int j) {
  const Vec through = rows(layer.through)[j], u0 = rows(layer.u_top)[j], uw = rows(layer.u_bottom)[j];
  const auto thick = through < 0.36787944117144233;
  const Vec gap = select(thick, Vec(1. - through * through), Vec(Vec{} + 1.));
  const Vec flow = -0.5 * (rows(layer.v_top)[j] + rows(layer.v_bottom)[j]);
  // What is odd follows from u where the layer is deep and from v where it is shallow.
  const Vec s = layer.infinite ? Vec{} : rows(layer.s)[j];
  const auto deep = s > 1.;
  return {.thick = select(thick, Vec(Vec{} + 1.), Vec{}),
          .p = select(thick, Vec((u0 - uw * through) / gap), Vec{}),
          .q = select(thick, Vec((uw - u0 * through) / gap), Vec{}),
          .c = 0.5 * (u0 + uw),
          .d = select(deep, Vec(0.5 * (uw - u0) / select(deep, s, Vec(Vec{} + 1.))), flow),
          .flow = flow};
}

// u and v of every mode at depth z below the layer's top, as rows.
template <typename S>
void fieldAt(const BasisRows& basis, const LayerRows& layer, const double* depth, double* u_row, double* v_row) {
  const int width = rowWidth<S>(basis.n);
  const S zs = numbers<S>(rows(depth))[0], rate = numbers<S>(rows(layer.rate))[0],
          thickness = numbers<S>(rows(layer.thickness))[0];
  const Vec z = Vec{} + zs, kappa = Vec{} + rate, y = layer.infinite ? Vec{} : Vec(Vec{} + thickness - z);
  const Vec beam = decay(Vec(z * kappa));
  for (int j = 0; j < width; ++j) {
    const Vec k = rows(layer.k)[j], through = rows(layer.through)[j];
    const Vec ez = decay(Vec(k * z)), ey = layer.infinite ? Vec{} : decay(Vec(k * y));
    const Shape shape = shapeOf(layer, j);
    const Vec even = (ez + ey) / (1. + through);
    const Vec odd = layer.infinite ? Vec{} : oddShape(k, z, y, ez, ey, through);
    const Vec gd = rows(layer.g)[j] * difference(k, kappa, z, ez, beam);
    const auto thick = shape.thick > 0.5;
    rows(u_row)[j] = select(thick, Vec(shape.p * ez + shape.q * ey), Vec(shape.c * even + shape.d * odd)) + gd;
    rows(v_row)[j] = select(thick, Vec(k * (shape.p * ez - shape.q * ey)),
                            Vec(-shape.c * rows(layer.k2)[j] * odd - shape.flow * even)) +
                     (rows(layer.a)[j] - rows(layer.g)[j]) * beam + gd * k;
  }
}

// (P8) The source function of a layer integrated along the view, in closed form: diffuse light that the layer adds
// between its edge and depth z, downward and upward.
//   view.even, view.odd  rows in the basis: how the direction receives light (scatterRows)
template <typename S>
void viewLayer(const BasisRows& basis, const LayerRows& layer, const View& view, double* scratch) {
  const int n = basis.n, width = rowWidth<S>(n);
  Vec *alpha = rows(scratch), *beta = alpha + width;
  for (int k = 0; k < width; ++k) alpha[k] = beta[k] = Vec{};
  project<S>(numbers<S>(alpha), rows(layer.x), rows(view.even), n, width);
  project<S>(numbers<S>(beta), rows(layer.y), rows(view.odd), n, width);
  const S rate = numbers<S>(rows(layer.rate))[0], thickness = numbers<S>(rows(layer.thickness))[0];
  const S view_rate = numbers<S>(rows(view.rate))[0];
  const Vec kappa = Vec{} + rate, m = Vec{} + view_rate, w = layer.infinite ? Vec{} : Vec(Vec{} + thickness);
  const Vec beam_w = layer.infinite ? Vec{} : decay(Vec(kappa * w));

  for (int level = 0; level < view.levels; ++level) {
    const S zs = numbers<S>(rows(view.depth))[level];
    const Vec z = Vec{} + zs, y = layer.infinite ? Vec{} : Vec(w - z);
    const Vec mz = decay(Vec(m * z)), my = layer.infinite ? Vec{} : decay(Vec(m * y));
    const Vec beam = decay(Vec(kappa * z));
    Vec down{}, up{};
    for (int j = 0; j < width; ++j) {
      const Vec k = rows(layer.k)[j], k2 = rows(layer.k2)[j], through = rows(layer.through)[j];
      const Vec ez = decay(Vec(k * z)), ey = layer.infinite ? Vec{} : decay(Vec(k * y));
      const Shape shape = shapeOf(layer, j);
      const auto thick = shape.thick > 0.5;
      const Vec al = alpha[j], be = beta[j], sum = m + k, density = 1. / (1. + through);
      // e^-kt and e^-k(w-t) seen downward and upward
      const Vec near_down = m * difference(k, m, z, ez, mz), far_down = m * (ey - mz * through) / sum;
      const Vec near_up = m * (ez - my * through) / sum;
      const Vec far_up = layer.infinite ? Vec{} : Vec(m * difference(k, m, y, ey, my));
      const Vec odd = layer.infinite ? Vec{} : oddShape(k, z, y, ez, ey, through);
      const Vec s = layer.infinite ? Vec{} : rows(layer.s)[j];
      const Vec even_share = al * shape.c, odd_share = al * shape.d;
      const Vec v_odd = be * shape.c * k2, v_even = be * shape.flow;
      const Vec thin_down = density * ((even_share - v_even) - (odd_share - v_odd) / m) * (near_down + far_down) +
                            (odd_share - v_odd) * (odd + s * mz);
      const Vec thin_up = density * ((even_share + v_even) + (odd_share + v_odd) / m) * (near_up + far_up) +
                          (odd_share + v_odd) * (odd - s * my);
      down += select(thick, Vec((al + be * k) * shape.p * near_down + (al - be * k) * shape.q * far_down), thin_down);
      up += select(thick, Vec((al - be * k) * shape.p * near_up + (al + be * k) * shape.q * far_up), thin_up);
      // the beam's particular solution
      const Vec g = rows(layer.g)[j], rest = rows(layer.a)[j] - g;
      const Vec beam_down = m * difference(kappa, m, z, beam, mz);
      const Vec twice_down = m * secondDifference(k, kappa, m, z, ez, beam, mz);
      const Vec beam_up = m * (beam - my * beam_w) / (m + kappa);
      const Vec d_z = difference(k, kappa, z, ez, beam);
      const Vec d_w = layer.infinite ? Vec{} : difference(k, kappa, w, through, beam_w);
      const Vec twice_up = m * (d_z - my * d_w) / sum + beam_up / sum;
      down += al * g * twice_down + be * (rest * beam_down + g * k * twice_down);
      up += al * g * twice_up - be * (rest * beam_up + g * k * twice_up);
    }
    numbers<S>(rows(view.down))[level] = 0.5 * sumOfRow<S>(down);
    numbers<S>(rows(view.up))[level] = 0.5 * sumOfRow<S>(up);
  }
}

}  // namespace sunfleck::pp::SUNFLECK_ISA
