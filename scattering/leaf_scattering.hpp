#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scattering/leaf_angles.hpp"

namespace sunfleck {

// Leaves as Ross 1981 has them: flat, small, bi-Lambertian, the same on both sides. Depth is leaf area index.
struct LeafScattering {
  LeafAngles angles = LeafAngles::spherical();
  double reflectance = 0.5, transmittance = 0.5;  // of a leaf [1], each 0 .. 1, their sum omega at most 1
  // Leaf diameter over the height of the layer [1], >= 0: how far the hot spot reaches (hot_spot.hpp); 0 has none.
  double hot_spot = 0.;
};

// (P20) G(mu): mean |n . s| over the leaves [1], the extinction per leaf area for light whose |cos| to the vertical is
// mu, in [0, 1], where else it throws InvalidInput. Right to 1e-12 for every distribution; some 10 microseconds.
double leafProjection(const LeafAngles& angles, double mu);

// (P21) Fourier modes A_m of |n . s| over the leaf's azimuth, for light s of |cos| mu in [0, 1] travelling downward,
// and each inclination node of `angles`:  |n . s|(phi) = sum over m of result[r] cos(m phi).
// result.size() = angles.nodes().size(). Travelling upward at the same |cos| multiplies mode m by (-1)^m.
void leafProjectionModes(const LeafAngles& angles, int mode, double mu, std::span<double> result);

// (P21) Share of the light per leaf area and irradiance on a plane across it that leaves turn from one direction into
// another, without an azimuth series: (1/pi) <|n . s| |n . s'| {reflectance or transmittance}> [1/sr].
//   mu, mu_in  cos of the leaving and of the arriving light to the downward vertical [1], -1 .. 1
//   azimuth    of the leaving minus that of the arriving light [rad], both of travel
double leafScattering(const LeafScattering& leaves, double mu, double mu_in, double azimuth);

// A_m of a set of directions, for one azimuth mode at a time; what their extinction and scattering are made of. It does
// not depend on the leaves' optics. After construction nothing allocates.
class LeafProjections {
 public:
  // Any directions (the beam, views), by |cos| mu in [0, 1]. A_0 of each is scaled by one factor, 1 within 1e-5, so
  // that its mean over the nodes of `angles` is G to rounding.
  LeafProjections(const LeafAngles& angles, std::span<const double> mus);

  // Discrete ordinates of one hemisphere with their weights, sum 1. A_0 is scaled so that for each inclination
  // sum over i of weights[i] A_0(i) = 1/2, as the integral is: then leaves that absorb nothing conserve energy to
  // rounding, with projection(i) as extinction. Between the two scalings each G stays as close to its own value as
  // sum over i of weights[i] G(i) = 1/2 allows.
  LeafProjections(const LeafAngles& angles, std::span<const double> mus, std::span<const double> weights);

  void setMode(int mode);  // from 0; construction leaves mode 0 set
  int mode() const { return mode_; }

  std::size_t size() const { return mus_.size(); }
  double mu(std::size_t i) const { return mus_[i]; }
  double projection(std::size_t i) const { return projections_[i]; }  // G [1], whatever mode is set
  const LeafAngles& angles() const { return angles_; }
  // A_m of direction i, for each inclination node
  std::span<const double> values(std::size_t i) const { return {values_.data() + i * nodes_, nodes_}; }

 private:
  LeafAngles angles_;
  std::size_t nodes_;
  std::vector<double> mus_, projections_;
  std::vector<double> mean_mode_, values_;  // [direction][inclination]
  int mode_ = 0;
};

// (P21) One azimuth mode of what a layer scatters per leaf area index. With S = I(down) + I(up), D = I(down) - I(up) of
// the radiance's mode m at mu' in (0, 1], the scattered J(down) + J(up) = integral over mu' of E S, and
// J(down) - J(up) = integral over mu' of O D. Two parts make them, neither of which depends on the optics:
//   even modes  E = omega modulus,        O = -(reflectance - transmittance) cosine
//   odd modes   E = -(reflectance - transmittance) cosine,        O = omega modulus
// cosine is 0 from mode 2 on. A beam of irradiance F across it, |cos| mu0, makes S = D of one direction: its sources
// are F (2 - [m = 0]) / (2 pi) times E, O at mu' = mu0, times the beam's extinction.
struct LeafKernel {
  int mode = 0;
  std::vector<double> modulus, cosine;  // [row][column]; cosine is empty from mode 2 on

  // E and O; even.size() = odd.size() = modulus.size().
  void evenOdd(double reflectance, double transmittance, std::span<double> even, std::span<double> odd) const;
};

// Fills `kernel` for scattering from the columns' directions into the rows', which are set to the same mode and have
// the same leaf angles. Allocates only if `kernel` never held as many.
void fillLeafKernel(const LeafProjections& rows, const LeafProjections& columns, LeafKernel& kernel);

}  // namespace sunfleck
