#pragma once

namespace sunfleck::spp {

// (S8) T of Shinya et al. 2013 Eq. 9 for the Henyey-Greenstein phase function: the share of the light that one
// scattering sends into the forward half of the slab, for light whose |cos| to the normal is mu0. In [0, 1], to 1e-10.
//   asymmetry  g, mean cosine of scattering [1], -1 < g < 1
//   mu0        [1], (0, 1]
double forwardShare(double asymmetry, double mu0);

// (S11) The same share of light that comes in equally from all directions of the half before: the mean of
// forwardShare(g, mu) over mu. In [0, 1], to 1e-13.
double meanForwardShare(double asymmetry);

}  // namespace sunfleck::spp
