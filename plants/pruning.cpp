#include "plants/detail/pruning.hpp"

#include "plants/detail/portable_math.hpp"

namespace sunfleck::detail {

double envelopeWidth(const WeberPenn& parameters, double ratio) {
  if (!(ratio >= 0. && ratio <= 1.)) return 0.;
  const double below_top = 1. - double{parameters.prune_width_peak};
  if (ratio < below_top) return portable::power(ratio / below_top, double{parameters.prune_power_high});
  if (below_top == 1.) return 1.;
  return portable::power((1. - ratio) / (1. - below_top), double{parameters.prune_power_low});
}

bool insideEnvelope(const WeberPenn& parameters, double height, const glm::dvec3& point) {
  const double ratio = (height - point.z) / (height * (1. - double{parameters.level[0].base_size}));
  return portable::length(point.x, point.y) <
         height * double{parameters.prune_width} * envelopeWidth(parameters, ratio);
}

}  // namespace sunfleck::detail
