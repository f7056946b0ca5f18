#pragma once

#include <span>

namespace sunfleck::spp {

// (S5) G of Shinya et al. 2013 Eq. 27: the share of the slab's light that a crown sends to a place, the mean over
// directions that cover the sphere evenly, any number of them. In [0, 1].
//   cosines    of each direction, away from the place, to the direction back to the light's plane [1], -1 .. 1
//   edges      optical distance to the edge of the foliage along each [1], >= 0, may be infinite; as many
//   depth      of the place below the lit face of the equivalent slab [1], >= 0
//   thickness  of that slab [1], > 0, may be infinite
//   mu0        |cos| of the light to the slab's normal [1], (0, 1]
float compensation(std::span<const float> cosines, std::span<const float> edges, float depth, float thickness,
                   float mu0);

// The same at many places at once, in vectors of the machine (spp/slab_arrays.hpp).
//   edges  a row of places for each direction
//   depth, thickness, compensation  of each place
void compensation(std::span<const float> cosines, std::span<const float> edges, std::span<const float> depth,
                  std::span<const float> thickness, float mu0, std::span<float> compensation);

}  // namespace sunfleck::spp
