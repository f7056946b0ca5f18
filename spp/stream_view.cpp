#include "spp/stream_view.hpp"

#include <algorithm>
#include <cmath>

namespace sunfleck::spp {

template <typename Real>
StreamView<Real> streamView(const StreamConstants& constants, double mu, double azimuth) {
  const BeamInMedium& beam = constants.beam;
  const double cosine = std::clamp(std::abs(mu), kLeastCosine, 1.);
  const ViewKernel kernel = constants.viewKernel(cosine);
  const double per_extinction = kernel.extinction > 0. ? 1. / kernel.extinction : 0.;
  const double source = per_extinction * scatteredInto(beam.medium, mu, beam.mu0, azimuth);
  StreamView<Real> view{.cosine = static_cast<Real>(mu),
                        .rate = static_cast<Real>(kernel.extinction / (constants.depth_scale * cosine)),
                        .beam_source = static_cast<Real>(source)};
  for (std::size_t m = 0; m < constants.orders.size(); ++m) {
    const StreamModes& modes = constants.orders[m];
    const double wave = std::cos(static_cast<double>(m) * azimuth), side = mu > 0. ? wave : -wave;
    for (std::size_t j = 0, n = modes.rate.size(); j < n; ++j) {
      double sum = 0., difference = 0.;
      for (std::size_t i = 0; i < n; ++i) {
        sum += kernel.sum[m][i] * modes.sum[i * n + j];
        difference += kernel.difference[m][i] * modes.difference[i * n + j];
      }
      view.seen_sum.push_back(static_cast<Real>(wave * sum));
      view.seen_difference.push_back(static_cast<Real>(side * difference));
    }
  }
  return view;
}

template StreamView<float> streamView<float>(const StreamConstants&, double, double);
template StreamView<double> streamView<double>(const StreamConstants&, double, double);

}  // namespace sunfleck::spp
