#include "pp_solver/solver.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "pp_solver/detail/rounding.hpp"
#include "pp_solver/detail/state.hpp"

namespace sunfleck::pp {
namespace {

using detail::BasisRows;
using detail::LayerRows;
using detail::ScaledLayer;

constexpr double kPi = std::numbers::pi;

double relax(double x) {
  return x == 0. ? 1. : -std::expm1(-x) / x;
}

// -(d/dx) (1 - e^-x) / x, above 0
double relaxSlope(double x) {
  if (x > 1.) return (1. - std::exp(-x) * (1. + x)) / (x * x);
  double term = 0.5, sum = 0.;
  for (int l = 0; l < 20; ++l) {  // sum of (-x)^l (l + 1) / (l + 2)!
    sum += term * (l + 1.);
    term *= -x / (l + 3.);
  }
  return sum;
}

// Integral over z in (0, w) of (e^-kz - e^-qz) / (q - k).
double integralOfDifference(double k, double q, double w) {
  if (std::isinf(w)) return 1. / (k * q);
  const double a = std::min(k, q) * w, b = std::max(k, q) * w;
  if (b - a > 1.) return w * w * (relax(a) - relax(b)) / (b - a);
  return w * w *
         boost::math::quadrature::gauss<double, 10>::integrate(
             [&](double x) { return relaxSlope(a + 0.5 * (1. + x) * (b - a)); }, -1., 1.) *
         0.5;
}

}  // namespace

Solver::Solver(Settings settings) {
  require(settings.streams >= 2 && settings.streams <= 256 && settings.streams % 2 == 0, "streams", settings.streams,
          "even, 2 to 256");
  require(settings.azimuth_tolerance >= 0. && settings.azimuth_tolerance < 1., "azimuth_tolerance",
          settings.azimuth_tolerance, "in [0, 1)");
  state_ = std::make_unique<State>(settings);
}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

Solver::State& Solver::solved() const {
  require(state_->solved, "problems solved", 0, "one before its light is asked for");
  return *state_;
}

void Solver::solve(const Problem& problem) {
  State& s = *state_;
  s.solved = false;
  requireSolvable(problem);
  s.dropLeafTables(problem);
  s.problem = problem;
  s.mu0 = problem.beam ? problem.beam->mu0 : 1.;
  s.beam = problem.beam ? problem.beam->irradiance : 0.;
  s.layers.resize(problem.layers.size());
  s.any_leaves = false;
  s.depth = 0.;
  double path = 0.;
  for (std::size_t p = 0; p < s.layers.size(); ++p) {
    scaleLayer(problem.layers[p], s.settings.streams, s.settings.delta_m, s.layers[p]);
    if (s.layers[p].leaves) s.prepareLeaves(p);
    s.layers[p].top = s.depth;
    s.layers[p].beam_path = path;
    path += s.layers[p].projection * s.layers[p].thickness;
    s.depth += s.layers[p].true_thickness;
    s.any_leaves |= s.layers[p].leaves;
  }
  s.solveBundle(s.basis, s.stack, false);
  for (std::size_t p = 0; p < s.layers.size(); ++p) {
    LayerRows& row = s.stack.layer[p];
    if (row.given_modes) continue;
    for (int j = 0; j < s.n; ++j) row.x_mean[j] = row.x_absorb[j] = row.x[j * s.basis.row];
  }
  s.incident = s.mu0 * s.beam;
  for (int i = 0; i < s.n; ++i) {
    const double weight = 2. * kPi * s.ordinates->weight()[i] * s.ordinates->mu()[i];
    s.incident += weight * (s.skyMode(problem.above, 0, s.ordinates->mu()[i], false) +
                            (std::isinf(s.depth) ? 0. : s.skyMode(problem.below, 0, s.ordinates->mu()[i], false)));
  }
  s.findHotSpot();
  s.solved = true;
}

double Solver::incident() const {
  return solved().incident;
}

double Solver::reflectance() const {
  const State& s = solved();
  double up = 0.;
  for (int i = 0; i < s.n; ++i) up += s.basis.flat[i] * (s.stack.s_top[i] - s.stack.d_top[i]);
  return detail::withoutRounding(kPi * up / s.incident + s.hot_spot.reflected);
}

double Solver::transmittance() const {
  const State& s = solved();
  if (std::isinf(s.depth)) return 0.;
  double down = 0.;
  for (int i = 0; i < s.n; ++i) down += s.basis.flat[i] * (s.stack.s_bottom[i] + s.stack.d_bottom[i]);
  return detail::withoutRounding((kPi * down + s.beamOnGround()) / s.incident + s.hot_spot.transmitted);
}

double Solver::direct() const {
  const State& s = solved();
  return s.beam == 0. || std::isinf(s.depth) ? 0. : s.beam * s.mu0 * s.trueBeam(s.depth) / s.incident;
}

double Solver::absorptance() const {
  const State& s = solved();
  double absorbed = 0.;
  for (std::size_t p = 0; p < s.layers.size(); ++p) {
    const ScaledLayer& layer = s.layers[p];
    const LayerRows& row = s.stack.layer[p];
    if (layer.loss == 0.) continue;
    const double rate = row.rate[0], w = layer.thickness;
    double sum = 0.;
    for (int j = 0; j < s.n; ++j) {
      const double ends = row.infinite ? row.u_top[j] / row.k[j] : row.s[j] * (row.u_top[j] + row.u_bottom[j]);
      sum += row.x_absorb[j] * (ends + row.g[j] * integralOfDifference(row.k[j], rate, w));
    }
    const double beam = s.beam * s.scaledBeam(p) * layer.projection * (row.infinite ? 1. / rate : w * relax(rate * w));
    absorbed += layer.loss * (2. * kPi * sum + beam);
  }
  return absorbed / s.incident + s.hot_spot.absorbed;
}

Fluxes Solver::fluxes(double depth) const {
  const State& s = solved();
  const auto [p, inside] = s.placeAt(depth);
  const ScaledLayer& layer = s.layers[p];
  const LayerRows& row = s.stack.layer[p];
  const double z = inside * layer.scale;
  s.kernel.single.fieldAt(s.basis, row, &z, s.u_row, s.v_row);
  double sum = 0., difference = 0., mean = 0., met = 0.;
  for (int j = 0; j < s.n; ++j) {
    sum += row.x_flux[j] * s.u_row[j];
    difference += row.y_flux[j] * s.v_row[j];
    mean += row.x_mean[j] * s.u_row[j];
    met += row.x_absorb[j] * s.u_row[j];
  }
  const double share = layer.thickness > 0. && !std::isinf(layer.thickness) ? z / layer.thickness : 0.;
  const double planck = row.planck_top[0] + share * (row.planck_bottom[0] - row.planck_top[0]);
  double drift = 0.;
  for (int i = 0; i < s.n; ++i) drift += 2. * kPi * s.basis.flat[i] * row.drift[i];
  const double scaled = s.beam * s.scaledBeam(p, inside), direct = s.beam * s.mu0 * s.trueBeam(depth);
  Fluxes fluxes;
  fluxes.up = detail::withoutRounding(kPi * (sum - difference + planck) - drift, std::abs(sum) + std::abs(difference));
  fluxes.down = detail::withoutRounding(kPi * (sum + difference + planck) + drift + (s.mu0 * scaled - direct),
                                        std::abs(sum) + std::abs(difference) + s.mu0 * scaled);
  fluxes.direct = direct;
  if (s.hasHotSpot() && depth == 0.) fluxes.up += s.hot_spot.reflected * s.incident;
  if (s.hasHotSpot() && inside == layer.true_thickness) {
    fluxes.down += s.hot_spot.transmitted * s.incident;
    fluxes.up += s.problem.ground.albedo * s.hot_spot.transmitted * s.incident;
  }
  fluxes.mean_intensity = 0.5 * mean + planck + scaled / (4. * kPi);
  fluxes.leaf_irradiance =
      layer.leaves ? 2. * kPi * (met + planck) + scaled * layer.projection : 2. * kPi * fluxes.mean_intensity;
  return fluxes;
}

double Solver::absorbed(double depth0, double depth1) const {
  const Fluxes top = fluxes(depth0), bottom = fluxes(depth1);
  return (top.down + top.direct - top.up) - (bottom.down + bottom.direct - bottom.up);
}

int Solver::azimuthModes() const {
  return state_->modes_used;
}

double Solver::radiance(double depth, double mu, double phi) {
  double result = 0.;
  radiances({&depth, 1}, {&mu, 1}, {&phi, 1}, {&result, 1});
  return result;
}

}  // namespace sunfleck::pp
