#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pp_solver/detail/first_scattering.hpp"
#include "pp_solver/discrete_legendre.hpp"
#include "pp_solver/solver.hpp"

namespace sunfleck::pp::detail {

// Directions of light leaving, and how much of a beam the medium turns into each at once: the same for all thicknesses.
struct Views {
  double mu0 = 1.;
  std::vector<double> cosines;   // |mu| [1]; all of them downward first, then upward
  std::vector<double> azimuths;  // [rad]
  std::vector<double> rates;     // extinction over cosine, for each of `cosines`
  std::vector<double> turned;    // [half][cosine][azimuth], scatteredInto
};
Views viewsOf(const Medium& medium, double mu0, std::vector<double> cosines, std::vector<double> azimuths);

// The middles of `count` equal parts of 0 .. pi, from which cosine modes below `count` are found.
std::vector<double> azimuthsFor(int count);

// What the powers of one beam direction are made of: nodes for the light scattered once, which may peak, and for the
// rest.
struct PowerViews {
  DoubleGauss once_rule, rest_rule;  // |mu| squared away from 0, where light that grazes the faces changes fast
  std::vector<double> once_rates;
  std::vector<double> turned;  // mean over the azimuth [half][node]
  Views rest;
};
PowerViews powerViewsOf(const Medium& medium, double mu0, int once_nodes, int rest_nodes, int azimuths);

// One solver, and what it says of slabs of one medium under a beam of irradiance 1 across it.
class SlabSampler {
 public:
  SlabSampler(const Medium& medium, int streams, double azimuth_tolerance);

  void solve(double thickness, double mu0);

  // Diffuse radiance [half][depth][cosine][azimuth].
  void radiances(const Views& views, std::span<const double> depths, std::vector<double>& result);

  // The multiply scattered part of it, divided by 1 - e^(-rate path), path that through the slab up to the depth: the
  // mean source along the path, by its azimuth modes [half][depth][cosine][mode]. As many modes as azimuths.
  void sources(const Views& views, std::span<const double> depths, std::vector<double>& result);

  // P+ without direct light, and P- [depth][2].
  void powers(const PowerViews& views, std::span<const double> depths, std::vector<double>& result);

  int azimuthModes() const { return solver_.azimuthModes(); }

 private:
  Medium medium_;
  Solver solver_;
  double thickness_ = 1., rate0_ = 1.;
  std::vector<double> inner_, signed_, radiances_, sources_;
};

}  // namespace sunfleck::pp::detail
