#pragma once

#include <vector>

#include "grid/cell_grid.hpp"
#include "grid/deep_opacity_map.hpp"

namespace sunfleck::detail {

// What the lines of an opacity map meet in one part of space, integrated along each line within the part and summed.
struct PartSums {
  float length = 0.f;                // of the lines [m]
  float before = 0.f, beyond = 0.f;  // leaf crossings before and beyond, times [m]
  float behind_first_wood = 0.f;     // [m]: what light along the map's direction does not reach
  float before_last_wood = 0.f;      // [m]: what light against it does not reach; both 0 for a map without its wood

  PartSums& operator+=(const PartSums& other);
};

// (D4) Of all parts; works in parallel and gives the same bits for any number of threads.
//   every  each how manieth line of the map is walked along, in both directions
std::vector<PartSums> sumsOverParts(const CellGrid& parts, const DeepOpacityMap& map, int every);

}  // namespace sunfleck::detail
