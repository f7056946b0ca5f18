#include "spp/power_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "scattering/double_gauss.hpp"
#include "spp/stream_slab.hpp"

namespace sunfleck::spp {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Where tablePlace() finds a node of a slab.
double nodeDepth(int node, double thickness) {
  const double part = static_cast<double>(node) / (kTableDepths - 1), rest = 1. - part;
  const double t = part * part / (part * part + rest * rest);                       // A^2 / (A^2 + B^2)
  if (thickness == kInfinite) return t < 0.5 ? 8. * t / (1. - 2. * t) : kInfinite;  // B^2 = 8
  if (t > 0.5) return thickness - nodeDepth(kTableDepths - 1 - node, thickness);
  // A^2 (1 - t) = B^2 t is q z^2 - p z + t w = 0.
  const double q = 0.125 * (1. - 2. * t), p = 1. + q * thickness;
  return 2. * t * thickness / (p + std::sqrt(p * p - 4. * q * t * thickness));
}

}  // namespace

SlabPowers PowerTable::at(float depth, float thickness) const {
  const TablePlace place = tablePlace(depth, thickness);
  const SlabPowers* thin = nodes.data() + place.thickness * kTableDepths + place.depth;
  const SlabPowers* thick = thin + kTableDepths;
  return {.down = tableValue(place, thin[0].down, thin[1].down, thick[0].down, thick[1].down),
          .up = tableValue(place, thin[0].up, thin[1].up, thick[0].up, thick[1].up)};
}

std::vector<double> tableThicknesses() {
  std::vector<double> thicknesses;
  for (int node = 0; node < kTableThicknesses; ++node) {
    const double x = static_cast<double>(node) / (kTableThicknesses - 1);
    thicknesses.push_back(x < 1. ? 4. * x / (1. - x) : kInfinite);
  }
  return thicknesses;
}

std::vector<double> tableDepths(double thickness) {
  std::vector<double> depths;
  for (int node = 0; node < kTableDepths; ++node) depths.push_back(nodeDepth(node, thickness));
  return depths;
}

BeamInMedium sphericalLeaves(const LeafOptics& optics) {
  return {LeafScattering{.angles = LeafAngles::spherical(),
                         .reflectance = double{optics.reflectance},
                         .transmittance = double{optics.transmittance}},
          1.};
}

PowerTable streamPowerTable(const LeafOptics& optics) {
  constexpr double kDeep = 1e6;  // crossings in a slab without end, where no light is left but that of albedo 1
  const StreamConstants constants = nStreamConstants(sphericalLeaves(optics), 2, 1);
  const double per_crossing = 1. / constants.beam_projection;  // leaf area index
  PowerTable table;
  table.nodes.assign(std::size_t{kTableDepths}, SlabPowers{0.f, 0.f});  // no slab
  for (const double thickness : tableThicknesses()) {
    if (thickness == 0.) continue;
    const StreamSlab<double> slab(constants, thickness * per_crossing);
    for (const double depth : tableDepths(thickness)) {
      const SlabLight<double> light = slab.light(std::min(depth, kDeep) * per_crossing);
      table.nodes.push_back({static_cast<float>(light.power_down - light.direct), static_cast<float>(light.power_up)});
    }
  }
  return table;
}

PowerTable refinedPowerTable(const LeafOptics& optics) {
  constexpr int kDirections = 16;  // of each half
  const DoubleGauss half = doubleGauss(2 * kDirections);
  const StreamConstants constants = sppConstants(sphericalLeaves(optics));
  std::vector<StreamView<double>> down, up;
  for (const double mu : half.mu) {
    down.push_back(streamView<double>(constants, mu, 0.));
    up.push_back(streamView<double>(constants, -mu, 0.));
  }
  const double per_crossing = 1. / constants.beam_projection;  // leaf area index
  PowerTable table;
  table.nodes.assign(std::size_t{kTableDepths}, SlabPowers{0.f, 0.f});  // no slab
  for (const double thickness : tableThicknesses()) {
    if (thickness == 0.) continue;
    const StreamSlab<double> slab(constants, thickness * per_crossing);
    for (const double depth : tableDepths(thickness)) {
      double sum_down = 0., sum_up = 0.;
      if (depth < kInfinite)
        for (std::size_t i = 0; i < half.mu.size(); ++i) {
          sum_down += half.weight[i] * slab.refinedRadiance(depth * per_crossing, down[i]);
          sum_up += half.weight[i] * slab.refinedRadiance(depth * per_crossing, up[i]);
        }
      constexpr double kTurn = 2. * std::numbers::pi;
      table.nodes.push_back({static_cast<float>(kTurn * sum_down), static_cast<float>(kTurn * sum_up)});
    }
  }
  return table;
}

}  // namespace sunfleck::spp
