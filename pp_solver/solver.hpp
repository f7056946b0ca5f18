#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pp_solver/problem.hpp"

namespace sunfleck::pp {

struct Settings {
  int streams = 16;  // N, directions over both hemispheres; even, 2 .. 256
  // Moments that N directions cannot carry: cut and counted as unscattered (delta-M, Wiscombe 1977) or spread where
  // they belong to a backward peak. Off: the series is cut at N.
  bool delta_m = true;
  // Radiance from the source function with the whole phase function for the first scattering (and the second near the
  // forward direction), instead of N moments.
  bool corrections = true;
  // Scatter between the ordinates by the values of the phase function's series there (collocation), as DISORT does, in
  // place of (P2): to compare digit by digit. Slower, and some sharp phase functions throw InvalidInput.
  bool collocation = false;
  // The azimuth series ends when a mode adds less than this share of the radiance so far, twice in turn.
  double azimuth_tolerance = 1e-13;
};

// Light through horizontal planes at one depth.
struct Fluxes {
  double up = 0.;              // diffuse [flux]
  double down = 0.;            // diffuse, without the direct beam [flux]
  double direct = 0.;          // the beam's own, unscattered [flux]
  double mean_intensity = 0.;  // radiance averaged over the sphere, direct beam included [radiance]
  // Light that meets leaves from both sides together, per one-sided leaf area, direct beam included [flux]; times
  // (1 - omega) it is what they absorb. Particles count as leaves of all directions alike: 2 pi mean intensity.
  double leaf_irradiance = 0.;
};

// The exact solution by discrete ordinates. An object keeps its memory from one problem to the next: solving another of
// the same size, of particles on a Lambertian ground, allocates nothing. Objects do not share anything that changes:
// one for each thread.
class Solver {
 public:
  explicit Solver(Settings settings = {});  // throws InvalidInput
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  // Solves the azimuth mean: all that fluxes need. Throws InvalidInput for a problem that is none (requireSolvable) and
  // for functions that return what is no radiance or no reciprocal BRDF; there is then no solution to ask.
  void solve(const Problem& problem);

  // What follows speaks of the problem solved last, and throws InvalidInput where there is none. A hot spot is in the
  // shares, in the fluxes at the top and at the bottom and in the radiance at the top; within the layer it is left out.
  double incident() const;  // flux that arrives at the top, and from below [flux]; without any, shares are not defined
  double reflectance() const;    // flux up at the top over `incident` [1]
  double transmittance() const;  // flux down at the bottom, direct beam included, over `incident` [1]; 0 if infinite
  double direct() const;         // the beam's share of transmittance [1]
  double absorptance() const;  // absorbed by the layers less what they emit, over `incident`, by the mean intensity [1]

  Fluxes fluxes(double depth) const;                    // depth in [0, total thickness]
  double absorbed(double depth0, double depth1) const;  // net flux at depth0 less that at depth1 [flux]

  // Radiance of diffuse light (the direct beam left out) at every depth, in every direction:
  // result[(d * mus.size() + i) * phis.size() + j]. Solves as many azimuth modes as needed.
  //   mus   cos to the downward vertical [1], 1e-100 <= |mu| <= 1
  //   phis  azimuth of travel [rad]
  void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                 std::span<double> result);
  double radiance(double depth, double mu, double phi);
  int azimuthModes() const;  // how many the last radiances() took

  // The solution put back into its equation: the largest deviation of mu dI/dz from -G I + source, averaged over a step
  // in which no light decays by more than a quarter, over the ordinates, nine depths of each layer and the azimuth
  // modes 0 .. modes - 1, in units of the largest radiance or source there. The source is summed anew from the
  // radiances.
  double residual(int modes = 1);

  struct State;

 private:
  State& solved() const;
  std::unique_ptr<State> state_;
};

}  // namespace sunfleck::pp
