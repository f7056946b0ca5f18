#pragma once

#include <cstddef>
#include <vector>

#include "core/leaf_optics.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// Light by how often leaves have reflected it and how often they have let it pass: with that known, leaves of other
// reflectance and transmittance need no new run. Light scattered more than kMostOrder times is kept in one sum.
class OrderTable {
 public:
  static constexpr int kMostOrder = 47;
  static constexpr std::size_t kBins = (kMostOrder + 1) * (kMostOrder + 2) / 2 + 1;
  static std::size_t bin(int reflections, int passes) {
    const int order = reflections + passes;
    if (order > kMostOrder) return kBins - 1;
    return static_cast<std::size_t>(order * (order + 1) / 2 + reflections);
  }

  OrderTable() : shares_(kBins) {}
  void set(std::size_t bin, const Estimate& share) { shares_[bin] = share; }

  // Share of the incident light that leaves have scattered `order` times, 0 .. kMostOrder.
  Estimate ofOrder(int order) const;
  Estimate beyond() const { return shares_.back(); }  // of higher orders

  // The whole for other leaves than those the light met, `traced`. What was scattered more than kMostOrder times is
  // taken to fall off on the whole as the last orders do: it adds to the standard error. Throws InvalidInput when
  // `leaf` reflects or passes light that `traced` did not.
  Estimate reweighted(const LeafOptics& traced, const LeafOptics& leaf) const;

 private:
  std::vector<Estimate> shares_;
};

}  // namespace sunfleck
