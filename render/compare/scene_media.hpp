#pragma once

#include <vector>

#include "core/progress.hpp"
#include "render/reference/trace_medium.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// (R15) A density grid as a medium: leaf area density times `scale`, and the leaves turned as the grid says in each
// cell, where it does and `oriented` asks for it: S = (5 M + 3 M^2) / 8 with M of (D7), so that light meets what (D8)
// says. Throws InvalidInput when there is not the memory for it.
MediumVoxels mediumVoxels(const DensityGrid& grid, float scale, bool oriented);

// The scene's media, for Monte Carlo. Throws InvalidInput on one without end in a stand without period, and as above.
std::vector<TraceMedium> traceMedia(const Scene& scene);

// The same scene with the leaves of each kind of trees as a medium: their density and orientation in cubic cells. Wood
// stays. Throws as DensityGrid::voxelizeStand().
//   cell_size  [m]
Scene turbid(const Scene& scene, float cell_size, const Progress& progress = {});

}  // namespace sunfleck
