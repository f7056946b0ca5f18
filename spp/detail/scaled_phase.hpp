#pragma once

#include <Eigen/Core>

#include "scattering/medium.hpp"

namespace sunfleck::spp::detail {

// (S13) Particles as 2 n moments can hold them.
struct ScaledPhase {
  double depth_scale = 1.;                              // s
  double albedo, lost;                                  // omega' and 1 - omega' of the scaled medium
  double turned_back = 0.;                              // share of omega' that a backward peak holds
  Eigen::VectorXd moments, beam_moments, true_moments;  // 2 l + 1 times chi_l, l < 2 n, of what is scattered

  // With f the first moment left out, a peak is set apart: scattering within a forward peak counts as none; a backward
  // peak turns diffuse light back into the opposite stream. The beam is spread by the backward peak as the moments have
  // it, for turned back it would be a second beam.
  static ScaledPhase delta(const Particles& particles, int n);

  // The same with the rest of the series smoothed, for phase functions whose series would scatter more than is met.
  static ScaledPhase smoothed(const Particles& particles, int n);

 private:
  ScaledPhase(const Particles& particles, int n);
  void weigh();
};

}  // namespace sunfleck::spp::detail
