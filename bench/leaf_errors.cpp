#include "bench/leaf_errors.hpp"

namespace sunfleck {

LeafErrors leafErrors(std::span<const float> irradiance, const ForwardResult& truth, std::span<const Category> groups) {
  const ModelErrors errors = modelErrors(irradiance, truth.leaf_irradiance, groups);
  const auto noise = categoryNoise(truth.leaf_irradiance, truth.leaf_standard_error, groups);
  return {.weighted = 100. * errors.rms_weighted.value_or(0.),
          .weighted_noise = 100. * noise.value_or(0.),
          .by_category = 100. * errors.rms_category.value_or(0.),
          .leaf = 100. * errors.rms_leaf.value(),
          .leaf_noise = 100. * referenceNoise(truth.leaf_irradiance, truth.leaf_standard_error).value(),
          .bias = 100. * errors.bias.value()};
}

}  // namespace sunfleck
