#pragma once

#include <span>
#include <vector>

#include "grid/leaf_depth.hpp"

namespace sunfleck {

// Leaves whose depth and thickness round to the same integers.
struct Category {
  int depth = 0, thickness = 0;  // [1]
  std::vector<std::uint32_t> leaves;
};

// The depth-thickness categories of Eq. 30 that hold at least `fewest` leaves, ordered by depth and thickness.
std::vector<Category> categories(const LeafDepths& depths, std::size_t fewest = 5);

// Errors of a model's leaf irradiances against a reference, as fractions (0.062 = 6.2 %).
struct ModelErrors {
  double rms_category = 0.;  // Eq. 30 mended: sqrt(sum (<L> - <L0>)^2 / sum <L0>^2) over categories
  double rms_weighted = 0.;  // the same, each category weighted by its number of leaves
  double rms_leaf = 0.;      // the same over single leaves; holds the reference's noise too
  double bias = 0.;          // error of the sum over all leaves' irradiances
};

// (R6) `model` and `reference` hold an irradiance per leaf.
ModelErrors modelErrors(std::span<const float> model, std::span<const double> reference,
                        std::span<const Category> categories);

// RMS of the reference's own standard errors over its irradiances, per leaf: the part of rms_leaf that is noise.
double referenceNoise(std::span<const double> reference, std::span<const double> standard_error);

}  // namespace sunfleck
