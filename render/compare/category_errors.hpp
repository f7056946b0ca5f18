#pragma once

#include <optional>
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

// Errors of a model's leaf irradiances against a reference, as fractions (0.062 = 6.2 %). Nothing where there is
// nothing to compare with: no category, or a reference that is dark.
struct ModelErrors {
  std::optional<double> rms_category;  // Eq. 30 mended: sqrt(sum (<L> - <L0>)^2 / sum <L0>^2) over categories
  std::optional<double> rms_weighted;  // the same, each category weighted by its number of leaves
  std::optional<double> rms_leaf;      // the same over single leaves; holds the reference's noise too
  std::optional<double> bias;          // error of the sum over all leaves' irradiances
};

// (R6) `model` and `reference` hold an irradiance per leaf.
ModelErrors modelErrors(std::span<const float> model, std::span<const double> reference,
                        std::span<const Category> categories);

// RMS of the reference's own standard errors over its irradiances, per leaf: the part of rms_leaf that is noise.
// Nothing when all are dark.
std::optional<double> referenceNoise(std::span<const double> reference, std::span<const double> standard_error);

// The same of category means, as in rms_weighted, which a perfect model is expected to have. Nothing when all are dark.
std::optional<double> categoryNoise(std::span<const double> reference, std::span<const double> standard_error,
                                    std::span<const Category> categories);

}  // namespace sunfleck
