#include "pp_solver/detail/state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/require.hpp"

namespace sunfleck::pp {
namespace {

using detail::BasisRows;
using detail::LayerRows;
using detail::ScaledLayer;
using detail::StackRows;

constexpr double kPi = std::numbers::pi;
// Rounding of h (P14) goes as 1 / w: in thinner layers it would exceed what the slope does.
constexpr double kLeastSloped = 1e-6;

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
  const bool wide = !any_leaves && !settings.collocation && kernel.lanes > 1;
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
    const double radiance = function(mu, phi0 + phi);
    require(std::isfinite(radiance) && radiance >= 0., "sky radiance at mu " + std::to_string(mu), radiance,
            "finite and no less than 0");
    sum += radiance * (sine ? std::sin(m * phi) : std::cos(m * phi));
  }
  return (m == 0 ? 1. : 2.) * sum / samples;
}

double Solver::State::planckSlope(const LayerRows& row, int lane) {
  const double difference = row.planck_bottom[lane] - row.planck_top[lane];
  return difference == 0. ? 0. : difference / row.thickness[lane];
}

double Solver::State::scaledBeam(std::size_t index, double depth_in_layer) const {
  const ScaledLayer& layer = layers[index];
  return std::exp(-(layer.beam_path + layer.scale * layer.projection * depth_in_layer) / mu0);
}

double Solver::State::beamOnGround() const {
  return beam * mu0 * scaledBeam(layers.size() - 1, layers.back().true_thickness);
}

double Solver::State::trueBeam(double depth_below_top) const {
  double path = 0.;
  for (const ScaledLayer& layer : layers) {
    const double inside = std::clamp(depth_below_top - layer.top, 0., layer.true_thickness);
    if (inside > 0.) path += layer.projection * inside;
  }
  return std::exp(-path / mu0);
}

Solver::State::Place Solver::State::placeAt(double depth_below_top) const {
  constexpr double kRounding = 1e-12;
  require(depth_below_top >= 0. && depth_below_top <= depth * (1. + kRounding) && !std::isinf(depth_below_top), "depth",
          depth_below_top, "finite and within the layers");
  if (depth_below_top >= depth) return {layers.size() - 1, layers.back().true_thickness};
  std::size_t index = 0;
  while (index + 1 < layers.size() && depth_below_top >= layers[index + 1].top) ++index;
  return {index, std::min(depth_below_top - layers[index].top, layers[index].true_thickness)};
}

void Solver::State::fillLayer(const BasisRows& rows, LayerRows& row, std::size_t index, bool sine) {
  const ScaledLayer& layer = layers[index];
  const auto& path = pathOf(rows);
  const int lanes = rows.lanes, streams = settings.streams;
  row.infinite = std::isinf(layer.true_thickness);
  row.given_modes = layer.leaves || settings.collocation;
  const double amplitude = sine ? 0. : beam * scaledBeam(index);
  alignas(64) double mu[detail::kMostLanes], first[detail::kMostLanes];
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
    const bool mean = layer.thickness < kLeastSloped;
    const double at_mean = 0.5 * given.emission_top + 0.5 * given.emission_bottom;
    row.planck_top[lane] = !emits ? 0. : mean ? at_mean : given.emission_top;
    row.planck_bottom[lane] = !emits ? 0. : mean ? at_mean : given.emission_bottom;
    const double drift = -planckSlope(row, lane) / row.loss[1 * lanes + lane];
    for (int i = 0; i < n; ++i) row.drift[i * lanes + lane] = drift * ordinates->mu()[i] * rows.flat[i * lanes + lane];
  }
  if (layer.leaves || settings.collocation) {
    fillDense(rows, row, index, amplitude);
    return;
  }
  path.scatterRows(rows, row.scatter, mu, first, row.even_source, row.odd_source);
}

