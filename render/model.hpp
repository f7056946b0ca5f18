#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace sunfleck {

// The scattering models.
enum class Model {
  ss,        // single scattering: light that met no leaf before
  spp,       // simplified plane-parallel slab
  sppg,      // that, compensated for the crown's edge by G
  sppr,      // SPP refined by one more scattering, with G
  nstreamg,  // a slab by two streams in each half, with G
  pp,        // the exact slab, from a table, with G
  field,     // light that leaves and wood exchange, solved for
};
inline constexpr std::array kModels{Model::ss,       Model::spp, Model::sppg, Model::sppr,
                                    Model::nstreamg, Model::pp,  Model::field};
std::string nameOf(Model model);  // "ss", "spp" ...
std::optional<Model> modelNamed(std::string_view name);
std::string modelNames();             // "ss, spp ...", for people
bool needsCompensation(Model model);  // whether it asks for G
bool tellsSingle(Model model);        // whether it tells light that was scattered once before apart (R35)

}  // namespace sunfleck
