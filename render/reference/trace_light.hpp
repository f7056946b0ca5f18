#pragma once

#include <cstdint>
#include <vector>

#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "render/reference/ray_scene.hpp"

namespace sunfleck {

// What a kind of tree does to light of one band.
struct TreeOptics {
  LeafOptics leaf{};
  float wood_reflectance = 0.3f;  // Lambertian [1], 0 .. 1
};

// One band of light and the sun that sends it.
struct TraceLight {
  Direction sun{0.f, 0.f, -1.f};  // direction of travel; z < 0
  LeafOptics leaf{};
  float wood_reflectance = 0.3f;       // Lambertian [1], 0 .. 1
  float ground_albedo = 0.f;           // Lambertian [1], 0 .. 1
  std::vector<TreeOptics> of_kinds{};  // of each kind of tree; none: all have the optics above
  // Of each medium of the scene: its leaves' reflectance and transmittance; of particles their sum, the albedo, counts.
  std::vector<LeafOptics> of_media{};

  TreeOptics ofKind(std::uint32_t kind) const {
    return of_kinds.empty() ? TreeOptics{leaf, wood_reflectance} : of_kinds[kind];
  }
};

// As many bands as one path carries at most.
inline constexpr std::size_t kMostBands = 16;

// Throws InvalidInput on a value out of its range, a sun that does not shine down or is no unit vector.
void validate(const TraceLight& light);
// Validates all bands; demands 1 to kMostBands of one sun, with optics of each kind of tree and of each medium.
void requireFitting(const std::vector<TraceLight>& bands, const RayScene& scene);

}  // namespace sunfleck
