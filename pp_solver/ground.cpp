#include "pp_solver/ground.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace sunfleck::pp {

Ground groundOf(std::function<double(double mu, double mu_in, double azimuth)> brdf, int modes, int samples) {
  Ground ground;
  ground.brdf_modes = modes;
  ground.brdf = [brdf = std::move(brdf), samples](int mode, double mu, double mu_in) {
    double sum = 0.;
    for (int i = 0; i < samples; ++i) {
      const double azimuth = 2. * std::numbers::pi * (i + 0.5) / samples;
      sum += brdf(mu, mu_in, azimuth) * std::cos(mode * azimuth);
    }
    return (mode == 0 ? 1. : 2.) * sum / samples;
  };
  return ground;
}

}  // namespace sunfleck::pp
