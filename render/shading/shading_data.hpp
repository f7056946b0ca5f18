#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "render/model.hpp"
#include "render/scene.hpp"

// The C++ face of the shading text's types (surface_types.glsl).
namespace sunfleck::shading {

using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
#include "render/shading/surface_types.glsl"

// What shading reads beside the fragments: plain data, the same for graphics card and processor.
struct ShadingData {
  std::vector<KindOptics> kinds;
  std::vector<ShadingLight> lights;
  std::vector<float> constants;  // the model's own (shading_model.hpp)
};

// The scene's suns.
std::vector<ShadingLight> shadingLights(const Scene& scene);

// Throws InvalidInput on more than kMostKinds kinds.
ShadingData shadingData(Model model, const Scene& scene);

}  // namespace sunfleck::shading
