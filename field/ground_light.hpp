#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "field/cell_medium.hpp"
#include "field/line_exchange.hpp"
#include "field/stand_elements.hpp"
#include "grid/foliage_stand.hpp"

namespace sunfleck {

// (F31) Irradiance of the ground's cells by what leaves and wood send down to it, per band [unit of the light]. Light
// that comes to the ground beyond the cells is left out, unless these are a period.
//   radiance  of each element's front and back [unit of the light / sr]
// By lines: each that leaves the stand downward brings its light to where it meets the ground.
std::vector<glm::vec3> groundLight(const GroundGrid& grid, bool periodic, const StandElements& stand,
                                   const LineExchange& exchange, std::span<const glm::vec3> radiance);
// On cells: what leaves each of them comes to the ground as far as those below let it through. `radiance` is that of
// the medium's elements.
//   clumping  of each kind of tree [1]
//   shares    as groundShares() tells them
std::vector<glm::vec3> groundLight(const GroundGrid& grid, const CellMedium& medium, std::span<const float> clumping,
                                   std::span<const float> shares, std::span<const glm::vec3> radiance);
// Of what each slot of the medium sends in each direction that goes down, the share that leaves the cells [1]; it
// follows from these alone.
std::vector<float> groundShares(const CellMedium& medium, std::span<const float> clumping);

}  // namespace sunfleck
