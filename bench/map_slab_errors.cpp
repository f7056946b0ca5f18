// Makes a map of the closed forms' errors: map_slab_errors particles|leaves FILE. With --check COUNT [SEED] in place of
// FILE it measures random places and prints how often, and by how much, the errors there exceed what the map in the
// library promises.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "core/whole_file.hpp"
#include "render/compare/slab_error_cells.hpp"
#include "spp/tier_choice.hpp"

using namespace sunfleck;

namespace {

Progress told() {
  return [last = -1](double share) mutable {
    if (const int percent = static_cast<int>(100. * share); percent != last)
      fmt::print(stderr, "\r{} %{}", last = percent, percent == 100 ? "\n" : "");
    return true;
  };
}

int check(spp::MapKind kind, int count, unsigned seed) {
  const std::vector<CheckedPlace> places = checkedPlaces(kind, count, seed, told());
  for (const spp::SlabQuantity quantity :
       {spp::SlabQuantity::kFlux, spp::SlabQuantity::kLeafIrradiance, spp::SlabQuantity::kRadiance}) {
    const auto q = static_cast<std::size_t>(quantity);
    fmt::print("\n{}\n{:<14} {:>8} {:>10} {:>10} {:>12}\n", std::array{"fluxes", "leaf irradiance", "radiance"}[q],
               "tier", "exceeded", "at most by", "typically", "keeps 1 % in");
    for (std::size_t t = 0; t < spp::slabTiers().size(); ++t) {
      const spp::SlabTier& tier = spp::slabTiers()[t];
      int exceeded = 0, kept = 0;
      double most = 0.;
      std::vector<double> shares;
      for (const CheckedPlace& place : places) {
        const double promise = spp::promisedError(tier, place.place, quantity), error = place.errors[t][q];
        const double share = error / promise;
        if (share > 1.) ++exceeded;
        if (promise <= 0.01) ++kept;
        most = std::max(most, share);
        if (promise > 2. * spp::SlabErrorMap::kLeastError) shares.push_back(share);
      }
      std::ranges::sort(shares);
      fmt::print("{:<14} {:>8} {:>10.3f} {:>10.2f} {:>10.1f} %\n", tier.name, exceeded, most,
                 shares.empty() ? 0. : shares[shares.size() / 2], 100. * kept / static_cast<double>(places.size()));
    }
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string name = count > 2 ? arguments[1] : "", file = count > 2 ? arguments[2] : "";
  if ((name != "particles" && name != "leaves") || (file == "--check") != (count > 3)) {
    fmt::print(stderr, "usage: map_slab_errors particles|leaves FILE, or --check COUNT [SEED] in place of FILE\n");
    return 2;
  }
  const spp::MapKind kind = name == "leaves" ? spp::MapKind::kLeaves : spp::MapKind::kParticles;
  if (count > 3)
    return check(kind, std::atoi(arguments[3]), count > 4 ? static_cast<unsigned>(std::atoi(arguments[4])) : 1);
  requireWritable(file);
  writeWhole(file, measuredErrors(kind, told()).file());
  return 0;
}
