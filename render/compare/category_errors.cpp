#include "render/compare/category_errors.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace sunfleck {

std::vector<Category> categories(const LeafDepths& depths, std::size_t fewest) {
  std::map<std::pair<int, int>, Category> found;
  for (std::size_t leaf = 0; leaf < depths.depth.size(); ++leaf) {
    const int depth = static_cast<int>(std::lround(depths.depth[leaf]));
    const int thickness = static_cast<int>(std::lround(depths.thickness[leaf]));
    Category& category = found[{depth, thickness}];
    category.depth = depth;
    category.thickness = thickness;
    category.leaves.push_back(static_cast<std::uint32_t>(leaf));
  }
  std::vector<Category> kept;
  for (auto& [key, category] : found)
    if (category.leaves.size() >= fewest) kept.push_back(std::move(category));
  return kept;
}

ModelErrors modelErrors(std::span<const float> model, std::span<const double> reference,
                        std::span<const Category> categories) {
  double squares = 0., reference_squares = 0., weighted = 0., reference_weighted = 0.;
  for (const Category& category : categories) {
    double sum = 0., reference_sum = 0.;
    for (const std::uint32_t leaf : category.leaves) {
      sum += double{model[leaf]};
      reference_sum += reference[leaf];
    }
    const auto n = static_cast<double>(category.leaves.size());
    const double difference = (sum - reference_sum) / n, mean = reference_sum / n;
    squares += difference * difference;
    reference_squares += mean * mean;
    weighted += n * difference * difference;
    reference_weighted += n * mean * mean;
  }
  double leaf_squares = 0., leaf_reference = 0., total = 0., reference_total = 0.;
  for (std::size_t leaf = 0; leaf < model.size(); ++leaf) {
    const double difference = double{model[leaf]} - reference[leaf];
    leaf_squares += difference * difference;
    leaf_reference += reference[leaf] * reference[leaf];
    total += difference;
    reference_total += reference[leaf];
  }
  const auto ratio = [](double numerator, double denominator) {
    return denominator > 0. ? std::optional(numerator / denominator) : std::nullopt;
  };
  const auto root = [&](double numerator, double denominator) {
    return denominator > 0. ? std::optional(std::sqrt(numerator / denominator)) : std::nullopt;
  };
  return {.rms_category = root(squares, reference_squares),
          .rms_weighted = root(weighted, reference_weighted),
          .rms_leaf = root(leaf_squares, leaf_reference),
          .bias = ratio(total, reference_total)};
}

std::optional<double> referenceNoise(std::span<const double> reference, std::span<const double> standard_error) {
  double variance = 0., squares = 0.;
  for (std::size_t leaf = 0; leaf < reference.size(); ++leaf) {
    variance += standard_error[leaf] * standard_error[leaf];
    squares += reference[leaf] * reference[leaf];
  }
  return squares > 0. ? std::optional(std::sqrt(variance / squares)) : std::nullopt;
}

// Variances add over the leaves of a category.
std::optional<double> categoryNoise(std::span<const double> reference, std::span<const double> standard_error,
                                    std::span<const Category> categories) {
  double variance = 0., squares = 0.;
  for (const Category& category : categories) {
    double sum = 0., sum_variance = 0.;
    for (const std::uint32_t leaf : category.leaves) {
      sum += reference[leaf];
      sum_variance += standard_error[leaf] * standard_error[leaf];
    }
    const auto n = static_cast<double>(category.leaves.size());
    variance += sum_variance / n;
    squares += sum * sum / n;
  }
  return squares > 0. ? std::optional(std::sqrt(variance / squares)) : std::nullopt;
}

}  // namespace sunfleck
