#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "core/directions.hpp"
#include "core/tree_mesh.hpp"
#include "field/elements.hpp"

namespace sunfleck {

// How finely a sun's light is sampled.
struct DirectEffort {
  float pixels = 128.f;             // of an element of mean area that faces the sun, in the mean [1]
  double most_pixels = 4'194'304.;  // of a picture
};

// (F3) What a sun of irradiance 1 on a plane that faces it sends straight to each side of each element: a picture as
// the sun sees the stand, in which each pixel gives its light to the first side behind its middle. No light is lost.
struct DirectLight {
  Direction along{0.f, 0.f, -1.f};
  std::vector<float> irradiance;  // of side 2 element (front) and 2 element + 1 (back) [1]
  double power = 0.;              // that arrives at all sides, relative to the irradiance [m^2]
  double ground_power = 0.;       // with a period: that arrives at the ground [m^2]
};

//   along   in which the light travels; with a period not level
//   period  side lengths of the repeated rectangle [m]; none: the stand is alone
DirectLight directLight(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                        Direction along, const DirectEffort& effort = {});

}  // namespace sunfleck
