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

// clang-format off: a line for each
constexpr std::array<SlabTier, kSlabTiers> kTiers{
    oneStream("ss", SlabForm::kDirect, 0.3, 0.3, 0),     oneStream("spp", SlabForm::kSpp, 1., 1., 1),
    oneStream("sppr", SlabForm::kRefinedSpp, 1., 9., 1), oneStream("twostream", SlabForm::kTwoStream, 2.4, 10., 3),
    streams("nstream:1:1", 1, 1, 2.5, 11., 4),           streams("nstream:1:2", 1, 2, 2.5, 18., 4),
    streams("nstream:2:1", 2, 1, 4.8, 20., 6),           streams("nstream:2:2", 2, 2, 4.8, 40., 6),
    streams("nstream:2:4", 2, 4, 4.8, 78., 6),           streams("nstream:3:1", 3, 1, 7.9, 30., 9),
    streams("nstream:3:2", 3, 2, 7.9, 62., 9),           streams("nstream:3:6", 3, 6, 7.9, 180., 9),
    streams("nstream:4:1", 4, 1, 12., 42., 12),          streams("nstream:4:2", 4, 2, 12., 76., 12),
    streams("nstream:4:8", 4, 8, 12., 320., 12),         streams("nstream:8:1", 8, 1, 35., 100., 15),
    streams("nstream:8:2", 8, 2, 35., 190., 15),         streams("nstream:8:16", 8, 16, 35., 1500., 15),
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
