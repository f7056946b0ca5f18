#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "scattering/medium.hpp"

namespace sunfleck::spp::detail {

// (S14) Particles as 2 n moments can hold them. With f the first moment left out, a peak of the phase function is set
// apart: scattering within a forward peak counts as none; a backward peak turns diffuse light back into the opposite
// stream.
struct ScaledPhase {
  double depth_scale = 1.;                              // s
  double albedo, lost;                                  // omega' and 1 - omega' of the scaled medium
  double turned_back = 0.;                              // share of omega' that a backward peak holds
  Eigen::VectorXd moments, beam_moments, true_moments;  // 2 l + 1 times chi_l without the peak, l < 2 n

  ScaledPhase(const Particles& particles, int n) : albedo(particles.albedo), lost(1. - particles.albedo) {
    const Eigen::Index rows = 2 * n;
    std::vector<double> chi(static_cast<std::size_t>(rows) + 1);
    particles.phase.moments(chi);
    true_moments = Eigen::Map<const Eigen::VectorXd>(chi.data(), rows);
    const double peak = chi[chi.size() - 1], before = chi[chi.size() - 2];
    moments = beam_moments = true_moments;
    if (peak > 0. && before >= peak) {
      moments = beam_moments = (true_moments.array() - peak) / (1. - peak);
      depth_scale = lost + albedo * (1. - peak);
      albedo *= (1. - peak) / depth_scale;
      lost /= depth_scale;
    } else if (peak > 0. && before < 0.) {
      turned_back = peak;
      for (Eigen::Index l = 0; l < rows; ++l) moments[l] -= l % 2 == 0 ? peak : -peak;
    }
    const auto orders = Eigen::VectorXd::LinSpaced(rows, 1., 4. * n - 1.);  // 2 l + 1
    for (Eigen::VectorXd* weighted : {&moments, &beam_moments, &true_moments}) weighted->array() *= orders.array();
  }
};

}  // namespace sunfleck::spp::detail
