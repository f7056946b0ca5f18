#pragma once

#include <vector>

#include "core/progress.hpp"
#include "grid/deep_opacity_map.hpp"
#include "grid/instance_cells.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// How finely the geometry is sampled.
struct GeometryEffort {
  int light_resolution = 512;   // pixels along the longer side of the light's deep opacity map
  int sample_directions = 22;   // of the G-factor, even: both directions of half as many axes
  int sample_resolution = 256;  // pixels along the longer side of each of their maps
  int cells = 16;               // along the longest side of a tree
};

// What leaves and fragments read to be shaded, whatever their optics: the prototype's map along the light, and the
// cells of each tree with their G-factors.
struct StandGeometry {
  DeepOpacityMap light;
  CellGrid cells;
  std::vector<std::vector<float>> compensation;  // of each tree: G per cell [1], 0 .. 1
  double light_seconds = 0.;                     // wall time for the light's map
  double compensation_seconds = 0.;              // wall time for the sample maps, the depths of the cells and G
};

// The models hold numbers for every leaf of every tree.
inline constexpr std::size_t kMostTrees = 1024;

// Throws InvalidInput on a stand that the models cannot treat: one with a rotated tree, since a prototype's maps serve
// its translated copies only (Eq. 31), with more than kMostTrees trees, or with a period much shorter than the tree is
// wide.
void requireModelled(const Scene& scene);

// Throws InvalidInput as requireModelled() does, and std::runtime_error("interrupted") when `progress` ends it.
StandGeometry standGeometry(const Scene& scene, const GeometryEffort& effort, const Progress& progress = {});

}  // namespace sunfleck
