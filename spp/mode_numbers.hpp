#pragma once

#include <vector>

#include "spp/stream_constants.hpp"

// What a slab's formulas (stream_formulas.glsl) ask of StreamConstants, n modes of each order.
namespace sunfleck::spp {

// (S9) X^-1 Y and Y^-1 X of one order, n x n, row after row. Both are symmetric and positive definite.
struct ModeCouplings {
  std::vector<double> sum_of_difference, difference_of_sum;
};
ModeCouplings modeCouplings(const StreamConstants& constants, const StreamModes& modes);

// What u and v of each mode of order 0 weigh in the sum and the difference of both halves: of powers, of fluxes; and u
// in what leaves meet of both.
struct PowerWeights {
  std::vector<double> power_sum, power_difference, flux_sum, flux_difference, met_sum;
};
PowerWeights powerWeights(const StreamConstants& constants);

// StreamModes of stream_formulas.glsl for each order, member after member, as a shader's buffer (std430) holds them
// too.
template <typename Real>
std::vector<Real> modeNumbers(const StreamConstants& constants);

}  // namespace sunfleck::spp
