#pragma once

#include <string>

#include "render/gl/buffer.hpp"
#include "render/gl/program.hpp"
#include "render/shading/shading_data.hpp"

namespace sunfleck::gl {

// A shader of the repository that includes render/gl/shading.glsl, with the text of a model in it.
Shader shadingShader(Stage stage, const std::string& path, Model model);

// What render/gl/shading.glsl reads, of one model: small, and made anew when optics, lights or the model change.
class ShadingBuffers {
 public:
  explicit ShadingBuffers(const shading::ShadingData& data);
  // For all shaders of the current context: uniform block 1, storage blocks 14 and 15.
  void bind() const;

 private:
  Buffer surfaces_, gloss_, constants_;
};

}  // namespace sunfleck::gl
