#pragma once

#include <variant>

#include "scattering/leaf_scattering.hpp"
#include "scattering/phase_function.hpp"

namespace sunfleck {

// Particles that look the same from everywhere. Depth is optical depth [1].
struct Particles {
  double albedo = 0.;  // omega, single-scattering albedo [1], 0 .. 1
  PhaseFunction phase;
};

// What scatters in a homogeneous layer. Depth is that of its kind: optical depth, or leaf area index.
using Medium = std::variant<Particles, LeafScattering>;

// Share of the light per depth and irradiance across it that a medium turns into a direction [1/sr]: omega p, or Gamma
// of leaves. mu of the leaving light by its sign, mu0 > 0, azimuth between both [rad].
double scatteredInto(const Medium& medium, double mu, double mu0, double azimuth);
// Extinction per depth for a direction [1]: 1, or G of leaves.
double extinction(const Medium& medium, double mu);
// Share of the light that meets a scatterer and is scattered [1]: omega, of leaves reflectance + transmittance.
double singleScatteringAlbedo(const Medium& medium);

}  // namespace sunfleck
