#pragma once

#include "core/directions.hpp"

namespace sunfleck {

// (D7) How leaves are turned: M, the mean of n n^T over their area, n a leaf's unit normal. M is symmetric, its trace 1
// and no eigenvalue negative; n and -n count alike. Without data, leaves of all directions alike.
struct LeafOrientation {
  float xx = 1.f / 3.f, yy = 1.f / 3.f;       // [1], 0 .. 1
  float xy = 0.f, xz = 0.f, yz = 0.f;         // [1], -1/2 .. 1/2
  float zz() const { return 1.f - xx - yy; }  // may be negative by a rounding

  // (D8) Share of the leaf area that is seen along s, an estimate of the mean of |n . s|: 0 .. 1. Leaves of density u_L
  // meet u_L times this many lines per metre.
  //   s  unit vector
  float projection(const Direction& s) const;

  // Whether M can be a mean of n n^T, but for the rounding of its entries to 32 or to 16 bits.
  bool possible() const;
};

}  // namespace sunfleck
