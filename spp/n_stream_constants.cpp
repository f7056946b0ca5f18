#include <cmath>
#include <numbers>
#include <string>

#include "core/require.hpp"
#include "scattering/double_gauss.hpp"
#include "spp/detail/checked_beam.hpp"
#include "spp/detail/scaled_phase.hpp"
#include "spp/detail/stream_system.hpp"

namespace sunfleck::spp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double kPi = std::numbers::pi;

double beamFactor(int order) {
  return (order == 0 ? 1. : 2.) / (2. * kPi);
}

// Rows are the values at the streams of the even, of the odd functions of `order`; those of the other parity are 0.
struct LegendreRows {
  MatrixXd even, odd;

  LegendreRows(int order, const VectorXd& cosines) {
    const Index n = cosines.size(), rows = 2 * n - order;
    even = odd = MatrixXd::Zero(rows, n);
    VectorXd column(rows);
    for (Index i = 0; i < n; ++i) {
      legendreFunctions(order, cosines[i], {column.data(), static_cast<std::size_t>(rows)});
      for (Index r = 0; r < rows; ++r) (r % 2 == 0 ? even : odd)(r, i) = column[r];
    }
  }
};

// False where there are no modes.
bool addParticles(StreamConstants& constants, detail::StreamSystem system, int orders,
                  const detail::ScaledPhase& scaled) {
  const auto& particles = std::get<Particles>(constants.beam.medium);
  const Index n = system.cosines.size();
  constants.depth_scale = scaled.depth_scale;
  system.beam_rate = constants.beam_rate = 1. / constants.beam.mu0;
  constants.beam_projection = 0.5;
  constants.projections.assign(static_cast<std::size_t>(n), 0.5);
  system.extinction = VectorXd::Ones(n);
  for (int m = 0; m < orders; ++m) {
    const Index rows = 2 * n - m;
    const LegendreRows functions(m, system.cosines);
    VectorXd at_beam(rows);
    legendreFunctions(m, constants.beam.mu0, {at_beam.data(), static_cast<std::size_t>(rows)});
    const VectorXd moments = scaled.albedo * scaled.moments.tail(rows);
    const MatrixXd back = scaled.albedo * scaled.turned_back * (m % 2 == 0 ? 1. : -1.) *
                          MatrixXd(system.weights.cwiseInverse().asDiagonal());
    system.even = functions.even.transpose() * moments.asDiagonal() * functions.even + back;
    system.odd = functions.odd.transpose() * moments.asDiagonal() * functions.odd - back;
    const VectorXd source = beamFactor(m) * scaled.albedo * scaled.beam_moments.tail(rows).cwiseProduct(at_beam);
    system.even_source = functions.even.transpose() * source;
    system.odd_source = functions.odd.transpose() * source;
    // A series too short for its peak may send more than all of the beam's scattering to one half, and less than none
    // to the other.
    if (m == 0) {
      const double all = system.weights.dot(system.even_source), net = std::abs(system.weights.dot(system.odd_source));
      if (net > all) system.odd_source *= all / net;
    }
    system.albedo = m == 0 ? scaled.albedo : 0.;
    system.lost = scaled.lost;
    std::optional<StreamModes> modes = detail::streamModes(system);
    if (!modes) return false;
    constants.orders.push_back(*std::move(modes));

    const VectorXd seen = 0.5 * particles.albedo * scaled.true_moments.tail(rows);
    std::vector<double>& stored = constants.moments.emplace_back();
    for (Index r = 0; r < rows; ++r)
      for (Index i = 0; i < n; ++i)
        stored.push_back(seen[r] * system.weights[i] * (functions.even(r, i) + functions.odd(r, i)));
  }
  return true;
}

