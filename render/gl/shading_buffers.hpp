#pragma once

#include <string>

#include "render/gl/buffer.hpp"
#include "render/gl/buffer_texture.hpp"
#include "render/gl/program.hpp"
#include "render/shading/shading_data.hpp"

namespace sunfleck::gl {

// A shader of the repository that includes render/gl/shading.glsl, with the text of a model in it.
Shader shadingShader(Stage stage, const std::string& path, Model model);

// What render/gl/shading.glsl reads, of one model: small, and made anew when optics, lights or the model change.
class ShadingBuffers {
 public:
  explicit ShadingBuffers(const shading::ShadingData& data);
  // For all shaders of the current context: uniform block 1, texture units 10 and 11.
  void bind() const;
  // Whether a leaf has a gloss; if none has, shaders may take GLOSSY as false.
  bool gloss() const { return gloss_tables_.capacity() > 0; }

 private:
  Buffer surfaces_;
  BufferTexture gloss_tables_, model_numbers_;
};

}  // namespace sunfleck::gl
