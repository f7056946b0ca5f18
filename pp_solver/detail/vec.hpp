#pragma once

#include <cstdint>

// Vectors of the width one instruction set has. This header and those that include it are compiled once for each set,
// in a namespace of its own (SUNFLECK_ISA, SUNFLECK_VECTOR_BYTES come from the build), and hold no code that others
// share.
namespace sunfleck::pp::SUNFLECK_ISA {

constexpr int kLanes = SUNFLECK_VECTOR_BYTES / sizeof(double);
typedef double Vec __attribute__((vector_size(8 * kLanes), may_alias));
typedef std::int64_t Mask __attribute__((vector_size(8 * kLanes), may_alias));

inline double select(bool where, double a, double b) {
  return where ? a : b;
}
inline Vec select(Mask where, Vec a, Vec b) {
  return where ? a : b;
}

inline bool all(bool b) {
  return b;
}
inline bool all(Mask m) {
  std::int64_t every = -1;
  for (int i = 0; i < kLanes; ++i) every &= m[i];
  return every != 0;
}

template <typename T>
inline T minimum(T a, T b) {
  return select(b < a, b, a);
}
template <typename T>
inline T maximum(T a, T b) {
  return select(a < b, b, a);
}
template <typename T>
inline T magnitude(T a) {
  return select(a < 0., T(-a), a);
}

inline double root(double x) {
  return __builtin_sqrt(x);
}
inline Vec root(Vec x) {
  Vec r;
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_sqrt(x[i]);
  return r;
}

inline std::int64_t bits(double x) {
  return __builtin_bit_cast(std::int64_t, x);
}
inline Mask bits(Vec x) {
  return (Mask)x;
}
inline double real(std::int64_t x) {
  return __builtin_bit_cast(double, x);
}
inline Vec real(Mask x) {
  return (Vec)x;
}

// e^-x for x >= 0, infinity included, to 1 unit in the last place; 0 where it would be below 1e-299.
template <typename T>
inline T decay(T x) {
  constexpr double kLargest = 690.;    // normal numbers only
  constexpr double kShift = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
  const T y = -minimum(x, T(T{} + kLargest));
  const T shifted = y * 1.4426950408889634 + kShift;
  const T power = shifted - kShift;
  const T r = (y - power * 0x1.62e42fefap-1) - power * 0x1.cf79abc9e3b3ap-40;  // ln 2 in two parts (Cody & Waite 1980)
  // Taylor's series to r^13, |r| <= ln 2 / 2: the next term is below 1e-17.
  T p = r * (1. / 6227020800.) + 1. / 479001600.;
  for (const double inverse : {1. / 39916800., 1. / 3628800., 1. / 362880., 1. / 40320., 1. / 5040., 1. / 720.,
                               1. / 120., 1. / 24., 1. / 6., 0.5, 1., 1.})
    p = p * r + inverse;
  return select(x > kLargest, T{}, T(p * real((bits(shifted) + 1023) << 52)));
}

// (1 - e^-x) / x for x in [0, 1/2], 1 at 0: Taylor's series, whose next term is below 1e-17.
template <typename T>
inline T relaxSeries(T x) {
  T p = x * (1. / 1307674368000.) - 1. / 87178291200.;
  for (const double term : {1. / 6227020800., -1. / 479001600., 1. / 39916800., -1. / 3628800., 1. / 362880.,
                            -1. / 40320., 1. / 5040., -1. / 720., 1. / 120., -1. / 24., 1. / 6., -0.5, 1.})
    p = p * x + term;
  return p;
}

// (1 - e^-x) / x for x >= 0, given `e` = e^-x.
template <typename T>
inline T relax(T x, T e) {
  const auto small = x < 0.5;
  return select(small, relaxSeries(T(minimum(x, T(T{} + 0.5)))), T((1. - e) / select(small, T(T{} + 1.), x)));
}

// (e^-pz - e^-qz) / (q - p), both rates >= 0, given the two exponentials: z e^-pz where the rates meet.
template <typename T>
inline T difference(T p, T q, T z, T ep, T eq) {
  const T gap = q - p, x = magnitude(gap) * z;
  const auto small = x < 0.5;
  return select(small, T(z * maximum(ep, eq) * relaxSeries(select(small, x, T{}))),
                T((ep - eq) / select(small, T(T{} + 1.), gap)));
}

// Second divided difference of e^-xz at three rates a, b, c (the larger a rate, the smaller its exponential).
template <typename T>
inline T secondDifference(T a, T b, T c, T z, T ea, T eb, T ec) {
  const T low = minimum(minimum(a, b), c), high = maximum(maximum(a, b), c);
  const T middle = maximum(minimum(a, b), minimum(maximum(a, b), c));
  const T e_low = maximum(maximum(ea, eb), ec), e_high = minimum(minimum(ea, eb), ec);
  const T e_middle = maximum(minimum(ea, eb), minimum(maximum(ea, eb), ec));
  const T x = (middle - low) * z, y = (high - low) * z;
  const auto small = y < 0.5;
  // sum over n of (-1)^n h_n(x, y) / (n + 2)!, h_n the complete homogeneous polynomial
  const T xs = select(small, x, T{}), ys = select(small, y, T{});
  T h = T{} + 1., power = T{} + 1., sum = T{} + 0.5;
  double factor = 0.5;
  for (int n = 1; n <= 13; ++n) {
    power = power * xs;
    h = h * ys + power;
    factor /= -(n + 2.);
    sum = sum + h * factor;
  }
  const T apart = (difference(low, middle, z, e_low, e_middle) - difference(middle, high, z, e_middle, e_high)) /
                  select(small, T(T{} + 1.), T(high - low));
  return select(small, T(z * z * e_low * sum), apart);
}

}  // namespace sunfleck::pp::SUNFLECK_ISA
