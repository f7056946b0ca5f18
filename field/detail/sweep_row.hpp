#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

// (F14) One row of directions through cells, compiled for several instruction sets; sweepRow() is the best that this
// machine has.
namespace sunfleck::detail {

inline constexpr std::size_t kSweepLanes = 8;

// A cell's mean is this share of what leaves through a face and the rest of what enters through the opposite one. 1/2
// would be the plain diamond, whose errors that change sign from face to face never fade; these lose a fifth per cell.
inline constexpr float kOutwardShare = 0.55f;

// Every figure of a cell or a face stands for kSweepLanes directions of one octant, side by side, and where there are
// bands for one band after the other.
struct SweptRow {
  glm::ivec3 size;                  // [cell]
  bool backward[3];                 // whether the octant travels down the axis
  float rate[3][kSweepLanes];       // |mu| / (side of a cell * kOutwardShare) [1/m]
  const std::uint32_t* slot;        // of each cell, or none
  std::uint32_t none;               // slot of a cell that holds nothing
  const float* extinction;          // of each slot [1/m]
  const float* source;              // of each slot and band [1/m per the unit of radiance]
  float* mean;                      // to be written: mean radiance in the cell, of each slot and band
  float *face_x, *face_y, *face_z;  // radiance on faces: of (z, y), (z, x), (y, x), and band; in what enters, out what
                                    // leaves
  std::size_t bands;
};

// Sweeps the columns [begin, end) of cells, whole in z.
using SweepRow = void (*)(const SweptRow& row, glm::ivec2 begin, glm::ivec2 end);

SweepRow sweepRow();

}  // namespace sunfleck::detail
