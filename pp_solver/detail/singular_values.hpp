#pragma once

#include "pp_solver/detail/vec.hpp"

namespace sunfleck::pp::SUNFLECK_ISA {

// A plane rotation that takes (f, g) to (r, 0).
template <typename S>
struct Rotation {
  S c, s, r;
  Rotation(S f, S g) {
    r = root(S(f * f + g * g));
    const auto none = r == 0.;
    const S inverse = 1. / select(none, S(S{} + 1.), r);
    c = select(none, S(S{} + 1.), S(f * inverse));
    s = g * inverse;
  }
};

template <typename S, int kColumns>
inline void rotateColumns(Vec* rows, int width, int first, int last, const S* cosine, const S* sine) {
  Vec carried[kColumns];
  for (int c = 0; c < kColumns; ++c) carried[c] = rows[first * width + c];
  for (int i = first; i < last; ++i)
    for (int c = 0; c < kColumns; ++c) {
      const Vec next = rows[(i + 1) * width + c];
      rows[i * width + c] = cosine[i] * carried[c] + sine[i] * next;
      carried[c] = cosine[i] * next - sine[i] * carried[c];
    }
  for (int c = 0; c < kColumns; ++c) rows[last * width + c] = carried[c];
}

// Turns rows first .. last of `rows` (each of `width` Vec) by the rotations between neighbours, in this order.
template <typename S>
inline void rotateRows(Vec* rows, int width, int first, int last, const S* cosine, const S* sine) {
  int column = 0;
  for (; column + 4 <= width; column += 4) rotateColumns<S, 4>(rows + column, width, first, last, cosine, sine);
  for (; column + 2 <= width; column += 2) rotateColumns<S, 2>(rows + column, width, first, last, cosine, sine);
  for (; column < width; ++column) rotateColumns<S, 1>(rows + column, width, first, last, cosine, sine);
}

// (P3) Singular values of an upper bidiagonal matrix by implicit QR steps (Golub & Kahan 1965, Demmel & Kahan 1990):
// diagonal d (n, positive) and superdiagonal e (n - 1). On return |d| holds them, and row j of `left` (n rows of
// `width` Vec, the identity on entry) the left singular vector of d[j]. With S = Vec each lane is a matrix of its own.
//   cosine, sine  n each, working space
template <typename S>
void singularValues(int n, S* d, S* e, Vec* left, int width, S* cosine, S* sine) {
  constexpr double kRounding = 0x1p-53;
  for (int last = n - 1; last > 0; --last) {
    for (int step = 0; step < 60; ++step) {  // two or three do; more never help
      // Each lane's block ends at `last` and starts after its last negligible e.
      S start{};
      for (int i = 1; i <= last; ++i) {
        const auto split = e[i - 1] * e[i - 1] <= (kRounding * kRounding) * magnitude(S(d[i - 1] * d[i]));
        e[i - 1] = select(split, S{}, e[i - 1]);
        start = select(split, S(S{} + i), start);
      }
      if (all(start == double(last))) break;

      // Wilkinson's shift: the eigenvalue of the last 2 x 2 of A^T A closest to its corner.
      const S above = last > 1 ? e[last - 2] : S{};
      const S t11 = d[last - 1] * d[last - 1] + above * above, t22 = d[last] * d[last] + e[last - 1] * e[last - 1];
      const S t12 = d[last - 1] * e[last - 1], half = 0.5 * (t11 - t22), span = root(S(half * half + t12 * t12));
      const S divisor = half + select(half < 0., S(-span), span);
      const S shift = maximum(S(t22 - t12 * t12 / select(divisor == 0., S(S{} + 1.), divisor)), S{});

      S f{}, g{};
      int first = 0;
      if constexpr (sizeof(S) == sizeof(double)) first = static_cast<int>(start);
      for (int i = first; i < last; ++i) {
        const auto begins = start == double(i), idle = start > double(i);
        f = select(begins, S(d[i] - shift / d[i]), f);
        g = select(begins, e[i], g);
        const Rotation<S> right(f, g);
        if (i > first) e[i - 1] = select(start < double(i), right.r, e[i - 1]);
        const S f2 = right.c * d[i] + right.s * e[i], e2 = right.c * e[i] - right.s * d[i];
        const S g2 = right.s * d[i + 1], d2 = right.c * d[i + 1];
        const Rotation<S> turn(f2, g2);
        f = turn.c * e2 + turn.s * d2;
        const S d3 = turn.c * d2 - turn.s * e2;
        d[i] = select(idle, d[i], turn.r);
        d[i + 1] = select(idle, d[i + 1], d3);
        e[i] = select(idle, e[i], f);
        cosine[i] = select(idle, S(S{} + 1.), turn.c);
        sine[i] = select(idle, S{}, turn.s);
        if (i + 1 < last) {
          g = turn.s * e[i + 1];
          e[i + 1] = select(idle, e[i + 1], S(turn.c * e[i + 1]));
        }
      }
      rotateRows(left, width, first, last, cosine, sine);
    }
  }
}

}  // namespace sunfleck::pp::SUNFLECK_ISA
