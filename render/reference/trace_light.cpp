#include "render/reference/trace_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <tuple>

#include "core/require.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {

void validate(const TraceLight& light) {
  const double length = glm::length(glm::dvec3(light.sun));
  require(std::abs(length - 1.) < 1e-4, "length of the sun's direction", length, "1");
  require(light.sun.z < 0.f, "z of the sun's direction", light.sun.z, "below 0: sunlight travels down");
  require(light.sun_irradiance >= 0.f && light.sun_irradiance <= kMostSunIrradiance, "irradiance of the sun",
          light.sun_irradiance, "in [0, 10]");
  require(
      light.sun_diameter == 0.f || (light.sun_diameter >= kLeastSunDiameter && light.sun_diameter <= kMostSunDiameter),
      "diameter of the sun", light.sun_diameter, "0 or from 0.25 to 60 degrees, in radians");
  const float height = std::asin(std::min(-light.sun.z, 1.f));
  require(
      light.sun_irradiance == 0.f || light.sun_diameter == 0.f || 0.5f * light.sun_diameter < height,
      "diameter of the sun", light.sun_diameter,
      "below twice the sun's height of " + std::to_string(height) + " rad, so that the disc stands above the horizon");
  require(light.sky_band >= 0 && light.sky_band < kBands, "band of the sky", light.sky_band, "0, 1 or 2");
  if (!(light.sun_irradiance > 0.f) && !(light.sky && light.sky->irradiance()[light.sky_band] > 0.))
    throw InvalidInput("light: must come from the sun or from the sky in each band traced");
  const auto validateTree = [](const TreeOptics& tree) {
    validate(tree.leaf);
    require(tree.wood_reflectance >= 0.f && tree.wood_reflectance <= 1.f, "wood reflectance", tree.wood_reflectance,
            "in [0, 1]");
    require(tree.map_band >= 0 && tree.map_band < kBands, "band of the leaf maps", tree.map_band, "0, 1 or 2");
  };
  validateTree({.leaf = light.leaf, .wood_reflectance = light.wood_reflectance});
  for (const TreeOptics& tree : light.of_kinds) validateTree(tree);
  for (const LeafOptics& medium : light.of_media) validate(medium);
  require(light.ground_albedo >= 0.f && light.ground_albedo <= 1.f, "ground albedo", light.ground_albedo, "in [0, 1]");
  if (light.ground_rpv) validate(*light.ground_rpv);
  if (light.ground_texture) validate(*light.ground_texture);
  if (light.ground_rpv && light.ground_texture) throw InvalidInput("ground: must be rpv or a texture, not both");
}

float TraceLight::largestGroundAlbedo() const {
  if (ground_rpv) return static_cast<float>(largestRpvAlbedo(*ground_rpv));
  if (ground_texture) return *std::max_element(ground_texture->albedo.begin(), ground_texture->albedo.end());
  return ground_albedo;
}

void requireFitting(const std::vector<TraceLight>& bands, const RayScene& scene) {
  require(!bands.empty() && bands.size() <= kMostBands, "number of bands", bands.size(),
          "from 1 to " + std::to_string(kMostBands));
  const std::size_t kinds = scene.geometry().prototypes.size();
  for (const TraceLight& light : bands) {
    validate(light);
    require(light.of_kinds.empty() || light.of_kinds.size() == kinds, "number of kinds of trees with optics",
            light.of_kinds.size(), "that of the traced scene, " + std::to_string(kinds));
    if (light.sun_diameter != bands.front().sun_diameter)
      throw InvalidInput("diameter of the sun: must be the same in all bands");
    if (light.sky != bands.front().sky) throw InvalidInput("sky: must be the same in all bands");
    require(light.of_media.size() == scene.geometry().media.size(), "number of media with optics",
            light.of_media.size(), "that of the traced scene, " + std::to_string(scene.geometry().media.size()));
    if (light.sun != bands.front().sun) throw InvalidInput("sun: must be the same in all bands");
    const TraceLight& first = bands.front();
    const auto shape = [](const TraceLight& of) {
      const GroundTexture* const texture = of.ground_texture.get();
      return texture ? std::tuple(texture->width, texture->height, texture->size) : std::tuple(0, 0, 0.f);
    };
    if (light.ground_rpv.has_value() != first.ground_rpv.has_value() || shape(light) != shape(first))
      throw InvalidInput("ground: must be of the same kind in all bands, a texture of the same size");
    for (std::uint32_t kind = 0; kind < kinds; ++kind) {
      require(light.ofKind(kind).leaf.gloss_roughness == first.ofKind(kind).leaf.gloss_roughness,
              "leaf gloss_roughness", light.ofKind(kind).leaf.gloss_roughness, "the same in all bands");
      if (light.ofKind(kind).maps != first.ofKind(kind).maps)
        throw InvalidInput("leaf maps: must be the same in all bands");
    }
  }
  for (std::uint32_t kind = 0; kind < kinds; ++kind)
    if (const TreeOptics tree = bands.front().ofKind(kind); tree.maps) validate(*tree.maps, "leaf maps");
}

}  // namespace sunfleck
