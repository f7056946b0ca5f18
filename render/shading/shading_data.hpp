#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/model.hpp"
#include "render/scene.hpp"
#include "render/shading/leaf_tables.hpp"
#include "render/shading/shading_model.hpp"
#include "render/stand_geometry.hpp"

// The C++ face of the shading text's types (surface_types.glsl).
namespace sunfleck::shading {

using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
#include "render/shading/surface_types.glsl"

static_assert(kMostSurfaceKinds >= kMostKinds && kMostShadingLights >= kMostSuns);

// What shading reads beside the fragments: plain data, the same for graphics card and processor.
struct ShadingData {
  std::optional<Model> model;
  std::vector<BandOptics> leaves;  // of each kind
  std::vector<KindOptics> kinds;
  std::vector<ShadingLight> lights;
  std::shared_ptr<const LeafTables> leaf_tables;  // the same for all models, which may share them
  std::vector<vec4> constants;                    // the model's own (shading_model.hpp)
};

// Brings the data up to date; what depends on leaves and model alone stays while these do.
//   kinds, lights  as fragments number them, at most kMostSurfaceKinds and kMostShadingLights
//   exact          for models of the exact solution; without it these throw std::invalid_argument
void update(ShadingData& data, Model model, std::span<const TreeKind> kinds, std::span<const ShadingLight> lights,
            const spp::PowerTableOf& exact = {});

}  // namespace sunfleck::shading
