#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "pp_solver/ground.hpp"
#include "scattering/medium.hpp"

// The plane-parallel problem. Depth counts downward from 0 at the lit face; mu > 0 is light that travels downward
// (core/directions.hpp: directions are those of travel); phi is the azimuth of travel.
namespace sunfleck::pp {

// Cosines and thicknesses outside of these would leave the range of numbers in their products.
inline constexpr double kLeastCosine = 1e-100, kLeastThickness = 1e-100, kMostThickness = 1e100;

// A homogeneous layer.
struct Layer {
  // Optical thickness of particles [1], leaf area index (one-sided leaf area above ground area) of leaves [1]. 1e-100
  // to 1e100; infinity is allowed for the last layer.
  double thickness = 1.;
  Medium medium;
  // Planck radiance B at the top and at the bottom [radiance]; linear between, the mean of both where the layer is
  // thinner than 1e-6. The layer emits (1 - omega) B.
  double emission_top = 0., emission_bottom = 0.;
};

// Parallel light from above.
struct Beam {
  double mu0 = 1.;         // |cos| of the angle to the vertical [1], 1e-100 .. 1
  double azimuth = 0.;     // of travel [rad]
  double irradiance = 1.;  // on a plane that faces the beam
};

// Radiance of diffuse light that arrives, by mu = |cos| in (0, 1] and azimuth of travel [rad]: one value for all
// directions, or a function.
using Sky = std::variant<double, std::function<double(double mu, double phi)>>;

struct Problem {
  std::vector<Layer> layers;  // from the top down, at least one
  std::optional<Beam> beam;
  Sky above = 0., below = 0.;  // `below` needs a finite stack
  Ground ground;               // what `below` adds to
};

// Throws InvalidInput, naming layer and field, unless every value is in its range.
void requireSolvable(const Problem& problem);

}  // namespace sunfleck::pp
