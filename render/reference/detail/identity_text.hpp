#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/reference/camera_trace.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// Fowler, Noll and Vo's hash (1a, 64 bits) of the values' bytes.
template <typename T>
std::uint64_t hashOf(const std::vector<T>& values) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::byte byte : std::as_bytes(std::span(values)))
    hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
  return hash;
}

// The light and the optics of a run, every digit of them.
inline TraceIdentity identityOf(const std::vector<TraceLight>& bands) {
  const Direction& sun = bands.front().sun;
  std::string optics;
  for (const TraceLight& light : bands) {
    const auto add = [&](const TreeOptics& tree) {
      optics +=
          fmt::format("leaf {} {} wood {}; ", tree.leaf.reflectance, tree.leaf.transmittance, tree.wood_reflectance);
      if (tree.leaf.gloss > 0.f) optics += fmt::format("gloss {} {}; ", tree.leaf.gloss, tree.leaf.gloss_roughness);
    };
    if (light.of_kinds.empty()) add({light.leaf, light.wood_reflectance});
    for (const TreeOptics& tree : light.of_kinds) add(tree);
    if (light.ground_rpv)
      optics += fmt::format("ground rpv {} {} {} {}. ", light.ground_rpv->rho0, light.ground_rpv->k,
                            light.ground_rpv->theta, light.ground_rpv->rho_c);
    else if (light.ground_texture)
      optics +=
          fmt::format("ground texture {} x {} every {}, {:016x}. ", light.ground_texture->width,
                      light.ground_texture->height, light.ground_texture->size, hashOf(light.ground_texture->albedo));
    else
      optics += fmt::format("ground {}. ", light.ground_albedo);
  }
  std::string light = fmt::format("sun's diameter {}, sky {}; irradiance of the sun, band of the sky",
                                  bands.front().sun_diameter, bands.front().sky ? bands.front().sky->hash() : "none");
  for (const TraceLight& band : bands) light += fmt::format(" {} {};", band.sun_irradiance, band.sky_band);
  return {{"light", light}, {"sun", fmt::format("{} {} {}", sun.x, sun.y, sun.z)}, {"optics", optics}};
}

// What leaves do at each place, where there are maps, and which triangles show which.
inline std::string mapsText(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) {
  static_assert(sizeof(LeafPlace) == 17 * 4 && sizeof(LeafPatch) == 7 * 4, "no byte between their numbers is hashed");
  std::string text;
  for (std::uint32_t kind = 0; kind < scene.prototypes.size(); ++kind) {
    const std::shared_ptr<const LeafMaps> maps = bands.front().ofKind(kind).maps;
    if (!maps) continue;
    text += fmt::format("kind {}: {} x {} {:016x} {:016x}", kind, maps->width, maps->height, hashOf(maps->places),
                        hashOf(maps->roughnesses));
    for (const TraceLight& light : bands) text += fmt::format(" {}", light.ofKind(kind).map_band);
    if (const LeafImages* images = scene.prototypes[kind].images.get())
      text += fmt::format(", shown by {:016x} {:016x}", hashOf(images->patches), hashOf(images->patch_of_triangle));
    text += "; ";
  }
  return text;
}

// The same in a scene, with what is in its media and in the images of its leaves.
inline TraceIdentity identityOf(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) {
  TraceIdentity identity = identityOf(bands);
  const std::string maps = mapsText(bands, scene);
  if (!maps.empty()) identity["leaf maps"] = maps;
  if (scene.media.empty()) return identity;
  identity["media"] = scene.media_hash;
  for (const TraceLight& light : bands)
    for (const LeafOptics& medium : light.of_media)
      identity["optics of media"] += fmt::format("{} {}; ", medium.reflectance, medium.transmittance);
  return identity;
}

inline std::string textOf(const PixelRays& rays) {
  const auto text = [](const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
  return fmt::format("{} x {} {}, corner {}, steps {}, {}", rays.width, rays.height,
                     rays.eye ? "from " + text(*rays.eye) : "along " + text(rays.sight), text(rays.corner),
                     text(rays.right_step), text(rays.down_step));
}

}  // namespace sunfleck::detail
