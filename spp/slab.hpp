#pragma once

#include <cmath>

#include "core/quantities.hpp"

// The C++ face of the shared formulas: `spp` in single precision as on the GPU, `spp::precise` in double.
namespace sunfleck::spp {

using std::exp;
using std::expm1;
using std::sqrt;

template <typename T>
constexpr T min(T a, T b) {
  return b < a ? b : a;
}
template <typename T>
constexpr T max(T a, T b) {
  return a < b ? b : a;
}
using std::abs;

#define SHARED_FN inline
#include "spp/spp_formulas.glsl"
#include "spp/stream_formulas.glsl"

namespace precise {
using Number = double;
#include "spp/spp_formulas.glsl"
#include "spp/stream_formulas.glsl"
}  // namespace precise
#undef SHARED_FN

}  // namespace sunfleck::spp
