#pragma once

#include "scattering/medium.hpp"

namespace sunfleck::spp {

// (S8) T of Shinya et al. 2013 Eq. 9 for the Henyey-Greenstein phase function: the share of the light that one
// scattering sends into the forward half of the slab, for light whose |cos| to the normal is mu0. In [0, 1], to 1e-14;
// so is the smaller of T and 1 - T as a share of itself where |g| > 0.5. Some 0.5 microseconds.
//   asymmetry  g, mean cosine of scattering [1], -1 < g < 1
//   mu0        [1], (0, 1]
double forwardShare(double asymmetry, double mu0);

// (S11) The same share of light that comes in equally from all directions of the half before: the mean of
// forwardShare(g, mu) over mu. In [0, 1], to 1e-13.
double meanForwardShare(double asymmetry);

// (S8), (S11) The same for any medium. Sampled phase functions by 512 moments: what these cannot carry counts as
// scattered straight on, or straight back; 1e-5 off for a peak as narrow as a degree. Leaves: by their exact
// scattering; the mean is of what leaves meet, each direction weighted by its extinction.
double forwardShare(const Medium& medium, double mu0);
double meanForwardShare(const Medium& medium);

}  // namespace sunfleck::spp
