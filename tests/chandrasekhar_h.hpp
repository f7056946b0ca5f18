#pragma once

#include <vector>

namespace sunfleck::witness {

// Chandrasekhar's H function for isotropic scattering, by the alternate form of its equation (Chandrasekhar 1960,
// section 40), which stays well conditioned to albedo 1:
//   1 / H(mu) = sqrt(1 - albedo) + (albedo / 2) integral over (0, 1) of mu' H(mu') / (mu + mu') dmu'.
// Accurate to 1e-13.
class ChandrasekharH {
 public:
  explicit ChandrasekharH(double albedo);  // [1], 0 .. 1

  double operator()(double mu) const;  // mu in (0, 1]

  // Of a semi-infinite slab under a beam.
  double reflectance(double mu0) const;          // flux up over the flux that arrives [1]
  double radiance(double mu, double mu0) const;  // up at the top, irradiance 1 on a plane that faces the beam [1/sr]

 private:
  double albedo_;
  std::vector<double> cosines_, weights_, values_;
};

}  // namespace sunfleck::witness
