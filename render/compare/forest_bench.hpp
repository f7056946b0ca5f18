#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/progress.hpp"

namespace sunfleck {

// What the light field of a large stand costs (F28), with nothing at hand but the meshes of four prototypes, random
// crowns of 10,000 leaves, turned in sixteen ways, in a sun and three bands.
struct ForestBenchRow {
  std::size_t trees = 0;
  std::size_t near = 0;                     // of them those solved leaf by leaf; the others' light is that of cells
  double leaves = 0.;                       // of all trees
  std::size_t cells = 0;                    // that hold something
  std::size_t elements = 0;                 // in them
  int cell_iterations = 0, iterations = 0;  // of the solution on cells, and of the trees'
  double seconds = 0., cpu_seconds = 0.;    // wall time, and of all threads
  double megabytes = 0.;                    // the most that the process has had so far
  double lost = 0.;                         // share of the light that the balance of the cells misses [1]
};

struct ForestBench {
  std::string machine;
  std::vector<ForestBenchRow> rows;
};

// Stands of 16 and 64 trees and on, by factors of four, up to `most_trees`. Ended early by `progress`: no rows.
//   most_near  trees solved leaf by leaf, those in the middle
ForestBench benchForests(std::size_t most_trees, std::size_t most_near, const Progress& progress = {});

std::string forestBenchCsv(const ForestBench& bench);

}  // namespace sunfleck
