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
    case Model::nstreamg:
      return "nstreamg";
  }
  return {};
}

bool needsCompensation(Model model) {
  return model != Model::ss && model != Model::spp;
}

}  // namespace sunfleck
