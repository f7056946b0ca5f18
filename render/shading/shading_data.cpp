#include "render/shading/shading_data.hpp"

#include <algorithm>
#include <cassert>

#include "scattering/gloss_tables.hpp"
#include "scattering/leaf_gloss.hpp"
#include "spp/slab.hpp"

namespace sunfleck::shading {
namespace {

bool glossy(const BandOptics& leaf) {
  return std::ranges::any_of(leaf, [](const LeafOptics& of_band) { return of_band.gloss > 0.f; });
}

std::vector<float> glossTablesOf(std::span<const BandOptics> leaves) {
  std::vector<float> tables;
  if (std::ranges::none_of(leaves, glossy)) return tables;
  for (const BandOptics& leaf : leaves) {
    const std::vector<float> table =
        glossy(leaf) ? glossTables(leaf[0].gloss_roughness) : std::vector<float>(kGlossTableNumbers);
    tables.insert(tables.end(), table.begin(), table.end());
  }
  return tables;
}

KindOptics opticsOf(const TreeKind& kind) {
  KindOptics optics{};
  const bool gloss = glossy(kind.leaf);
  const float mean_albedo = gloss ? LeafGloss(kind.leaf[0].gloss_roughness).meanAlbedo() : 0.f;
  optics.leaf_gloss.w = gloss ? kind.leaf[0].gloss_roughness : 0.f;
  for (int band = 0; band < kBands; ++band) {
    const LeafOptics& leaf = kind.leaf[static_cast<std::size_t>(band)];
    optics.leaf_reflectance[band] = leaf.reflectance;
    optics.leaf_transmittance[band] = leaf.transmittance;
    optics.leaf_gloss[band] = leaf.gloss;
    optics.gloss_entering[band] = std::max(1.f - leaf.gloss * mean_albedo, 1e-6f);
    optics.wood_reflectance[band] = kind.wood_reflectance[band];
    const spp::SppRates slab =
        spp::sppRates(1.f, leaf.albedo(), spp::sphericalLeafForwardShare(leaf.reflectance, leaf.transmittance));
    optics.slab_rate[band] = slab.rate;
    optics.slab_loss[band] = slab.loss;
    optics.slab_backward[band] = slab.backward;
  }
  return optics;
}

}  // namespace

void update(ShadingData& data, Model model, std::span<const TreeKind> kinds, std::span<const ShadingLight> lights,
            const spp::PowerTableOf& exact) {
  assert(kinds.size() <= kMostSurfaceKinds && lights.size() <= kMostShadingLights);
  std::vector<BandOptics> leaves;
  for (const TreeKind& kind : kinds) leaves.push_back(kind.leaf);
  if (leaves != data.leaves) data.gloss_tables = glossTablesOf(leaves);
  if (leaves != data.leaves || model != data.model) data.constants = shadingModel(model).constants(kinds, exact);
  data.model = model;
  data.leaves = std::move(leaves);
  data.kinds.clear();
  for (const TreeKind& kind : kinds) data.kinds.push_back(opticsOf(kind));
  data.lights.assign(lights.begin(), lights.end());
}

}  // namespace sunfleck::shading
