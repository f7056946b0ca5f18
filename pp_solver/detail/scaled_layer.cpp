#include "pp_solver/detail/scaled_layer.hpp"

#include <cmath>

namespace sunfleck::pp::detail {
namespace {

// How a backward peak is spread: the l-th moment of the unresolved part falls by this, so that the kernel of N moments
// stays above 0 where the peak's own moments would make it swing.
double spreadMoment(double l_over_n) { return std::exp(-3. * l_over_n * l_over_n); }

}  // namespace

void scaleLayer(const Layer& layer, int streams, bool delta_m, double mu0, ScaledLayer& scaled) {
  scaled.true_thickness = layer.thickness;
  scaled.scatter.assign(streams, 0.);
  scaled.true_scatter.assign(streams, 0.);
  scaled.scale = scaled.projection = 1.;
  if (const auto* leaves = std::get_if<LeafScattering>(&layer.medium)) {
    scaled.leaves = true;
    scaled.albedo = leaves->reflectance + leaves->transmittance;
    scaled.loss = 1. - scaled.albedo;
    scaled.thickness = layer.thickness;
    scaled.projection = leafProjection(leaves->angles, mu0);
    return;
  }
  const auto& particles = std::get<Particles>(layer.medium);
  const PhaseFunction& phase = particles.phase;
  const double omega = particles.albedo, last = phase.moment(streams), before = phase.moment(streams - 1);
  scaled.leaves = false;
  const bool forward = delta_m && last > 0. && before >= last;
  const double peak = forward ? last : 0., spread = delta_m && last > 0. && before < 0. ? last : 0.;
  scaled.albedo = omega;
  scaled.scale = 1. - omega * peak;
  scaled.thickness = layer.thickness * scaled.scale;
  scaled.loss = (1. - omega) / scaled.scale;
  for (int l = 0; l < streams; ++l) {
    const double chi = phase.moment(l), sign = l % 2 == 0 ? 1. : -1.;
    scaled.true_scatter[l] = omega * chi;
    scaled.scatter[l] =
        omega * (chi - peak - sign * spread * (1. - spreadMoment(static_cast<double>(l) / streams))) / scaled.scale;
  }
}

}  // namespace sunfleck::pp::detail
