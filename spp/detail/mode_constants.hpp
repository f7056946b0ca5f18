#pragma once

#include <vector>

#include "spp/stream_constants.hpp"

// What of StreamConstants a slab's formulas ask for (stream_formulas.glsl), n modes.
namespace sunfleck::spp::detail {

// (S9) X^-1 Y and Y^-1 X of one order, n x n, row after row. Both are symmetric and positive definite.
struct ModeCouplings {
  std::vector<double> sum_of_difference, difference_of_sum;
};
ModeCouplings modeCouplings(const StreamConstants& constants, const StreamModes& modes);

// What u and v of each mode of order 0 weigh in the sum and the difference of both halves: of powers, of fluxes.
struct PowerWeights {
  std::vector<double> power_sum, power_difference, flux_sum, flux_difference;
};
PowerWeights powerWeights(const StreamConstants& constants);

}  // namespace sunfleck::spp::detail
