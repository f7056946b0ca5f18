#pragma once

#include <vector>

#include "pp_solver/problem.hpp"
#include "pp_solver/solver.hpp"

namespace sunfleck::pp::detail {

// A layer as N directions can carry it (scaled_moments.hpp).
struct ScaledLayer {
  bool leaves = false;
  double scale = 1.;      // scaled over true depth, 1 - omega f [1]
  double thickness = 0.;  // scaled [1]
  double top = 0.;        // true depth of the layer's top
  double beam_path = 0.;  // scaled extinction above the layer, for a vertical path of the beam
  double true_thickness = 0.;
  double loss = 1.;      // 1 - scaled omega, exact near 0 [1]
  double albedo = 0.;    // true omega [1]
  double projection = 1.;  // G of the beam's direction; 1 for particles
  std::vector<double> scatter;       // scaled omega chi_l, l < N
  std::vector<double> true_scatter;  // omega chi_l of the true phase function, l <= N
};

// Makes `scaled` from `layer`; keeps its memory.
void scaleLayer(const Layer& layer, int streams, bool delta_m, ScaledLayer& scaled);

}  // namespace sunfleck::pp::detail
