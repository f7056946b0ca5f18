#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "pp_solver/detail/first_scattering.hpp"
#include "pp_solver/detail/state.hpp"
#include "pp_solver/hot_spot.hpp"

namespace sunfleck::pp {

bool Solver::State::hasHotSpot() const {
  const auto* leaves = layers.size() == 1 ? std::get_if<LeafScattering>(&problem.layers[0].medium) : nullptr;
  return leaves != nullptr && leaves->hot_spot > 0. && beam > 0.;
}

// (P11) Light scattered once, by leaves or by the ground, escapes upward with dF more than from a turbid layer. It no
// longer meets leaves on its way up, where 1 - omega of it would be absorbed and omega scattered: those losses are
// taken from what the turbid layer reflects, absorbs and lets through, so that energy stays exact. What becomes of
// light scattered at depth z follows from reciprocity: it leaves at the top with probability J(z), the mean intensity
// under a sky of radiance 1, and arrives at the ground with that above a ground that sends out 1.
void Solver::State::findHotSpot() {
  hot_spot = {};
  if (!hasHotSpot()) return;
  const auto& leaves = std::get<LeafScattering>(problem.layers[0].medium);
  const detail::LayerRows& row = stack.layer[0];
  const double w = layers[0].thickness, kappa = row.rate[0], albedo = problem.ground.albedo, omega = layers[0].albedo;

  Problem lit = problem;
  lit.beam.reset();
  std::get<LeafScattering>(lit.layers[0].medium).hot_spot = 0.;
  Solver from_sky(settings), from_ground(settings);
  lit.above = 1.;
  from_sky.solve(lit);
  lit.above = 0.;
  lit.below = 1.;
  from_ground.solve(lit);

  double reflected = 0., once = 0.;  // of the turbid layer: all, and light scattered once
  double met = 0., to_top = 0., to_ground = 0.;
  const auto meet = [&](double z, double weight) {  // once scattered light on its way up that meets leaves at depth z
    double density = 0.;
    for (int i = 0; i < n; ++i) {
      const double mu = ordinates->mu()[i], root = std::sqrt(ordinates->weight()[i]),
                   g = tables[0]->nodes().projection(i);
      const double m = g / mu, up = 0.5 * (row.even_source[i] - row.odd_source[i]) / (root * mu);
      const double leaving = up * detail::onceUp(kappa, m, z, w);
      const double ground = albedo / std::numbers::pi * beam * mu0 * std::exp(-kappa * w - m * (w - z));
      density += root * root * g * (leaving + ground);
    }
    met += weight * density;
    to_top += weight * density * from_sky.fluxes(z).mean_intensity;
    to_ground += weight * density * from_ground.fluxes(z).mean_intensity;
  };
  using Gauss = boost::math::quadrature::gauss<double, 30>;
  for (std::size_t q = 0; q < Gauss::abscissa().size(); ++q)
    for (const double side : {-1., 1.}) meet(0.5 * w * (1. + side * Gauss::abscissa()[q]), Gauss::weights()[q]);
  const ScatteredOnce excess = hotSpotFlux(leaves, w, mu0);
  const double flux = (excess.leaves + albedo * excess.gap) / mu0;
  if (!(met > 0.)) return;
  hot_spot.reflected = flux * (1. - omega * to_top / met);
  hot_spot.transmitted = -flux * omega * to_ground / met;
  hot_spot.absorbed = -hot_spot.reflected - (1. - albedo) * hot_spot.transmitted;
  for (int i = 0; i < n; ++i) {
    const double mu = ordinates->mu()[i], weight = ordinates->weight()[i], m = tables[0]->nodes().projection(i) / mu;
    const double up = 0.5 * (row.even_source[i] - row.odd_source[i]) / (std::sqrt(weight) * mu);
    reflected += std::numbers::pi * basis.flat[i] * (stack.s_top[i] - stack.d_top[i]);
    once +=
        2. * std::numbers::pi * weight * mu *
        (up * detail::onceUp(kappa, m, 0., w) + albedo / std::numbers::pi * beam * mu0 * std::exp(-(m + kappa) * w));
  }
  const double higher = (reflected - once) / (beam * mu0);
  if (higher > 0.) hot_spot.again = std::max(0., 1. - (flux - hot_spot.reflected) / higher);
}

}  // namespace sunfleck::pp
