#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "field/sun_picture.hpp"

namespace sunfleck {

// (F3) What a sun of irradiance 1 on a plane that faces it sends straight to each side of each element: each row of
// its picture gives its light to the sides that it shows. No light is lost.
struct DirectLight {
  Direction along{0.f, 0.f, -1.f};
  std::vector<float> irradiance;  // of side 2 element (front) and 2 element + 1 (back) [1]
  double power = 0.;              // that arrives at all sides, relative to the irradiance [m^2]
  double ground_power = 0.;       // with a period: that arrives at the ground [m^2]
};

DirectLight directLight(const SunPicture& picture, const FieldElements& elements, bool periodic);
// The same, by a picture that is not kept.
DirectLight directLight(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                        Direction along, const DirectEffort& effort = {});

}  // namespace sunfleck
