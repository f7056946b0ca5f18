#pragma once

#include <glm/vec3.hpp>

#include "render/reference/detail/band_lanes.hpp"
#include "render/reference/detail/path_random.hpp"

namespace sunfleck::detail {

// Below this weight in its brightest band a path goes on by chance alone (Russian roulette). Of .5, .77, 1 and 2 the
// second brought a picture of a crown of albedo .95 to a given noise soonest, 7 % before the first.
inline constexpr float kRouletteWeight = 0.75f;

// A path of this many scatterings ends where it is: it can only be caught where nothing absorbs.
inline constexpr int kMostScatterings = 1'000'000;

// Shares of the arriving light that a surface sends back and lets pass [1], by Lambert's law, in each band.
template <int N>
struct SurfaceOptics {
  BandLanes<N> reflectance, transmittance;
};

enum class Fate { absorbed, reflected, passed };

// Where a path goes on to.
struct Onward {
  Fate fate = Fate::absorbed;
  glm::vec3 side{0.f};       // normal of the surface on the side the path leaves by, unit
  glm::vec3 direction{0.f};  // unit
};

// Whether a path goes on; a light one does so by chance, and then weighs kRouletteWeight in its brightest band.
template <int N>
bool survives(BandLanes<N>& weight, PathRandom& random) {
  const float largest = weight.largest();
  if (largest < kRouletteWeight) {
    if (random.uniform() * kRouletteWeight >= largest) return false;
    weight *= kRouletteWeight / largest;
  }
  return true;
}

// What becomes of a path that arrives with `weight`: which side it leaves by is drawn for all bands at once, by what
// they send there together, and the weights make up for it; a light path goes on by chance. Unbiased in every band. Of
// an absorbed path the weight means nothing.
template <int N>
Fate scatter(const SurfaceOptics<N>& optics, BandLanes<N>& weight, PathRandom& random) {
  const float reflected = dot(weight, optics.reflectance), passed = dot(weight, optics.transmittance);
  const float scattered = reflected + passed;
  if (!(scattered > 0.f)) return Fate::absorbed;
  const bool passes = random.uniform() * scattered >= reflected;
  weight *= passes ? optics.transmittance : optics.reflectance;
  weight *= scattered / (passes ? passed : reflected);
  if (!survives(weight, random)) return Fate::absorbed;
  return passes ? Fate::passed : Fate::reflected;
}

}  // namespace sunfleck::detail
