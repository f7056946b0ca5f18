#pragma once

#include <cmath>
#include <optional>

#include "render/compare/validation.hpp"

namespace sunfleck {

// Table 3 of Shinya et al. 2013, as printed: RMS of Eq. 30 [fraction] for a cherry of 18,000 triangles of albedo 0.95,
// the sun overhead. Nothing when the validation is of leaves of another albedo, another sun, or neither one tree nor a
// periodic stand. The paper's cherry is not ours.
inline std::optional<double> paperError(const Validation& v, Model model) {
  const bool alike = std::abs(v.albedo() - 0.95) < 0.005 && v.scene.sun().zenith < 0.01f;
  if (!alike || v.scene.stand.trees.size() > 1) return std::nullopt;
  const bool periodic = v.scene.stand.period.has_value();
  switch (model) {
    case Model::ss:
      return periodic ? 0.28 : 0.16;
    case Model::spp:
      return periodic ? 0.43 : 0.65;
    case Model::sppg:
      return periodic ? 0.092 : 0.062;
    case Model::sppr:
    case Model::nstreamg:
    case Model::pp:
    case Model::field:
      break;  // not in the table
  }
  return std::nullopt;
}

}  // namespace sunfleck
