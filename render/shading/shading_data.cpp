#include "render/shading/shading_data.hpp"

#include <cassert>

#include "render/shading/shading_model.hpp"

namespace sunfleck::shading {

ShadingData shadingData(Model model, std::span<const TreeKind> kinds, std::span<const StandLight> lights) {
  assert(kinds.size() <= kMostSurfaceKinds && lights.size() <= kMostShadingLights);
  ShadingData data{.kinds = {}, .lights = {}, .constants = shadingModel(model).constants(kinds)};
  for (const TreeKind& kind : kinds) {
    KindOptics& optics = data.kinds.emplace_back();
    for (int band = 0; band < kBands; ++band) {
      const LeafOptics& leaf = kind.leaf[static_cast<std::size_t>(band)];
      optics.leaf_reflectance[band] = leaf.reflectance;
      optics.leaf_transmittance[band] = leaf.transmittance;
      optics.wood_reflectance[band] = kind.wood_reflectance[band];
    }
  }
  for (const StandLight& light : lights)
    data.lights.push_back({.travel = vec4(light.along, 0.f), .irradiance = vec4(light.irradiance, 0.f)});
  return data;
}

ShadingData shadingData(Model model, const Scene& scene, const StandGeometry& stand) {
  std::vector<TreeKind> kinds;
  for (const StandKind& kind : stand.kinds()) kinds.push_back(scene.kinds[kind.kind]);
  return shadingData(model, kinds, stand.lights());
}

}  // namespace sunfleck::shading
