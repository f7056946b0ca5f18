#include "spp/slab_tiers.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace sunfleck::spp {
namespace {

constexpr SlabTier streams(std::string_view name, int n, int orders, float power_cost, float radiance_cost,
                           int powers) {
  return {.name = name,
          .form = SlabForm::kStreams,
          .streams = n,
          .azimuth_orders = orders,
          .power_cost = power_cost,
          .radiance_cost = radiance_cost,
          .powers = powers};
}
constexpr SlabTier oneStream(std::string_view name, SlabForm form, float power_cost, float radiance_cost, int powers) {
  return {.name = name,
          .form = form,
          .streams = 1,
          .azimuth_orders = 1,
          .power_cost = power_cost,
          .radiance_cost = radiance_cost,
          .powers = powers};
}

constexpr std::array<SlabTier, kSlabTiers> kTiers{
    oneStream("ss", SlabForm::kDirect, 0.3F, 0.3F, 0),     oneStream("spp", SlabForm::kSpp, 1.F, 1.F, 1),
    oneStream("sppr", SlabForm::kRefinedSpp, 1.F, 9.F, 1), oneStream("twostream", SlabForm::kTwoStream, 2.4F, 9.1F, 3),
    streams("nstream:1:1", 1, 1, 2.5F, 9.2F, 4),           streams("nstream:1:2", 1, 2, 2.5F, 16.F, 4),
    streams("nstream:2:1", 2, 1, 4.8F, 18.F, 6),           streams("nstream:2:2", 2, 2, 4.8F, 32.F, 6),
    streams("nstream:2:4", 2, 4, 4.8F, 60.F, 6),           streams("nstream:3:1", 3, 1, 7.9F, 28.F, 9),
    streams("nstream:3:2", 3, 2, 7.9F, 50.F, 9),           streams("nstream:3:6", 3, 6, 7.9F, 140.F, 9),
    streams("nstream:4:1", 4, 1, 11.7F, 40.F, 12),         streams("nstream:4:2", 4, 2, 11.7F, 72.F, 12),
    streams("nstream:4:8", 4, 8, 11.7F, 270.F, 12),        streams("nstream:8:1", 8, 1, 40.F, 110.F, 15),
    streams("nstream:8:2", 8, 2, 40.F, 200.F, 15),         streams("nstream:8:16", 8, 16, 40.F, 1500.F, 15),
};

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
