#include "render/model.hpp"

namespace sunfleck {

std::string nameOf(Model model) {
  switch (model) {
    case Model::ss:
      return "ss";
    case Model::spp:
      return "spp";
    case Model::sppg:
      return "sppg";
    case Model::sppr:
      return "sppr";
    case Model::nstreamg:
      return "nstreamg";
    case Model::pp:
      return "pp";
    case Model::field:
      return "field";
  }
  return {};
}

std::optional<Model> modelNamed(std::string_view name) {
  for (const Model model : kModels)
    if (nameOf(model) == name) return model;
  return std::nullopt;
}

std::string modelNames() {
  std::string names;
  for (const Model model : kModels) names += (names.empty() ? "" : ", ") + nameOf(model);
  return names;
}

bool needsCompensation(Model model) {
  return model != Model::ss && model != Model::spp && model != Model::field;
}

bool tellsSingle(Model model) {
  return model == Model::ss || model == Model::spp || model == Model::sppg;
}

}  // namespace sunfleck
