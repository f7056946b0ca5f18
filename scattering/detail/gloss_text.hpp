#pragma once

#include <algorithm>
#include <cmath>

// gloss_formulas.glsl for float.
namespace sunfleck::gloss {

using Number = float;
using std::abs, std::erfc, std::exp, std::max, std::min, std::sqrt;
constexpr float select(bool condition, float a, float b) {
  return condition ? a : b;
}
#define SHARED_FN inline
#define SHARED_CONSTANT inline constexpr
#include "scattering/gloss_formulas.glsl"
#undef SHARED_FN
#undef SHARED_CONSTANT

}  // namespace sunfleck::gloss
