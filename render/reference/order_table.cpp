#include "render/reference/order_table.hpp"

#include <cmath>

#include "core/require.hpp"

namespace sunfleck {
namespace {

// A path ends in one bin alone, and comes by the ground rarely twice, so that the bins are next to independent.
struct IndependentSum {
  double value = 0., variance = 0.;
  void add(const Estimate& part, double weight) {
    value += weight * part.value;
    variance += weight * weight * part.standard_error * part.standard_error;
  }
  Estimate estimate() const { return {value, std::sqrt(variance)}; }
};

double ratio(float to, float from) {
  return from > 0.f ? double{to} / double{from} : 0.;
}

}  // namespace

Estimate OrderTable::ofOrder(int order) const {
  IndependentSum sum;
  for (int reflections = 0; reflections <= order; ++reflections)
    sum.add(shares_[bin(reflections, order - reflections)], 1.);
  return sum.estimate();
}

Estimate OrderTable::reweighted(const LeafOptics& traced, const LeafOptics& leaf) const {
  validate(leaf);
  require(traced.reflectance > 0.f || leaf.reflectance == 0.f, "leaf reflectance", leaf.reflectance,
          "0 like that of the leaves that were traced");
  require(traced.transmittance > 0.f || leaf.transmittance == 0.f, "leaf transmittance", leaf.transmittance,
          "0 like that of the leaves that were traced");
  const double reflection = ratio(leaf.reflectance, traced.reflectance);
  const double passage = ratio(leaf.transmittance, traced.transmittance);
  IndependentSum sum;
  double last = 0., last_reweighted = 0.;
  for (int order = 0; order <= kMostOrder; ++order)
    for (int reflections = 0; reflections <= order; ++reflections) {
      const Estimate& share = shares_[bin(reflections, order - reflections)];
      const double weight = std::pow(reflection, reflections) * std::pow(passage, order - reflections);
      sum.add(share, weight);
      if (order == kMostOrder) {
        last += share.value;
        last_reweighted += weight * share.value;
      }
    }
  Estimate result = sum.estimate();
  if (last > 0.) {
    const double rest = beyond().value * last_reweighted / last;
    result.value += rest;
    result.standard_error = std::hypot(result.standard_error, rest);
  }
  return result;
}

}  // namespace sunfleck
