#pragma once

#include <functional>

namespace sunfleck::pp {

// What lies under the last layer. Reciprocal: brdf(m, mu, mu') = brdf(m, mu', mu).
struct Ground {
  // Share of the arriving flux that a Lambertian ground returns [1], 0 .. 1. 0 is black.
  double albedo = 0.;

  // Where set, the ground reflects by this instead: Fourier mode m of the bidirectional reflectance distribution
  // function [1/sr], f(mu, mu', phi - phi') = sum over m of brdf(m, mu, mu') cos(m (phi - phi')), with phi of travel:
  // a mirror has its peak at phi = phi'. mu, mu' are |cos| of the leaving and the arriving light.
  std::function<double(int mode, double mu, double mu_in)> brdf;
  int brdf_modes = 0;  // modes 0 .. brdf_modes - 1 are not zero

  // Planck radiance B of the ground [radiance]; it emits (1 - directional albedo) B.
  double emission = 0.;
};

// Fourier modes of a BRDF given as a function, by `samples` values on the circle (modes below samples / 2).
Ground groundOf(std::function<double(double mu, double mu_in, double azimuth)> brdf, int modes, int samples = 256);

}  // namespace sunfleck::pp
