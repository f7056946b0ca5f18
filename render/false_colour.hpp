#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "core/quantities.hpp"

namespace sunfleck {

namespace false_colour {

using glm::clamp;
using glm::vec3;
constexpr Number min(Number a, Number b) {
  return b < a ? b : a;
}
constexpr Number select(bool condition, Number a, Number b) {
  return condition ? a : b;
}
#define SHARED_FN inline
#include "render/false_colour.glsl"
#undef SHARED_FN

}  // namespace false_colour

using false_colour::falseColour;

}  // namespace sunfleck
