#pragma once

#include <functional>
#include <glm/vec4.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "render/model.hpp"
#include "render/scene.hpp"
#include "spp/power_table.hpp"

namespace sunfleck::shading {

// (R27) A model as surfaces are shaded by it. One more is one more text and one more entry.
struct ShadingModel {
  Model model;
  std::string_view text;  // file that defines scatteredLight()
  // What the text reads by modelNumbers(), for all kinds. Throws std::invalid_argument without `exact` where it is
  // needed.
  std::vector<glm::vec4> (*constants)(std::span<const TreeKind> kinds, const spp::PowerTableOf& exact);
};

const ShadingModel& shadingModel(Model model);

}  // namespace sunfleck::shading
