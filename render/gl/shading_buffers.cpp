#include "render/gl/shading_buffers.hpp"

#include <algorithm>
#include <array>

#include "render/gl/shader_text.hpp"
#include "render/shading/shading_model.hpp"

namespace sunfleck::gl {
namespace {

using namespace shading;

// The uniform block of shading.glsl.
struct SurfacesData {
  std::array<KindOptics, kMostSurfaceKinds> kinds{};
  std::array<ShadingLight, kMostShadingLights> lights{};
};

SurfacesData surfacesData(const ShadingData& data) {
  SurfacesData surfaces;
  std::ranges::copy(data.kinds, surfaces.kinds.begin());
  std::ranges::copy(data.lights, surfaces.lights.begin());
  return surfaces;
}

}  // namespace

Shader shadingShader(Stage stage, const std::string& path, Model model) {
  return {.stage = stage, .name = path + " with " + nameOf(model), .text = shaderText(path, shadingModel(model).text)};
}

ShadingBuffers::ShadingBuffers(const ShadingData& data)
    : surfaces_([&] {
        const SurfacesData surfaces = surfacesData(data);
        return Buffer(std::span(&surfaces, 1));
      }()),
      gloss_(data.gloss_tables),
      constants_(data.constants) {}

void ShadingBuffers::bind() const {
  surfaces_.bindUniform(1);
  gloss_.bindStorage(14);
  constants_.bindStorage(15);
}

}  // namespace sunfleck::gl
