#pragma once

#include <glm/vec3.hpp>

namespace sunfleck::detail {

// What other programs show a written tree with: shares of red, green and blue [1], of a green leaf and of bark.
inline constexpr glm::vec3 kLeafReflectance(0.09f, 0.27f, 0.05f);
inline constexpr glm::vec3 kLeafTransmittance(0.06f, 0.22f, 0.03f);
inline constexpr glm::vec3 kWoodReflectance(0.25f, 0.17f, 0.10f);

}  // namespace sunfleck::detail