void Solver::State::fillDense(const BasisRows& rows, LayerRows& row, std::size_t index, double amplitude) {
  const ScaledLayer& layer = layers[index];
  const int m = static_cast<int>(rows.mode[0]);
  const auto& weight = ordinates->weight();
  const double share = amplitude * (m == 0 ? 1. : 2.) / (2. * kPi);
  std::vector<double> even(n), odd(n);
  detail::DenseMedium medium{.albedo = 1. - layer.loss,
                             .loss = layer.loss,
                             .planck_slope = planckSlope(row, 0),
                             .extinction = std::vector<double>(n, 1.)};
  if (layer.leaves) {
    detail::LeafTables& table = *tables[index];
    const auto& leaves = std::get<LeafScattering>(problem.layers[index].medium);
    table.fromBeam(m).evenOdd(leaves.reflectance, leaves.transmittance, even, odd);
    const LeafKernel& between = table.betweenNodes(m);
    medium.even.resize(between.modulus.size());
    medium.odd.resize(between.modulus.size());
    between.evenOdd(leaves.reflectance, leaves.transmittance, medium.even, medium.odd);
    if (m == 0) medium.even = between.modulus;
    for (int i = 0; i < n; ++i) medium.extinction[i] = table.nodes().projection(i);
  } else {
    const double omega = m == 0 && medium.albedo > 0. ? medium.albedo : 1.;
    for (int i = 0; i < n; ++i) {
      directionKernel(rows, 0, index, ordinates->mu()[i], mu0, even[i], odd[i]);
      for (int j = 0; j < n; ++j) {
        double e, o;
        directionKernel(rows, 0, index, ordinates->mu()[i], ordinates->mu()[j], e, o);
        medium.even.push_back(e / omega);
        medium.odd.push_back(o);
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    row.even_source[i] = share * std::sqrt(weight[i]) * even[i];
    row.odd_source[i] = share * std::sqrt(weight[i]) * odd[i];
  }
  denseModes(rows, row, medium, weight);
}

void Solver::State::directionKernel(const BasisRows& rows, int lane, std::size_t index, double mu, double other,
                                    double& even, double& odd) const {
  const int m = static_cast<int>(rows.mode[lane]), lanes = rows.lanes;
  double now = legendreStart(rows, lane, mu), before = 0., now2 = legendreStart(rows, lane, other), before2 = 0.;
  even = odd = 0.;
  for (int j = 0; m + j < settings.streams; ++j) {
    const double norm = rows.norm[j * lanes + lane], a = rows.up[j * lanes + lane], b = rows.down[j * lanes + lane];
    (j % 2 == 0 ? even : odd) += norm * norm * layers[index].scatter[m + j] * now * now2;
    const double next = a * mu * now - b * before, next2 = a * other * now2 - b * before2;
    before = now;
    now = next;
    before2 = now2;
    now2 = next2;
  }
}

double Solver::State::projectionOf(std::size_t index, double mu) const {
  if (!layers[index].leaves) return 1.;
  return tables[index]->viewProjection(mu);
}

void Solver::State::dropLeafTables(const Problem& next) {
  std::erase_if(leaf_tables, [&](const auto& table) {
    return std::ranges::none_of(next.layers, [&](const Layer& layer) {
      const auto* leaves = std::get_if<LeafScattering>(&layer.medium);
      return leaves != nullptr && leaves->angles == table->angles();
    });
  });
}

void Solver::State::prepareLeaves(std::size_t index) {
  const LeafAngles& angles = std::get<LeafScattering>(problem.layers[index].medium).angles;
  tables.resize(layers.size());
  auto found = std::find_if(leaf_tables.begin(), leaf_tables.end(),
                            [&](const auto& table) { return table->angles() == angles; });
  if (found == leaf_tables.end())
    found =
        leaf_tables.insert(found, std::make_unique<detail::LeafTables>(angles, ordinates->mu(), ordinates->weight()));
  tables[index] = found->get();
  tables[index]->setBeam(mu0);
  layers[index].projection = tables[index]->beamProjection();
}

void Solver::State::beamSource(const BasisRows& rows, int lane, std::size_t index, double mu, double& down,
                               double& up) const {
  const int m = static_cast<int>(rows.mode[lane]);
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
  double even, odd;
  directionKernel(rows, lane, index, mu, mu0, even, odd);
  down = amplitude * (even + odd);
  up = amplitude * (even - odd);
}

double Solver::State::groundRadiance(const BasisRows& rows, const StackRows& stack_rows, int lane, double mu,
                                     bool sine) const {
  if (std::isinf(depth)) return 0.;
  const int m = static_cast<int>(rows.mode[lane]), lanes = rows.lanes;
  const Ground& ground = problem.ground;
  const bool flat_mode = m == 0 && !sine;
  if (!ground.brdf && !flat_mode) return 0.;
  double radiance = 0., albedo = ground.albedo;
  if (ground.brdf) {
    albedo = 0.;
    if (m >= ground.brdf_modes) return 0.;
  } else {
    radiance = albedo * beamOnGround() / kPi;
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

double Solver::State::nodeView(const BasisRows& rows, std::size_t index, double mu, double* even, double* odd) const {
  if (!layers[index].leaves) {
    for (int i = 0; i < n; ++i) {
      directionKernel(rows, 0, index, mu, ordinates->mu()[i], even[i], odd[i]);
      even[i] *= std::sqrt(ordinates->weight()[i]);
      odd[i] *= std::sqrt(ordinates->weight()[i]);
    }
    return 1.;
  }
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
