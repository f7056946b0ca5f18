#include "render/compare/slab_tier_errors.hpp"

#include <algorithm>
#include <cmath>

#include "render/compare/slab_models.hpp"
#include "render/compare/sphere_rule.hpp"

namespace sunfleck {
namespace {

// Radiance does not depend on the azimuth where the phase function or the beam has none.
SphereRule directionsOf(const spp::MappedPlace& slab, const TierErrorSettings& settings) {
  if (settings.cosines == 0) return {};
  const auto* particles = std::get_if<spp::MappedParticles>(&slab.medium);
  const bool round = (particles && particles->asymmetry == 0.) || slab.mu0 == 1.;
  return sphereRule(settings.cosines, round ? 1 : settings.azimuths);
}

struct Light {
  std::vector<pp::Fluxes> fluxes;
  std::vector<double> radiances;

  Light(SlabSolution& slab, std::span<const double> depths, const SphereRule& sphere)
      : radiances(depths.size() * sphere.directions()) {
    for (const double depth : depths) fluxes.push_back(slab.fluxes(depth));
    if (!radiances.empty()) slab.radiances(depths, sphere.mus, sphere.phis, radiances);
  }
};

double radianceError(const Light& light, const Light& exact, std::size_t depth, const SphereRule& sphere) {
  const std::size_t azimuths = sphere.phis.size(), count = sphere.directions();
  if (count == 0) return 0.;
  double sum = 0.;
  for (std::size_t k = 0; k < count; ++k) {
    const double deviation = light.radiances[depth * count + k] - exact.radiances[depth * count + k];
    sum += sphere.weights[k / azimuths] * deviation * deviation;
  }
  return std::sqrt(sum / static_cast<double>(azimuths));
}

}  // namespace

std::vector<TierErrors> slabTierErrors(const spp::MappedPlace& slab, std::span<const double> depths,
                                       const TierErrorSettings& settings) {
  const SphereRule sphere = directionsOf(slab, settings);
  const SlabSetup setup =
      slabUnderBeam(spp::mediumOf(slab.medium), slab.thickness, slab.mu0, {.streams = settings.streams});
  const Light exact(*exactSlabModel().solve(setup), depths, sphere);
  const std::span<const spp::SlabTier> tiers = spp::slabTiers();
  std::vector<TierErrors> errors(depths.size() * tiers.size());
  for (std::size_t t = 0; t < tiers.size(); ++t) {
    const auto powers = static_cast<std::size_t>(tiers[t].powers);
    if (settings.cosines == 0 && powers != t) {
      for (std::size_t d = 0; d < depths.size(); ++d) errors[d * tiers.size() + t] = errors[d * tiers.size() + powers];
      continue;
    }
    const Light light(*findSlabModel(tiers[t].name)->solve(setup), depths, sphere);
    for (std::size_t d = 0; d < depths.size(); ++d) {
      const pp::Fluxes &a = light.fluxes[d], &b = exact.fluxes[d];
      errors[d * tiers.size() + t] = {
          std::max(std::abs(a.up - b.up), std::abs(a.down + a.direct - b.down - b.direct)) / slab.mu0,
          std::abs(a.leaf_irradiance - b.leaf_irradiance) / std::max(b.leaf_irradiance, spp::kDimIrradiance),
          radianceError(light, exact, d, sphere)};
    }
  }
  return errors;
}

}  // namespace sunfleck
