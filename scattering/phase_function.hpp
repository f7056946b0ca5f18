#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace sunfleck {

// How a particle scatters: p(cos Theta) [1/sr], its integral over the sphere 1, and its Legendre moments
// chi_l = 2 pi integral p P_l d(cos Theta), chi_0 = 1, |chi_l| < 1.
class PhaseFunction {
 public:
  PhaseFunction() = default;  // isotropic

  // Henyey & Greenstein 1941: chi_l = g^l.
  //   asymmetry  g, mean cosine of scattering [1], -1 < g < 1
  static PhaseFunction henyeyGreenstein(double asymmetry);

  // A finite Legendre series. Throws InvalidInput unless chi_0 = 1 (or the list is empty), every other |chi_l| < 1 and
  // the series is nowhere negative (but for 1e-3 of its mean, the rounding of published tables).
  static PhaseFunction fromMoments(std::vector<double> moments);

  // Samples of p in any unit, joined by straight lines in the cosine and scaled to 1.
  //   cosines  cos Theta [1], rising strictly from -1 to 1, two or more
  //   values   p there, >= 0, not all 0
  // Throws InvalidInput where that does not hold.
  static PhaseFunction sampled(std::vector<double> cosines, std::vector<double> values);

  double operator()(double cosine) const;  // p [1/sr]

  // chi_l [1] for l = 0 .. moments.size() - 1
  void moments(std::span<double> moments) const;

  // The first order from which all moments are 0, or kNoEnd.
  int orders() const;
  static constexpr int kNoEnd = std::numeric_limits<int>::max();

  // g where chi_l = g^l for all l: made by henyeyGreenstein(), or isotropic.
  std::optional<double> henyeyGreensteinAsymmetry() const;

 private:
  double asymmetry_ = 0.;
  std::vector<double> moments_;           // of a series, or empty
  std::vector<double> cosines_, values_;  // of samples, or empty
};

}  // namespace sunfleck
