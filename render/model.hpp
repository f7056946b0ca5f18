#pragma once

#include <array>
#include <string>

namespace sunfleck {

// The scattering models. Shaders read the same numbers.
enum class Model { ss = 0, spp = 1, sppg = 2 };
inline constexpr std::array kModels{Model::ss, Model::spp, Model::sppg};
std::string nameOf(Model model);  // "ss", "spp", "sppg"

}  // namespace sunfleck
