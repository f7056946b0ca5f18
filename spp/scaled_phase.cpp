#include "spp/detail/scaled_phase.hpp"

#include <vector>

namespace sunfleck::spp::detail {

using Eigen::Index;
using Eigen::VectorXd;

ScaledPhase::ScaledPhase(const Particles& particles, int n) : albedo(particles.albedo), lost(1. - particles.albedo) {
  true_moments.resize(2 * n);
  particles.phase.moments({true_moments.data(), static_cast<std::size_t>(2 * n)});
  moments = beam_moments = true_moments;
}

void ScaledPhase::weigh() {
  for (VectorXd* chi : {&moments, &beam_moments, &true_moments})
    for (Index l = 0; l < chi->size(); ++l) (*chi)[l] *= static_cast<double>(2 * l + 1);
}

ScaledPhase ScaledPhase::delta(const Particles& particles, int n) {
  ScaledPhase scaled(particles, n);
  std::vector<double> chi(static_cast<std::size_t>(2 * n + 1));
  particles.phase.moments(chi);
  const double peak = chi[chi.size() - 1], before = chi[chi.size() - 2];
  if (peak > 0. && before >= peak) {
    const double kept = 1. - peak;
    scaled.moments = scaled.beam_moments = (scaled.true_moments.array() - peak) / kept;
    scaled.depth_scale = scaled.lost + scaled.albedo * kept;
    scaled.albedo *= kept / scaled.depth_scale;
    scaled.lost /= scaled.depth_scale;
  } else if (peak > 0. && before < 0.) {
    scaled.turned_back = peak;
    for (Index l = 0; l < scaled.moments.size(); ++l) scaled.moments[l] -= l % 2 == 0 ? peak : -peak;
  }
  scaled.weigh();
  return scaled;
}

// Cesaro's means of the second kind, which leave a positive function positive.
ScaledPhase ScaledPhase::smoothed(const Particles& particles, int n) {
  ScaledPhase scaled = delta(particles, n);
  for (Index l = 0; l < scaled.moments.size(); ++l) {
    const double order = static_cast<double>(l), kept = (1. - order / (2 * n)) * (1. - order / (2 * n + 1));
    scaled.moments[l] *= kept;
    scaled.beam_moments[l] *= kept;
  }
  return scaled;
}

}  // namespace sunfleck::spp::detail
