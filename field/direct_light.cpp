#include "field/direct_light.hpp"

namespace sunfleck {

// (F3)
DirectLight directLight(const SunPicture& picture, const FieldElements& elements, bool periodic) {
  const std::vector<double>& shown = picture.shown();
  DirectLight light{.along = picture.along(), .irradiance = std::vector<float>(shown.size())};
  for (std::size_t side = 0; side < shown.size(); ++side) {
    light.irradiance[side] = static_cast<float>(shown[side] / double{elements.area[side / 2]});
    light.power += shown[side];
  }
  if (periodic) light.ground_power = picture.free();
  return light;
}

DirectLight directLight(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                        Direction along, const DirectEffort& effort) {
  return directLight(SunPicture(mesh, elements, period, along, effort), elements, period.has_value());
}

}  // namespace sunfleck
