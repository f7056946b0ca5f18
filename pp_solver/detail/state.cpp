#include "pp_solver/detail/state.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunfleck::pp {
namespace {

using detail::BasisRows;
using detail::LayerRows;
using detail::ScaledLayer;
using detail::StackRows;

constexpr double kPi = std::numbers::pi;
constexpr int kMostLanes = 16;

}  // namespace

double legendreStart(const BasisRows& basis, int lane, double mu) {
  const double m = basis.mode[lane];
  return m == 0. ? 1. : basis.peak[lane] * std::pow((1. - mu) * (1. + mu), 0.5 * m);
}

Solver::State::State(const Settings& s)
    : settings(s),
      n(s.streams / 2),
      ordinates(Ordinates::of(s.streams)),
      basis(*ordinates, 0, true, detail::kernel().lanes, false),
      u_row(memory.take(basis.row)),
      v_row(memory.take(basis.row)) {}

const BasisRows& Solver::State::bundle(int first_mode) {
  auto& found = bundles[first_mode];
  const bool wide = !any_leaves && kernel.lanes > 1;
  if (!found || (found->lanes > 1) != wide)
    found = std::make_unique<BasisRows>(*ordinates, first_mode, true, kernel.lanes, wide);
  return *found;
}

double Solver::State::skyMode(const Sky& sky, int m, double mu, bool sine) const {
  if (const double* radiance = std::get_if<double>(&sky)) return m == 0 && !sine ? *radiance : 0.;
  const auto& function = std::get<1>(sky);
  if (!function || m >= settings.streams) return 0.;
  const int samples = std::max(64, 4 * settings.streams);
  const double phi0 = problem.beam ? problem.beam->azimuth : 0.;
  double sum = 0.;
  for (int i = 0; i < samples; ++i) {
    const double phi = 2. * kPi * (i + 0.5) / samples;
    sum += function(mu, phi0 + phi) * (sine ? std::sin(m * phi) : std::cos(m * phi));
  }
  return (m == 0 ? 1. : 2.) * sum / samples;
}

double Solver::State::scaledBeam(std::size_t index, double depth_in_layer) const {
  const ScaledLayer& layer = layers[index];
  return std::exp(-(layer.beam_path + layer.scale * layer.projection * depth_in_layer) / mu0);
}

double Solver::State::trueBeam(double depth_below_top) const {
  double path = 0.;
  for (const ScaledLayer& layer : layers) {
    const double inside = std::clamp(depth_below_top - layer.top, 0., layer.true_thickness);
    if (inside > 0.) path += layer.projection * inside;
  }
  return std::exp(-path / mu0);
}

std::size_t Solver::State::layerAt(double depth_below_top) const {
  std::size_t index = 0;
  while (index + 1 < layers.size() && depth_below_top >= layers[index + 1].top) ++index;
  return index;
}

void Solver::State::fillLayer(const BasisRows& rows, LayerRows& row, std::size_t index, bool sine) {
  const ScaledLayer& layer = layers[index];
  const auto& path = pathOf(rows);
  const int lanes = rows.lanes, streams = settings.streams;
  row.infinite = std::isinf(layer.true_thickness);
  row.given_modes = layer.leaves;
  const double amplitude = sine ? 0. : beam * scaledBeam(index);
  alignas(64) double mu[kMostLanes], first[kMostLanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const int m = static_cast<int>(rows.mode[lane]);
    for (int j = 0; j < streams; ++j) {
      const bool carried = m + j < streams;
      row.scatter[j * lanes + lane] = carried ? layer.scatter[m + j] : 0.;
      row.loss[j * lanes + lane] = 1. - row.scatter[j * lanes + lane];
    }
    if (m == 0) row.loss[lane] = layer.loss;
    row.thickness[lane] = layer.thickness;
    row.rate[lane] = layer.projection / mu0;
    mu[lane] = mu0;
    first[lane] = legendreStart(rows, lane, mu0) * amplitude * (m == 0 ? 1. : 2.) / (2. * kPi);
    const Layer& given = problem.layers[index];
    const bool emits = m == 0 && !sine;
    row.planck_top[lane] = emits ? given.emission_top : 0.;
    row.planck_bottom[lane] = emits ? given.emission_bottom : 0.;
    row.planck_drift[lane] =
        emits && given.emission_top != given.emission_bottom
            ? -(given.emission_bottom - given.emission_top) / (layer.thickness * row.loss[1 * lanes + lane])
            : 0.;
  }
  if (layer.leaves) {
    detail::LeafTables& table = *tables[index];
    const auto& leaves = std::get<LeafScattering>(problem.layers[index].medium);
    const int m = static_cast<int>(rows.mode[0]);
    std::vector<double> even(n), odd(n);
    table.fromBeam(m).evenOdd(leaves.reflectance, leaves.transmittance, even, odd);
    const double share = amplitude * (m == 0 ? 1. : 2.) / (2. * kPi);
    for (int i = 0; i < n; ++i) {
      row.even_source[i] = share * std::sqrt(ordinates->weight()[i]) * even[i];
      row.odd_source[i] = share * std::sqrt(ordinates->weight()[i]) * odd[i];
    }
    leafModes(rows, row, table, leaves, ordinates->weight());
    return;
  }
  path.scatterRows(rows, row.scatter, mu, first, row.even_source, row.odd_source);
}

