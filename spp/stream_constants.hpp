#pragma once

#include <span>
#include <utility>
#include <vector>

#include "scattering/medium.hpp"

namespace sunfleck::spp {

// What scatters in a slab, and the beam that lights it. Depth is that of the medium: optical depth, of leaves leaf area
// index.
struct BeamInMedium {
  Medium medium;
  double mu0 = 1.;  // |cos| of the beam to the slab's normal [1], (0, 1]; below kLeastCosine it counts as that

  BeamInMedium(Medium scatterers, double cosine) : medium(std::move(scatterers)), mu0(cosine) {}
  // Particles that scatter as Henyey and Greenstein have it.
  //   asymmetry  g [1], -1 < g < 1, else throws InvalidInput;  albedo  omega [1], 0 .. 1
  BeamInMedium(double asymmetry, double albedo, double cosine)
      : medium(Particles{.albedo = albedo, .phase = PhaseFunction::henyeyGreenstein(asymmetry)}), mu0(cosine) {}
};

inline constexpr double kLeastCosine = 1e-7;
inline constexpr int kMostStreams = 32;

// The modes of diffuse light in a medium for one order m of the azimuth (light proportional to cos m phi), each with
// its share in every stream. Matrices are stored row after row, n columns, one for each mode. With W the solid angles
// over 2 pi and M the cosines of the streams, X' W M Y = 1.
struct StreamModes {
  std::vector<double> rate, entering, gain;  // k, a - g, g of each mode (stream_formulas.glsl)
  std::vector<double> sum, difference;       // X, Y: n rows, the streams
};

// What of the streams is scattered towards the eye, per extinction there: with S, D the sum and the difference of the
// radiances down and up of every stream, (sum S + difference D) downward and (sum S - difference D) upward. n numbers
// for each order.
struct ViewKernel {
  double extinction = 1.;  // towards the eye, per depth of the medium [1]
  std::vector<std::vector<double>> sum, difference;
};

// All that depends on medium and beam and not on the slab: made once on the processor.
struct StreamConstants {
  BeamInMedium beam;
  double beam_rate;  // K at which the direct light decays, per scaled depth [1]
  // Scaled depth over true depth: less than 1 where light scattered within the forward peak counts as unscattered.
  double depth_scale = 1.;
  std::vector<double> cosines;       // mu of each stream of a half [1]
  std::vector<double> solid_angles;  // that it stands for [sr]; their sum is 2 pi
  // Leaf area that light of a stream, and of the beam, meets across it, per leaf area [1]: G. Particles stand for
  // leaves of all directions alike, 1/2.
  std::vector<double> projections;
  double beam_projection;
  std::vector<StreamModes> orders;  // m = 0, 1, ...
  bool uniform_halves = false;      // one stream for a half's uniform radiance, not for a direction
  // How discrete streams are scattered, for each order: in leaves by the projections of these on them, among particles
  // by moments, omega / 2 (2 l + 1) chi_l w_i P_l^m(mu_i): a row for each l from m to 2 n - 1.
  std::vector<LeafProjections> leaves;
  std::vector<std::vector<double>> moments;

  int streams() const { return static_cast<int>(cosines.size()); }

  //   mu  |cos| of the direction of view [1], 0 .. 1
  ViewKernel viewKernel(double mu) const;
};

// The three makers throw InvalidInput on a medium or a number out of its range, and on leaves with a hot spot, which is
// no matter of the streams.

// (S12) SPP: two streams that travel as obliquely as the beam, are extinguished and scattered as it is.
StreamConstants sppConstants(const BeamInMedium& beam);

// (S12) Two streams, each uniform over its half, and the beam as their source (hemispheric mean).
StreamConstants twoStreamConstants(const BeamInMedium& beam);

// (S13) Discrete ordinates.
//   streams         n of each half, 1 .. kMostStreams
//   azimuth_orders  m = 0 .. azimuth_orders - 1 are solved, 1 .. 2 n; fluxes need 1
StreamConstants nStreamConstants(const BeamInMedium& beam, int streams, int azimuth_orders);

// Normalised associated Legendre functions sqrt((l-m)! / (l+m)!) P_l^m(mu), l = m .. m + result.size() - 1, without the
// sign (-1)^m; |mu| <= 1. The recurrence in l is stable.
void legendreFunctions(int order, double mu, std::span<double> result);

}  // namespace sunfleck::spp
