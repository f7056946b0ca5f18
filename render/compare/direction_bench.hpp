#pragma once

#include <string>
#include <vector>

#include "core/progress.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// How far the G-factor of a tree's cells is off with so many sample directions (D5).
struct DirectionBenchPoint {
  int directions = 0;         // both directions of half as many axes
  bool spread = true;         // by spreadAxes(); else axes at random, to be compared with
  double seconds = 0.;        // wall time for the opacity maps, the depths of the cells and G, mean over the turns
  double rms_error = 0.;      // of G over the active cells, RMS over the turns as well [1]
  double largest_error = 0.;  // [1]
};

// G of the first tree of a scene with 8, 16, 22, 32, 48, 64, 96 and 192 directions, each set turned at random a few
// times, against 1,024 directions. Ended early by `progress`: an empty list. Throws InvalidInput on a scene that the
// models cannot treat.
std::vector<DirectionBenchPoint> benchDirections(const Scene& scene, std::uint64_t seed, const Progress& progress = {});

std::string directionBenchCsv(const std::vector<DirectionBenchPoint>& points);
std::string directionBenchPlot(const std::vector<DirectionBenchPoint>& points, const std::string& scene);  // SVG

}  // namespace sunfleck
