#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "render/false_colour.hpp"
#include "render/gl/buffer.hpp"
#include "render/gl/context.hpp"
#include "render/gl/program.hpp"
#include "render/gl/shader_text.hpp"
#include "render/tone_mapping.hpp"

using namespace sunfleck;

// Check that a window shows what a PNG holds: tone curves, sRGB and false colours on the GPU against C++, which read
// one text. 1e-5 is a 400th of a code of 8 bits; pow of llvmpipe is good to some 5e-6, and the terms of the polynomial
// of viridis are up to 60.
TEST(SharedDisplay, WindowsShowWhatPicturesHold) {
  struct Output {
    std::array<float, 8> values;
  };
  std::vector<float> inputs;
  for (float light = 1e-5f; light < 1e3f; light *= 1.02f) inputs.push_back(light);
  for (int i = -10; i <= 110; ++i) inputs.push_back(0.01f * static_cast<float>(i));
  const std::string text = "#version 450 core\n" + gl::shaderText("render/gl/prelude.glsl") +
                           gl::shaderText("render/tone_mapping.glsl") + gl::shaderText("render/false_colour.glsl") + R"(
    layout(local_size_x = 64) in;
    struct Output { float values[8]; };
    layout(std430, binding = 0) readonly buffer Inputs { float inputs[]; };
    layout(std430, binding = 1) writeonly buffer Outputs { Output outputs[]; };
    void main() {
      uint i = gl_GlobalInvocationID.x;
      if (i >= inputs.length()) return;
      vec3 colour = falseColour(inputs[i]);
      outputs[i].values = float[8](srgbCode(shownLight(kClampCurve, inputs[i])), srgbCode(shownLight(kFilmicCurve, inputs[i])),
                                   srgbLight(clamp(inputs[i], 0.0, 1.0)), colour.r, colour.g, colour.b, 0.0, 0.0);
    })";
  const gl::Context context;
  const gl::Program program{{.stage = gl::Stage::compute, .name = "display", .text = text}};
  const gl::Buffer in(inputs), out(std::vector<Output>(inputs.size()));
  in.bindStorage(0);
  out.bindStorage(1);
  program.use();
  glDispatchCompute(static_cast<GLuint>(inputs.size() / 64 + 1), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const std::vector<Output> outputs = out.read<Output>();
  context.requireNoError("showing light");
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const float x = inputs[i];
    const glm::vec3 colour = falseColour(x);
    const std::array<float, 6> expected{Display(1.f).code(x),
                                        Display(1.f, ToneCurve::filmic).code(x),
                                        tone_mapping::srgbLight(std::min(std::max(x, 0.f), 1.f)),
                                        colour.r,
                                        colour.g,
                                        colour.b};
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_NEAR(outputs[i].values[k], expected[k], 1e-5f) << "value " << k << " of " << x;
  }
}
