#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// The light and the optics of a run, every digit of them.
inline TraceIdentity identityOf(const std::vector<TraceLight>& bands) {
  const Direction& sun = bands.front().sun;
  std::string optics;
  for (const TraceLight& light : bands) {
    const auto add = [&](const TreeOptics& tree) {
      optics +=
          fmt::format("leaf {} {} wood {}; ", tree.leaf.reflectance, tree.leaf.transmittance, tree.wood_reflectance);
    };
    if (light.of_kinds.empty()) add({light.leaf, light.wood_reflectance});
    for (const TreeOptics& tree : light.of_kinds) add(tree);
    optics += fmt::format("ground {}. ", light.ground_albedo);
  }
  return {{"sun", fmt::format("{} {} {}", sun.x, sun.y, sun.z)}, {"optics", optics}};
}

// The same in a scene, with what is in its media.
inline TraceIdentity identityOf(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) {
  TraceIdentity identity = identityOf(bands);
  if (scene.media.empty()) return identity;
  identity["media"] = scene.media_hash;
  for (const TraceLight& light : bands)
    for (const LeafOptics& medium : light.of_media)
      identity["optics of media"] += fmt::format("{} {}; ", medium.reflectance, medium.transmittance);
  return identity;
}

}  // namespace sunfleck::detail
