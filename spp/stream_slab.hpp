#pragma once

#include <vector>

#include "spp/slab.hpp"
#include "spp/stream_constants.hpp"
#include "spp/stream_view.hpp"

namespace sunfleck::spp {

// Light at one depth for a beam of irradiance 1 on a plane that faces it. Powers are radiance integrated over a half of
// the sphere, fluxes pass through a horizontal plane; downward ones include the direct light (flux: mu0 times it).
template <typename Real>
struct SlabLight {
  Real power_down, power_up;  // P+, P- [F]
  Real flux_down, flux_up;    // [F]
  Real direct;                // unscattered, F e^(-K z) [F]
  // Of both sides of a leaf together, per one-sided leaf area, direct light included: the mean over the leaves. In a
  // medium of particles, that of leaves of all directions alike. Times (1 - omega) it is what a leaf absorbs.
  Real leaf_irradiance;
};

// A closed form (SPP, two-stream, n-stream) in a homogeneous slab on a black ground; Real is float or double. Depths
// are true optical depths; what lies outside the slab counts as its face. Nothing it returns is negative: a series of
// moments may be, and is then cut to 0.
template <typename Real>
class StreamSlab {
 public:
  // thickness  w [1], > 0, may be infinite. Throws InvalidInput for another.
  StreamSlab(StreamConstants constants, Real thickness);

  Real reflectance() const;    // flux up at the lit face over the flux that arrives [1]
  Real transmittance() const;  // flux down at the other face, direct light included, over it [1]

  SlabLight<Real> light(Real depth) const;

  // streamView() of the slab's medium and beam: made once for many depths.
  using View = StreamView<Real>;
  View view(double mu, double azimuth) const { return streamView<Real>(constants_, mu, azimuth); }

  // (S10) Diffuse radiance [1/sr]: light scattered once exactly, the rest from the model's field by the true phase
  // function, integrated along the line of sight in the true medium.
  Real refinedRadiance(Real depth, const View& view) const;

  // Diffuse radiance of a stream of the model's own field [1/sr], order m: the coefficient of cos(m phi).
  Real streamRadiance(Real depth, int stream, bool downward, int order = 0) const;

 private:
  using Formulas = StreamFormulas<Real>;
  struct Mode {
    typename Formulas::StreamMode mode;
    typename Formulas::ModeShare share;
  };

  void addModes(const StreamModes& modes);
  typename Formulas::SlabPlace place(Real depth) const;

  StreamConstants constants_;
  Real thickness_, depth_scale_, beam_rate_, mu0_, beam_projection_;
  std::vector<Mode> modes_;  // of order 0, then of order 1 ...
  std::vector<Real> power_sum_, power_difference_, flux_sum_, flux_difference_, met_sum_;  // of the modes of order 0
};

extern template class StreamSlab<float>;
extern template class StreamSlab<double>;

}  // namespace sunfleck::spp