// The ground and what arrives from outside, as hats: sqrt(w mu) times radiance.
void Solver::State::fillGround(const BasisRows& rows, StackRows& stack_rows, bool sine) {
  const int lanes = rows.lanes;
  const Ground& ground = problem.ground;
  const bool infinite = std::isinf(depth);
  const double arriving = sine || infinite ? 0. : beam * mu0 * scaledBeam(layers.size() - 1, layers.back().true_thickness);
  const bool shaped = ground.brdf && !infinite;
  stack_rows.black = infinite || !(shaped || ground.albedo > 0.);
  for (int lane = 0; lane < lanes; ++lane) {
    const int m = static_cast<int>(rows.mode[lane]);
    const bool flat_mode = m == 0 && !sine;
    Eigen::VectorXd source(n), flat(n);
    for (int i = 0; i < n; ++i) {
      const double mu = ordinates->mu()[i], hat = rows.flat[i * lanes + lane];
      stack_rows.top_in[i * lanes + lane] = 2. * hat * skyMode(problem.above, m, mu, sine);
      source[i] = hat * (infinite ? 0. : skyMode(problem.below, m, mu, sine));
      flat[i] = hat;
    }
    if (stack_rows.black) {
      for (int i = 0; i < n; ++i)
        stack_rows.bottom_in[i * lanes + lane] =
            2. * (source[i] + (flat_mode && !infinite ? flat[i] * ground.emission : 0.));
      continue;
    }
    Eigen::MatrixXd matrix;
    Eigen::VectorXd row;
    if (!shaped) {
      // Z = 1 - (2 A / (1 + A)) q q^T exactly, q = sqrt(2 w mu) of length 1
      const double share = flat_mode ? ground.albedo / (1. + ground.albedo) : 0.;
      if (flat_mode) source += flat * ((1. - ground.albedo) * ground.emission + ground.albedo * arriving / kPi);
      matrix = Eigen::MatrixXd::Identity(n, n) - 4. * share * flat * flat.transpose();
      row = -2. * (source - 2. * share * flat * flat.dot(source));
    } else {
      Eigen::MatrixXd reflect = Eigen::MatrixXd::Zero(n, n);
      if (m < ground.brdf_modes)
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j)
            reflect(i, j) = flat[i] * flat[j] * kPi * (m == 0 ? 2. : 1.) *
                            ground.brdf(m, ordinates->mu()[i], ordinates->mu()[j]);
      reflect = 0.5 * (reflect + reflect.transpose()).eval();
      if (flat_mode) source += ground.emission * (flat - reflect * flat);
      if (m < ground.brdf_modes)
        for (int i = 0; i < n; ++i) source[i] += flat[i] * ground.brdf(m, ordinates->mu()[i], mu0) * arriving;
      const Eigen::LDLT<Eigen::MatrixXd> solve(Eigen::MatrixXd::Identity(n, n) + reflect);
      matrix = solve.solve(Eigen::MatrixXd::Identity(n, n) - reflect);
      matrix = 0.5 * (matrix + matrix.transpose()).eval();
      row = -2. * solve.solve(source);
    }
    for (int i = 0; i < n; ++i) {
      stack_rows.ground_row[i * lanes + lane] = row[i];
      for (int j = 0; j < n; ++j) stack_rows.ground_matrix[i * rows.row + j * lanes + lane] = matrix(i, j);
    }
  }
}

double Solver::State::projectionOf(std::size_t index, double mu) const {
  if (!layers[index].leaves) return 1.;
  return tables[index]->viewProjection(mu);
}

void Solver::State::prepareLeaves(std::size_t index) {
  const LeafAngles& angles = std::get<LeafScattering>(problem.layers[index].medium).angles;
  tables.resize(layers.size());
  auto found = std::find_if(leaf_tables.begin(), leaf_tables.end(),
                            [&](const auto& table) { return table->angles() == angles; });
  if (found == leaf_tables.end())
    found = leaf_tables.insert(
        found, std::make_unique<detail::LeafTables>(angles, ordinates->mu(), ordinates->weight()));
  tables[index] = found->get();
  tables[index]->setBeam(mu0);
  layers[index].projection = tables[index]->beamProjection();
}

