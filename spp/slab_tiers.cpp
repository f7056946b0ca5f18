#include "spp/slab_tiers.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace sunfleck::spp {
namespace {

constexpr SlabTier streams(std::string_view name, int n, int orders, double power_cost, double radiance_cost,
                           int powers) {
  return {.name = name,
          .form = SlabForm::kStreams,
          .streams = n,
          .azimuth_orders = orders,
          .power_cost = power_cost,
          .radiance_cost = radiance_cost,
          .powers = powers};
}
constexpr SlabTier oneStream(std::string_view name, SlabForm form, double power_cost, double radiance_cost,
                             int powers) {
  return {.name = name,
          .form = form,
          .streams = 1,
          .azimuth_orders = 1,
          .power_cost = power_cost,
          .radiance_cost = radiance_cost,
          .powers = powers};
}

// Medians of five runs of `sunfleck bench slab`, fifteen rounds each in which all take turns, on an AMD EPYC with
// AVX-512 that ran other programs too; ratios of different runs were within 4 %. Direct light, which is not in that
// race: one exponential, by bench_spp.
// A line for each:
// clang-format off
constexpr std::array<SlabTier, kSlabTiers> kTiers{
    oneStream("ss", SlabForm::kDirect, 0.2, 0.2, 0),
    oneStream("spp", SlabForm::kSpp, 1., 1.2, 1),
    oneStream("sppr", SlabForm::kRefinedSpp, 1., 2.5, 1),
    oneStream("twostream", SlabForm::kTwoStream, 1.8, 2.5, 3),
    streams("nstream:1:1", 1, 1, 1.8, 2.5, 4),
    streams("nstream:1:2", 1, 2, 1.8, 4.9, 4),
    streams("nstream:2:1", 2, 1, 3.2, 4.4, 6),
    streams("nstream:2:2", 2, 2, 3.2, 8.7, 6),
    streams("nstream:2:4", 2, 4, 3.2, 18., 6),
    streams("nstream:3:1", 3, 1, 5., 6.7, 9),
    streams("nstream:3:2", 3, 2, 5., 14., 9),
    streams("nstream:3:6", 3, 6, 5., 40., 9),
    streams("nstream:4:1", 4, 1, 7., 9.1, 12),
    streams("nstream:4:2", 4, 2, 7., 18., 12),
    streams("nstream:4:8", 4, 8, 7., 72., 12),
    streams("nstream:8:1", 8, 1, 19., 24., 15),
    streams("nstream:8:2", 8, 2, 19., 47., 15),
    streams("nstream:8:16", 8, 16, 19., 380., 15),
};
// clang-format on

std::vector<const SlabTier*> sorted(bool radiance) {
  std::vector<const SlabTier*> tiers;
  for (const SlabTier& tier : kTiers)
    if (radiance || &tier == &kTiers[static_cast<std::size_t>(tier.powers)]) tiers.push_back(&tier);
  std::ranges::stable_sort(tiers, {}, radiance ? &SlabTier::radiance_cost : &SlabTier::power_cost);
  return tiers;
}

}  // namespace

std::span<const SlabTier, kSlabTiers> slabTiers() {
  return kTiers;
}

std::span<const SlabTier* const> tiersByCost(bool radiance) {
  static const std::array kSorted{sorted(false), sorted(true)};
  return kSorted[radiance ? 1 : 0];
}

}  // namespace sunfleck::spp
