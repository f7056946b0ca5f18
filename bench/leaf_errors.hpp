#pragma once

#include <span>

#include "render/compare/category_errors.hpp"
#include "render/reference/forward_trace.hpp"

namespace sunfleck {

// Errors of leaves' irradiance against Monte Carlo, and what of it Monte Carlo's own noise makes [%].
struct LeafErrors {
  double weighted = 0., weighted_noise = 0.;  // of categories, weighted by their leaves
  double by_category = 0.;                    // of categories, each alike
  double leaf = 0., leaf_noise = 0.;          // of single leaves, the noise in it
  double bias = 0.;                           // of all light
};
LeafErrors leafErrors(std::span<const float> irradiance, const ForwardResult& truth, std::span<const Category> groups);

}  // namespace sunfleck
