#pragma once

#include <span>
#include <vector>

namespace sunfleck::spp {

// A medium of Henyey-Greenstein scatterers under a beam.
struct BeamInMedium {
  double asymmetry = 0.;  // g, mean cosine of scattering [1], -1 < g < 1
  double albedo = 0.;     // omega [1], 0 .. 1
  double mu0 = 1.;        // |cos| of the beam to the slab's normal [1], (0, 1]; below kLeastCosine it counts as that
};

inline constexpr double kLeastCosine = 1e-7;
inline constexpr int kMostStreams = 32;

// The modes of diffuse light in a medium for one order m of the azimuth (light proportional to cos m phi), each with
// its share in every stream. Matrices are stored row after row, n columns, one for each mode.
struct StreamModes {
  std::vector<double> rate, odd_source, gain;  // k, a, g of each mode (stream_formulas.glsl)
  std::vector<double> sum, difference;         // X, Y: n rows, the streams
  // What of a mode is scattered towards the eye: rows are functions of the direction of view, in turn even and odd in
  // its cosine (StreamConstants::viewFunctions).
  std::vector<double> seen;
};

// All that depends on medium and beam and not on the slab: made once on the processor.
struct StreamConstants {
  BeamInMedium medium;
  // Scaled depth over true depth: less than 1 where light scattered within the forward peak counts as unscattered.
  double depth_scale = 1.;
  std::vector<double> cosines;       // mu of each stream of a half [1]
  std::vector<double> solid_angles;  // that it stands for [sr]; their sum is 2 pi
  std::vector<StreamModes> orders;   // m = 0, 1, ...
  bool uniform_halves = false;       // one stream for a half's uniform radiance, not for a direction

  int streams() const { return static_cast<int>(cosines.size()); }

  // Values at |cos| mu of the functions that the rows of `seen` weigh: associated Legendre functions of m = order; for
  // uniform halves 1 and 2 T - 1, T being the forward share.
  std::vector<double> viewFunctions(int order, double mu) const;
};

// The three makers throw InvalidInput on a medium or a number out of its range.

// (S12) SPP: two streams that travel as obliquely as the beam and are scattered as it is.
StreamConstants sppConstants(const BeamInMedium& medium);

// (S12) Two streams of mean cosine 1/2, each uniform over its half, and the beam as their source (hemispheric mean).
StreamConstants twoStreamConstants(const BeamInMedium& medium);

// (S13) Discrete ordinates.
//   streams         n of each half, 1 .. kMostStreams
//   azimuth_orders  m = 0 .. azimuth_orders - 1 are solved, 1 .. 2 n; fluxes need 1
StreamConstants nStreamConstants(const BeamInMedium& medium, int streams, int azimuth_orders);

// Normalised associated Legendre functions sqrt((l-m)! / (l+m)!) P_l^m(mu), l = m .. m + result.size() - 1, without the
// sign (-1)^m; |mu| <= 1. The recurrence in l is stable.
void legendreFunctions(int order, double mu, std::span<double> result);

}  // namespace sunfleck::spp