void Solver::State::beamSource(const BasisRows& rows, int lane, std::size_t index, double mu, double& down,
                               double& up) const {
  const int m = static_cast<int>(rows.mode[lane]), streams = settings.streams, lanes = rows.lanes;
  const double amplitude = beam * scaledBeam(index) * (m == 0 ? 1. : 2.) / (4. * kPi);
  if (layers[index].leaves) {
    const auto& leaves = std::get<LeafScattering>(problem.layers[index].medium);
    const LeafKernel& scattering = tables[index]->beamIntoViews(m);
    std::vector<double> even(scattering.modulus.size()), odd(scattering.modulus.size());
    scattering.evenOdd(leaves.reflectance, leaves.transmittance, even, odd);
    const std::size_t i = tables[index]->viewAt(mu);
    const double share = amplitude / tables[index]->viewProjection(mu);
    down = share * (even[i] + odd[i]);
    up = share * (even[i] - odd[i]);
    return;
  }
  double now = legendreStart(rows, lane, mu), before = 0., now0 = legendreStart(rows, lane, mu0), before0 = 0.;
  down = up = 0.;
  for (int j = 0; m + j < streams; ++j) {
    const double norm = rows.norm[j * lanes + lane], a = rows.up[j * lanes + lane], b = rows.down[j * lanes + lane];
    const double term = amplitude * norm * norm * layers[index].scatter[m + j] * now * now0;
    down += term;
    up += j % 2 == 0 ? term : -term;
    const double next = a * mu * now - b * before, next0 = a * mu0 * now0 - b * before0;
    before = now;
    now = next;
    before0 = now0;
    now0 = next0;
  }
}

double Solver::State::groundRadiance(const BasisRows& rows, const StackRows& stack_rows, int lane, double mu,
                                     bool sine) const {
  if (std::isinf(depth)) return 0.;
  const int m = static_cast<int>(rows.mode[lane]), lanes = rows.lanes;
  const Ground& ground = problem.ground;
  const bool flat_mode = m == 0 && !sine;
  if (!ground.brdf && !flat_mode) return 0.;
  const double arriving = sine ? 0. : beam * mu0 * scaledBeam(layers.size() - 1, layers.back().true_thickness);
  double radiance = 0., albedo = ground.albedo;
  if (ground.brdf) {
    albedo = 0.;
    if (m >= ground.brdf_modes) return flat_mode ? ground.emission : 0.;
    radiance = arriving * ground.brdf(m, mu, mu0);
  } else {
    radiance = albedo * arriving / kPi;
  }
  for (int i = 0; i < n; ++i) {
    const double hat = 0.5 * (stack_rows.s_bottom[i * lanes + lane] + stack_rows.d_bottom[i * lanes + lane]);
    const double flux = rows.flat[i * lanes + lane] * hat;  // w mu I+
    const double node = ordinates->mu()[i];
    if (ground.brdf) {
      const double f = ground.brdf(m, mu, node);
      radiance += kPi * (m == 0 ? 2. : 1.) * f * flux;
      if (flat_mode) albedo += 2. * kPi * f * node * ordinates->weight()[i];
    } else {
      radiance += 2. * albedo * flux;
    }
  }
  return radiance + (flat_mode ? (1. - albedo) * ground.emission : 0.);
}

void Solver::State::solveBundle(const BasisRows& rows, StackRows& stack_rows, bool sine) {
  detail::shape(stack_rows, rows, static_cast<int>(layers.size()));
  for (std::size_t p = 0; p < layers.size(); ++p) fillLayer(rows, stack_rows.layer[p], p, sine);
  fillGround(rows, stack_rows, sine);
  pathOf(rows).solve(rows, stack_rows);
}

double Solver::State::leafView(const BasisRows& rows, std::size_t index, double mu, double* even,
                               double* odd) const {
  const auto& leaves = std::get<LeafScattering>(problem.layers[index].medium);
  const LeafKernel& scattering = tables[index]->intoViews(static_cast<int>(rows.mode[0]));
  std::vector<double> all_even(scattering.modulus.size()), all_odd(scattering.modulus.size());
  scattering.evenOdd(leaves.reflectance, leaves.transmittance, all_even, all_odd);
  const std::size_t first = tables[index]->viewAt(mu) * n;
  for (int i = 0; i < n; ++i) {
    const double root = std::sqrt(ordinates->weight()[i]);
    even[i] = root * all_even[first + i];
    odd[i] = root * all_odd[first + i];
  }
  return 1. / tables[index]->viewProjection(mu);
}

}  // namespace sunfleck::pp
