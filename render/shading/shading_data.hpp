#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "render/model.hpp"
#include "render/scene.hpp"
#include "render/stand_geometry.hpp"

// The C++ face of the shading text's types (surface_types.glsl).
namespace sunfleck::shading {

using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
#include "render/shading/surface_types.glsl"

static_assert(kMostSurfaceKinds >= kMostKinds && kMostShadingLights >= kMostSuns);

// What shading reads beside the fragments: plain data, the same for graphics card and processor.
struct ShadingData {
  std::vector<KindOptics> kinds;
  std::vector<ShadingLight> lights;
  std::vector<float> constants;  // the model's own (shading_model.hpp)
};

// Kinds and lights as the stand numbers them.
ShadingData shadingData(Model model, const Scene& scene, const StandGeometry& stand);
// Of the scene's kinds, at most kMostSurfaceKinds, in lights as the caller numbers them, at most kMostShadingLights.
ShadingData shadingData(Model model, std::span<const TreeKind> kinds, std::span<const StandLight> lights);

}  // namespace sunfleck::shading
