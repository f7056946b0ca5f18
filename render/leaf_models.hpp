#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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
  std::vector<std::vector<float>> compensation;  // G of each leaf of each tree [1], 0 .. 1; empty without it
  std::vector<std::vector<float>> projections;   // |n.s0| of each leaf of each kind, each turn counted [1]
  std::vector<std::size_t> kind_of_tree;         // of these
  // The scene's kinds: of each tree, and where their leaves are in what is told of all leaves, kind after kind.
  std::vector<std::uint32_t> scene_kind_of_tree;
  std::vector<std::size_t> first_leaf;  // one more at the end: all
  double depth_seconds = 0.;            // wall time for depths and projections
  double compensation_seconds = 0.;     // wall time for G of the leaves from that of the cells
};
// `stand` is up to date for the scene, with G where a model asks for it. Throws std::runtime_error("interrupted") when
// `progress` ends it.
LeafGeometry leafGeometry(const Scene& scene, const StandGeometry& stand, const Progress& progress = {});

// (R7) Irradiance of each leaf of the prototypes, kind after kind, both sides together per one-sided area, for sun
// irradiance 1 on a plane facing the sun: the mean over the stand's trees of the kind [1].
//   optics  of each kind of the scene
//   exact   table of the exact solution, for the models that need it; without it they throw std::invalid_argument
std::vector<float> leafIrradiance(Model model, const LeafGeometry& geometry, std::span<const LeafOptics> optics,
                                  const spp::PowerTableOf& exact = {});

// Depth and thickness of each leaf, kind after kind, the mean over the stand's trees of the kind.
LeafDepths meanDepths(const LeafGeometry& geometry);

}  // namespace sunfleck
