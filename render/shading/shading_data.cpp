#include "render/shading/shading_data.hpp"

#include "core/require.hpp"
#include "render/shading/shading_model.hpp"

namespace sunfleck::shading {

std::vector<ShadingLight> shadingLights(const Scene& scene) {
  return {{.travel = vec4(scene.sun(), 0.f), .irradiance = vec4(scene.sun_irradiance, 0.f)}};
}

ShadingData shadingData(Model model, const Scene& scene) {
  require(scene.kinds.size() <= kMostKinds, "number of kinds of trees", scene.kinds.size(), "at most 64 in a picture");
  ShadingData data{
      .kinds = {}, .lights = shadingLights(scene), .constants = shadingModel(model).constants(scene.kinds)};
  for (const TreeKind& kind : scene.kinds) {
    KindOptics& optics = data.kinds.emplace_back();
    for (int band = 0; band < kBands; ++band) {
      const LeafOptics& leaf = kind.leaf[static_cast<std::size_t>(band)];
      optics.leaf_reflectance[band] = leaf.reflectance;
      optics.leaf_transmittance[band] = leaf.transmittance;
      optics.wood_reflectance[band] = kind.wood_reflectance[band];
    }
  }
  return data;
}

}  // namespace sunfleck::shading
