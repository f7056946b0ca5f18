#pragma once

namespace sunfleck::pp::detail {

// Light that is 0 but for the rounding of a sum of `size` comes out as 0, not below it.
inline double withoutRounding(double light, double size = 1.) {
  return light < 0. && light > -1e-14 * size ? 0. : light;
}

}  // namespace sunfleck::pp::detail
