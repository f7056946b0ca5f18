#include "render/shading/shading_data.hpp"

#include <cassert>

#include "spp/slab.hpp"

namespace sunfleck::shading {
namespace {

KindOptics opticsOf(const TreeKind& kind, const LeafTables::OfKind& tables) {
  KindOptics optics{};
  optics.maps.w = tables.first_table;
  if (tables.pyramid) {
    optics.maps.x = static_cast<uint>(tables.pyramid->width);
    optics.maps.y = static_cast<uint>(tables.pyramid->height);
    optics.maps.z = tables.first_place;
  }
  if (!tables.roughnesses.empty()) {
    const std::size_t table = nearestRoughness(tables.roughnesses, kind.leaf[0].gloss_roughness);
    optics.leaf_reflectance.w = tables.roughnesses[table];
    optics.leaf_gloss.w = static_cast<float>(table);
  }
  for (int band = 0; band < kBands; ++band) {
    const LeafOptics& leaf = kind.leaf[static_cast<std::size_t>(band)];
    optics.leaf_reflectance[band] = leaf.reflectance;
    optics.leaf_transmittance[band] = leaf.transmittance;
    optics.leaf_gloss[band] = leaf.gloss;
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
  data.leaf_tables = leafTables(kinds, data.leaf_tables);
  if (leaves != data.leaves || model != data.model) data.constants = shadingModel(model).constants(kinds, exact);
  data.model = model;
  data.leaves = std::move(leaves);
  data.kinds.clear();
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    data.kinds.push_back(opticsOf(kinds[kind], data.leaf_tables->kinds[kind]));
  data.lights.assign(lights.begin(), lights.end());
}

}  // namespace sunfleck::shading
