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
  }
  return {};
}

}  // namespace sunfleck
