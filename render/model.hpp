#pragma once

#include <array>
#include <string>

namespace sunfleck {

// The scattering models.
enum class Model {
  ss,        // single scattering: light that met no leaf before
  spp,       // simplified plane-parallel slab
  sppg,      // that, compensated for the crown's edge by G
  nstreamg,  // a slab by two streams in each half, with G
};
inline constexpr std::array kModels{Model::ss, Model::spp, Model::sppg, Model::nstreamg};
std::string nameOf(Model model);      // "ss", "spp", "sppg", "nstreamg"
bool needsCompensation(Model model);  // whether it asks for G

}  // namespace sunfleck
