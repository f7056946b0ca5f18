#include "pp_solver/detail/scaled_layer.hpp"

#include "pp_solver/detail/scaled_moments.hpp"

namespace sunfleck::pp::detail {
void scaleLayer(const Layer& layer, int streams, bool delta_m, ScaledLayer& scaled) {
  scaled.true_thickness = layer.thickness;
  scaled.scatter.assign(streams, 0.);
  scaled.true_scatter.resize(streams + 1);
  scaled.scale = scaled.projection = 1.;
  if (const auto* leaves = std::get_if<LeafScattering>(&layer.medium)) {
    scaled.leaves = true;
    scaled.albedo = leaves->reflectance + leaves->transmittance;
    scaled.loss = 1. - scaled.albedo;
    scaled.thickness = layer.thickness;
    return;
  }
  const auto& particles = std::get<Particles>(layer.medium);
  const double omega = particles.albedo;
  particles.phase.moments(scaled.true_scatter);
  scaled.leaves = false;
  scaled.albedo = omega;
  scaled.scale = scaleMoments(omega, scaled.true_scatter.data(), streams, delta_m, scaled.scatter.data(), 1);
  scaled.thickness = layer.thickness * scaled.scale;
  scaled.loss = (1. - omega) / scaled.scale;
  for (double& moment : scaled.true_scatter) moment *= omega;
}

}  // namespace sunfleck::pp::detail
