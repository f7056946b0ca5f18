#include "render/shading/shading_data.hpp"

#include "core/require.hpp"
#include "render/shading/shading_model.hpp"

namespace sunfleck::shading {

std::vector<ShadingLight> shadingLights(const Scene& scene) {
  const SunAndSky light = sunAndSky(scene);
  std::vector<ShadingLight> lights;
  for (std::size_t sun = 0; sun < scene.suns.size(); ++sun)
    if (light.suns[sun] != vec3(0.f))
      lights.push_back({.travel = vec4(scene.suns[sun].light(), 0.f), .irradiance = vec4(light.suns[sun], 0.f)});
  return lights;
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
