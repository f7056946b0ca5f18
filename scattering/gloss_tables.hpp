#pragma once

#include <cstddef>
#include <vector>

namespace sunfleck {

// (R26) What a gloss of this roughness sends to the eye of light from half of the sphere: the numbers that
// gloss_formulas.glsl says where to find. Shinya et al. 2013, Eq. 32.
inline constexpr std::size_t kGlossTableNumbers = 5890;
std::vector<float> glossTables(float roughness);

}  // namespace sunfleck
