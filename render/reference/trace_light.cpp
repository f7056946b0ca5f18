#include "render/reference/trace_light.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "core/require.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {

void validate(const TraceLight& light) {
  const double length = glm::length(glm::dvec3(light.sun));
  require(std::abs(length - 1.) < 1e-4, "length of the sun's direction", length, "1");
  require(light.sun.z < 0.f, "z of the sun's direction", light.sun.z, "below 0: sunlight travels down");
  const auto validateTree = [](const TreeOptics& tree) {
    validate(tree.leaf);
    require(tree.wood_reflectance >= 0.f && tree.wood_reflectance <= 1.f, "wood reflectance", tree.wood_reflectance,
            "in [0, 1]");
  };
  validateTree({light.leaf, light.wood_reflectance});
  for (const TreeOptics& tree : light.of_kinds) validateTree(tree);
  for (const LeafOptics& medium : light.of_media) validate(medium);
  require(light.ground_albedo >= 0.f && light.ground_albedo <= 1.f, "ground albedo", light.ground_albedo, "in [0, 1]");
}

void requireFitting(const std::vector<TraceLight>& bands, const RayScene& scene) {
  require(!bands.empty() && bands.size() <= kMostBands, "number of bands", bands.size(),
          "from 1 to " + std::to_string(kMostBands));
  const std::size_t kinds = scene.geometry().prototypes.size();
  for (const TraceLight& light : bands) {
    validate(light);
    require(light.of_kinds.empty() || light.of_kinds.size() == kinds, "number of kinds of trees with optics",
            light.of_kinds.size(), "that of the traced scene, " + std::to_string(kinds));
    require(light.of_media.size() == scene.geometry().media.size(), "number of media with optics",
            light.of_media.size(), "that of the traced scene, " + std::to_string(scene.geometry().media.size()));
    if (light.sun != bands.front().sun) throw InvalidInput("sun: must be the same in all bands");
  }
}

}  // namespace sunfleck
