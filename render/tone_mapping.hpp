#pragma once

#include <cmath>

#include "core/quantities.hpp"

namespace sunfleck {

namespace tone_mapping {

using std::pow;
constexpr Number min(Number a, Number b) {
  return b < a ? b : a;
}
constexpr Number select(bool condition, Number a, Number b) {
  return condition ? a : b;
}
#define SHARED_FN inline
#include "render/tone_mapping.glsl"
#undef SHARED_FN

}  // namespace tone_mapping

enum class ToneCurve { clamp = tone_mapping::kClampCurve, filmic = tone_mapping::kFilmicCurve };

// How a picture of radiances is shown on a screen: multiplied by the exposure, then by the curve, then encoded as sRGB.
struct Display {
  Display(float factor, ToneCurve shape = ToneCurve::clamp) : exposure(factor), curve(shape) {}

  float exposure;   // from radiance to brightness, > 0
  ToneCurve curve;  // by default, light as it is

  // Of a radiance, the sRGB code, 0 .. 1.
  float code(float radiance) const {
    return tone_mapping::srgbCode(tone_mapping::shownLight(static_cast<int>(curve), exposure * radiance));
  }
};

}  // namespace sunfleck
