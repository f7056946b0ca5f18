#pragma once

#include <array>
#include <string>
#include <vector>

#include "grid/leaf_depth.hpp"
#include "render/model.hpp"
#include "render/scene.hpp"
#include "render/stand_geometry.hpp"
#include "spp/power_table.hpp"

namespace sunfleck {

// What the models know of the leaves of each tree of a stand: all that does not depend on leaf optics.
struct LeafGeometry {
  std::vector<LeafDepths> depths;                // of each tree
  std::vector<std::vector<float>> compensation;  // G of each leaf of each tree [1], 0 .. 1
  std::vector<float> projections;                // |n.s0| of each leaf, the same for all trees [1]
  double depth_seconds = 0.;                     // wall time for depths and projections
  double compensation_seconds = 0.;              // wall time for G of the leaves from that of the cells
};
// `stand` is up to date for the scene, with G. Throws std::runtime_error("interrupted") when `progress` ends it.
LeafGeometry leafGeometry(const Scene& scene, const StandGeometry& stand, const Progress& progress = {});

// (R7) Irradiance of each leaf of the prototype, both sides together per one-sided area, for sun irradiance 1 on a
// plane facing the sun: the mean over the stand's trees [1].
//   exact  table of the exact solution, for the models that need it; without it they throw std::invalid_argument
std::vector<float> leafIrradiance(Model model, const LeafGeometry& geometry, const LeafOptics& optics,
                                  const spp::PowerTableOf& exact = {});

// Depth and thickness of each leaf, the mean over the stand's trees.
LeafDepths meanDepths(const LeafGeometry& geometry);

}  // namespace sunfleck
