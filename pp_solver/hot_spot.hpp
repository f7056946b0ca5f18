#pragma once

#include "scattering/leaf_scattering.hpp"

// (P22) The hot spot: where one looks down along the sun's rays, every leaf that one sees is lit. Leaves as small as
// points do not show it; finite ones correlate the gaps through which light enters and leaves (Kuusk 1985, 1991). First
// order only: light scattered once, by leaves or by the ground below them.
namespace sunfleck::pp {

// A layer on top of all others, its beam, and a direction of view.
struct SunAndView {
  double thickness = 1.;  // leaf area index of the layer [1], above 0; finite if leaves.hot_spot > 0
  double mu0 = 1.;        // |cos| of the beam, which travels down [1], (0, 1]
  double mu = 1.;         // |cos| of the light that leaves upward [1], (0, 1]
  double azimuth = 0.;    // of the leaving minus that of the arriving light [rad], both of travel; pi looks down-sun
};

// What a beam of irradiance 1 across it makes in the direction of view.
struct ScatteredOnce {
  double leaves;  // radiance at the top of the layer from leaves of the layer that the beam hits first [1/sr]
  // Share of the beam's and view's path through the whole layer that is free of leaves both ways [1]: a ground of BRDF
  // f just below adds f mu0 gap to the radiance at the top.
  double gap;
};

// All throw InvalidInput for values out of range; none returns NaN, however grazing the directions.
ScatteredOnce scatteredOnceTurbid(const LeafScattering& leaves, const SunAndView& at);  // hot_spot taken as 0
// What the hot spot adds to it: not negative, and formed without taking close numbers from each other.
ScatteredOnce hotSpotExcess(const LeafScattering& leaves, const SunAndView& at);

// The excess integrated over the upper hemisphere, times mu: flux up at the top over the beam's irradiance across it.
// `gap` is for a Lambertian ground of albedo 1 and is to be multiplied by its albedo; mu0 is in it.
ScatteredOnce hotSpotFlux(const LeafScattering& leaves, double thickness, double mu0);

}  // namespace sunfleck::pp
