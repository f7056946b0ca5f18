#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/directions.hpp"
#include "core/ground_texture.hpp"
#include "core/leaf_maps.hpp"
#include "core/leaf_optics.hpp"
#include "render/reference/ray_scene.hpp"
#include "scattering/rpv_ground.hpp"
#include "sky/sky_map.hpp"

namespace sunfleck {

// What a kind of tree does to light of one band.
struct TreeOptics {
  LeafOptics leaf{};
  float wood_reflectance = 0.3f;  // Lambertian [1], 0 .. 1
  // What leaves do at each place and on each side where they are not all alike, in all bands of a run the same; `leaf`
  // then is what those do of which the place is not known.
  std::shared_ptr<const LeafMaps> maps{};
  int map_band = 0;  // which of the maps' bands this band of light is
};

// One band of light, the sun and the sky that send it and what it meets.
struct TraceLight {
  Direction sun{0.f, 0.f, -1.f};  // direction of travel; z < 0
  LeafOptics leaf{};
  float wood_reflectance = 0.3f;       // Lambertian [1], 0 .. 1
  float ground_albedo = 0.f;           // Lambertian [1], 0 .. 1
  std::vector<TreeOptics> of_kinds{};  // of each kind of tree; none: all have the optics above
  float sun_irradiance = 1.f;          // of a plane that faces the sun [1], 0 .. kMostSunIrradiance
  float sun_diameter = 0.f;  // of its disc, evenly bright [rad]: 0, a point, or kLeastSunDiameter .. kMostSunDiameter
  std::shared_ptr<const SkyMap> sky{};  // none: black
  int sky_band = 0;                     // which of the sky's bands this band of light is
  // Grounds in the place of the albedo, one of them at most, and in all bands or in none.
  std::optional<RpvGround> ground_rpv{};
  std::shared_ptr<const GroundTexture> ground_texture{};  // of the stand's x and y; of a periodic stand those of the
                                                          // period in the middle, which the ground repeats
  // Of each medium of the scene: its leaves' reflectance and transmittance; of particles their sum, the albedo, counts.
  std::vector<LeafOptics> of_media{};

  // The largest share of light that the ground sends back from any direction [1].
  float largestGroundAlbedo() const;
  TreeOptics ofKind(std::uint32_t kind) const {
    return of_kinds.empty() ? TreeOptics{.leaf = leaf, .wood_reflectance = wood_reflectance} : of_kinds[kind];
  }
};

// As many bands as one path carries at most.
inline constexpr std::size_t kMostBands = 16;

inline constexpr float kMostSunIrradiance = 10.f;
inline constexpr float kLeastSunDiameter = 0.00436332f, kMostSunDiameter = 1.0471976f;  // 0.25 and 60 degrees

// Throws InvalidInput on a value out of its range, a sun that does not shine down with all of its disc or is no unit
// vector, and on a band without light.
void validate(const TraceLight& light);
// Validates all bands; demands 1 to kMostBands of one sun and one sky, with optics of each kind of tree and of each
// medium; the gloss of a kind must be as rough in all bands, and its maps, which are validated, the same.
void requireFitting(const std::vector<TraceLight>& bands, const RayScene& scene);

}  // namespace sunfleck
