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
      gloss_tables_(BufferTexture::Texel::r32f, "the tables of leaves' gloss take"),
      model_numbers_(BufferTexture::Texel::rgba32f, "the tables of the model take") {
  gloss_tables_.assign(std::span<const float>(data.leaf_tables->gloss_tables));
  model_numbers_.assign(std::span<const glm::vec4>(data.constants));
}

void ShadingBuffers::bind() const {
  surfaces_.bindUniform(1);
  gloss_tables_.bind(10);
  model_numbers_.bind(11);
}

}  // namespace sunfleck::gl
