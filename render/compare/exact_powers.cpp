#include "render/compare/exact_powers.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "pp_solver/solver.hpp"
#include "scattering/double_gauss.hpp"

namespace sunfleck {
namespace {

constexpr int kDirections = 12;      // of each half, over which radiance is summed
constexpr double kPerCrossing = 2.;  // leaf area index: of leaves of all directions half is met
constexpr double kDeep = 1e4;        // crossings in a slab without end, where no light is left but that of albedo 1

void solveRow(const Medium& leaves, double thickness, std::span<spp::SlabPowers> row) {
  const DoubleGauss half = doubleGauss(2 * kDirections);
  std::vector<double> mus, area_indices;
  for (const double mu : half.mu) mus.insert(mus.end(), {mu, -mu});
  for (const double depth : spp::tableDepths(thickness)) area_indices.push_back(kPerCrossing * std::min(depth, kDeep));
  pp::Solver solver({.streams = 2 * kDirections, .corrections = false});
  solver.solve({.layers = {{.thickness = kPerCrossing * thickness, .medium = leaves}}, .beam = pp::Beam{}});
  std::vector<double> radiances(row.size() * mus.size());
  constexpr double kPhi = 0.;
  solver.radiances(area_indices, mus, std::span(&kPhi, 1), radiances);
  for (std::size_t i = 0; i < row.size(); ++i) {
    double down = 0., up = 0.;
    for (std::size_t j = 0; j < half.mu.size(); ++j) {
      down += half.weight[j] * radiances[i * mus.size() + 2 * j];
      up += half.weight[j] * radiances[i * mus.size() + 2 * j + 1];
    }
    constexpr double kTurn = 2. * std::numbers::pi;
    row[i] = {static_cast<float>(kTurn * std::max(down, 0.)), static_cast<float>(kTurn * std::max(up, 0.))};
  }
}

}  // namespace

spp::PowerTable exactPowerTable(const LeafOptics& optics) {
  const Medium leaves = spp::sphericalLeaves(optics).medium;
  const std::vector<double> thicknesses = spp::tableThicknesses();
  constexpr std::size_t kRow{spp::kTableDepths};
  spp::PowerTable table;
  table.nodes.assign(kRow * thicknesses.size(), spp::SlabPowers{0.f, 0.f});
  tbb::parallel_for(std::size_t{1}, thicknesses.size(), [&](std::size_t row) {
    solveRow(leaves, thicknesses[row], std::span(table.nodes).subspan(row * kRow, kRow));
  });
  return table;
}

}  // namespace sunfleck
