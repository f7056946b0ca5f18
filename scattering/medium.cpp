#include "scattering/medium.hpp"

#include <algorithm>
#include <cmath>

namespace sunfleck {

// Cosine of the angle between two directions.
static double cosineBetween(double mu, double mu0, double cos_azimuth) {
  const double sines = std::sqrt(std::max(0., (1. - mu0) * (1. + mu0) * (1. - mu) * (1. + mu)));
  return std::clamp(sines * cos_azimuth + mu0 * mu, -1., 1.);
}

double scatteredInto(const Medium& medium, double mu, double mu0, double azimuth) {
  if (const auto* leaves = std::get_if<LeafScattering>(&medium)) return leafScattering(*leaves, mu, mu0, azimuth);
  const auto& particles = std::get<Particles>(medium);
  return particles.albedo * particles.phase(cosineBetween(mu, mu0, std::cos(azimuth)));
}

double extinction(const Medium& medium, double mu) {
  const auto* leaves = std::get_if<LeafScattering>(&medium);
  return leaves ? leafProjection(leaves->angles, std::abs(mu)) : 1.;
}

double singleScatteringAlbedo(const Medium& medium) {
  if (const auto* leaves = std::get_if<LeafScattering>(&medium)) return leaves->reflectance + leaves->transmittance;
  return std::get<Particles>(medium).albedo;
}

}  // namespace sunfleck
