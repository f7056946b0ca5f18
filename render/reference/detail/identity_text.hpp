#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

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
  std::string light = fmt::format("sun's diameter {}, sky {}; irradiance of the sun, band of the sky",
                                  bands.front().sun_diameter, bands.front().sky ? bands.front().sky->hash() : "none");
  for (const TraceLight& band : bands) light += fmt::format(" {} {};", band.sun_irradiance, band.sky_band);
  return {{"light", light}, {"sun", fmt::format("{} {} {}", sun.x, sun.y, sun.z)}, {"optics", optics}};
}

}  // namespace sunfleck::detail
