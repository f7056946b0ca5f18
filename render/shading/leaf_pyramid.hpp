#pragma once

#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/leaf_maps.hpp"

namespace sunfleck::shading {

// (R37) Leaf maps as pictures read them: all places, rows from top to bottom, then the same of maps half as wide and
// high, rounded up, and so on to a single place. A place of those is the mean of four by their leaf area, evenly where
// there is none.
struct LeafPyramid {
  int width = 0, height = 0;
  std::vector<glm::vec4> numbers;  // kLeafPlaceGroups of each place: see surface_types.glsl
};

//   shares  leafAreaShares() of the maps' size
// Works in parallel.
LeafPyramid leafPyramid(const LeafMaps& maps, std::span<const float> shares);

}  // namespace sunfleck::shading
