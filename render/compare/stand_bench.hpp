#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"

namespace sunfleck {

// What a stand of trees costs to prepare for SPPG with 22 sample directions, and to change (the steps of Shinya et al.
// 2013, section 5.4). Wall times [s].
struct StandBenchRow {
  std::string stand;           // "16 cherry", or "1000 of 4 species"
  std::size_t prototypes = 0;  // species
  std::size_t trees = 0;
  std::size_t triangles = 0;  // of leaves and wood, all trees
  std::size_t cells = 0;      // with G, all trees
  double prepare = 0.;        // steps 2 and 3: opacity maps in the sample directions, depths of all cells, and their G
  double sky = 0.;            // step 4: environment light of all cells
  double light_map = 0.;      // step 5: a light's opacity map, per prototype
  double turn_sun = 0.;       // new light maps, and G of all cells
  double move_tree = 0.;      // one tree moved by a metre or so: depths, G and environment light of all it concerns
  double change_leaf = 0.;    // other leaf optics: environment light of all cells
  double megabytes = 0.;      // kept
};

struct StandBench {
  std::string machine;
  std::vector<StandBenchRow> rows;
};

// Stands of 16 and 64 cherries and maples, as in the paper, then stands of four species, 16 trees and more, by factors
// of four up to `most_trees`. The small ones are prepared three times, the median told. Before anything is timed, a
// stand with a moved tree must be the same to the bit as one made so afresh. Ended early by `progress`: no rows.
//   rounds  at least 1, of stands of up to 64 trees, of which the median is told; larger ones are measured once
StandBench benchStands(std::size_t most_trees, int rounds, const Progress& progress = {});

// The paper's figures for a stand of ours, of its own trees, on its machine of 2010 with a GPU [s]; none for others.
struct PaperStand {
  double prepare, sky, light_map;
};
std::optional<PaperStand> paperStand(const std::string& stand);

std::string standBenchCsv(const StandBench& bench);
std::string standBenchPlot(const StandBench& bench);  // SVG

}  // namespace sunfleck
