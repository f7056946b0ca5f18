#pragma once

#include <vector>

#include "pp_solver/detail/stack.hpp"

namespace sunfleck::pp::detail {

// A layer between the ordinates, for one azimuth mode, when nothing makes its eigenproblem bidiagonal.
struct DenseMedium {
  double albedo = 0., loss = 1.;   // omega and 1 - omega
  double planck_slope = 0.;        // dB/dz
  std::vector<double> extinction;  // G of each node
  std::vector<double> even, odd;   // E and O of (P21) [i * n + j]; of mode 0, even is E / omega
};

// (P10) Eigenmodes of such a layer: b = L L^T, L^T a L y = k^2 y with a = M^-1/2 (G - W^1/2 E W^1/2) M^-1/2 and b
// likewise of O; x = L y, y = L^-T y as node values. Where next to nothing is absorbed the constant field is taken out
// before the eigenproblem is solved, since its k is known better than its digits. (P14) h = -dB/dz b^-1 1. Throws
// InvalidInput where b is not positive: then the ordinates cannot carry this phase function.
void denseModes(const BasisRows& basis, LayerRows& row, const DenseMedium& medium, const std::vector<double>& weight);

}  // namespace sunfleck::pp::detail