void addLeaves(StreamConstants& constants, detail::StreamSystem system, int orders) {
  const auto& leaves = std::get<LeafScattering>(constants.beam.medium);
  const Index n = system.cosines.size();
  const std::size_t size = static_cast<std::size_t>(n);
  LeafProjections streams(leaves.angles, {system.cosines.data(), size}, {system.weights.data(), size});
  LeafProjections beam(leaves.angles, std::span(&constants.beam.mu0, 1));
  constants.beam_projection = beam.projection(0);
  system.beam_rate = constants.beam_rate = beam.projection(0) / constants.beam.mu0;
  for (std::size_t i = 0; i < size; ++i) constants.projections.push_back(streams.projection(i));
  system.extinction = Eigen::Map<const VectorXd>(constants.projections.data(), n);
  system.even = system.odd = MatrixXd(n, n);
  system.even_source = system.odd_source = VectorXd(n);
  LeafKernel kernel;
  for (int m = 0; m < orders; ++m) {
    const auto fill = [&](const LeafProjections& from, auto& even, auto& odd) {
      fillLeafKernel(streams, from, kernel);
      kernel.evenOdd(leaves.reflectance, leaves.transmittance, {even.data(), kernel.modulus.size()},
                     {odd.data(), kernel.modulus.size()});
    };
    streams.setMode(m);
    beam.setMode(m);
    fill(streams, system.even, system.odd);
    fill(beam, system.even_source, system.odd_source);
    system.even_source *= beamFactor(m);
    system.odd_source *= beamFactor(m);
    if (m == 0 && leaves.transmittance > detail::kMostForward) system.odd *= detail::kMostForward;
    system.albedo = m == 0 ? leaves.reflectance + leaves.transmittance : 0.;
    system.lost = (1. - leaves.reflectance) - leaves.transmittance;
    constants.orders.push_back(detail::streamModes(system).value());
    constants.leaves.push_back(streams);
  }
}

}  // namespace

void legendreFunctions(int order, double mu, std::span<double> result) {
  const int m = order, rows = static_cast<int>(result.size());
  double last = 0., value = 1.;
  const double sine = std::sqrt(std::max(0., (1. - mu) * (1. + mu)));
  for (int i = 1; i <= m; ++i) value *= sine * std::sqrt((2. * i - 1.) / (2. * i));
  for (int r = 0; r < rows; ++r) {
    result[static_cast<std::size_t>(r)] = value;
    const int l = m + r;
    const double next = ((2. * l + 1.) * mu * value - std::sqrt(double((l - m) * (l + m))) * last) /
                        std::sqrt(double((l + 1 - m) * (l + 1 + m)));
    last = value;
    value = next;
  }
}

StreamConstants nStreamConstants(const BeamInMedium& beam, int streams, int azimuth_orders) {
  require(streams >= 1 && streams <= kMostStreams, "streams", streams, "from 1 to 32");
  require(azimuth_orders >= 1 && azimuth_orders <= 2 * streams, "azimuth orders", azimuth_orders,
          "from 1 to twice the streams");
  const DoubleGauss gauss = doubleGauss(2 * streams);
  StreamConstants constants{.beam = detail::checkedBeam(beam), .cosines = gauss.mu};
  for (const double weight : gauss.weight) constants.solid_angles.push_back(2. * kPi * weight);
  detail::StreamSystem system;
  system.cosines = Eigen::Map<const VectorXd>(gauss.mu.data(), streams);
  system.weights = Eigen::Map<const VectorXd>(gauss.weight.data(), streams);
  if (const auto* particles = std::get_if<Particles>(&constants.beam.medium)) {
    StreamConstants whole = constants;
    if (addParticles(whole, system, azimuth_orders, detail::ScaledPhase::delta(*particles, streams))) return whole;
    if (!addParticles(constants, system, azimuth_orders, detail::ScaledPhase::smoothed(*particles, streams)))
      throw InvalidInput("streams = " + std::to_string(streams) +
                         ": must be more, for a phase function as sharp as this");
  } else {
    addLeaves(constants, system, azimuth_orders);
  }
  return constants;
}

}  // namespace sunfleck::spp
