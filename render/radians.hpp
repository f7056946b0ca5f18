#pragma once

#include <numbers>

namespace sunfleck {

// Of degrees as a person types them. Rounded once, so that every angle in single precision has degrees that lead to it.
constexpr float radiansOf(double degrees) {
  return static_cast<float>(degrees * (std::numbers::pi / 180.));
}

}  // namespace sunfleck
