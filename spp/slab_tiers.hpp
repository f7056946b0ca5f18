#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace sunfleck::spp {

enum class SlabForm { kDirect, kSpp, kRefinedSpp, kTwoStream, kStreams };

// A closed form of the light in a slab, as one may choose among them.
struct SlabTier {
  std::string_view name;  // nstream:N:ORDERS for n streams
  SlabForm form;
  int streams, azimuth_orders;  // n of each half and orders of its radiance's azimuth, of SlabForm::kStreams
  // Time of P+, P- and fluxes at one depth, and of radiance there in one direction, over that of SPP's powers: rounded
  // from measurements in single precision over arrays, thickness and depth new each time, what depends on medium and
  // beam alone at hand. The order is what matters; `sunfleck bench slab` measures it.
  double power_cost, radiance_cost;
  int powers;  // index of the first tier with the same powers and fluxes
};

// From direct light alone to eight streams of each half.
inline constexpr std::size_t kSlabTiers = 18;
std::span<const SlabTier, kSlabTiers> slabTiers();

// Those worth asking for powers or for radiance, by its cost: the cheapest first. Of tiers with the same powers the
// first alone is worth asking for powers.
std::span<const SlabTier* const> tiersByCost(bool radiance);

}  // namespace sunfleck::spp
